// Joins checkpoints of parts of one image.
#pragma once
#include <filesystem>
#include <vector>

#include "Common/Image/Checkpoint.h"

namespace rt::image {

// The whole film, bit for bit as if it had been rendered in one piece, and what the first file says of the render.
// Throws InputError, naming files, when they are of different renders, when one is not finished, when two have the same
// tile, or when tiles are missing.
Checkpoint mergeCheckpoints(const std::vector<std::filesystem::path>& files);

} // namespace rt::image
