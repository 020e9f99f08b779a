// Pictures of low resolution, shown until there are samples.
#pragma once
#include <cstdint>
#include <span>

#include "Common/Image/Film.h"
#include "Common/Image/Image.h"

namespace rt::app {

// Bilinear.
image::Image enlarge(const image::Image& image, std::uint32_t width, std::uint32_t height);

// Replaces the pixels of tiles of image::Film that have no samples yet.
void fillFromDraft(image::Image& picture, std::span<const std::uint64_t> tileSamples, const image::Image& draft);

} // namespace rt::app
