// Pictures for the report: what was rendered, and where it is wrong.
#pragma once
#include <string>
#include <vector>

#include "Common/Bench/Analysis.h"

namespace rt::bench {

// The reference, then for each configuration its image and a map of its error, all at the largest number of samples
// that all have reached; made smaller so that a report stays small.
PictureGrid makeGrid(const Experiment& experiment, const std::vector<Measured>& measured,
                     const image::Reference& reference);

// The image as a data URI of a PNG file.
std::string dataUri(const image::Image& display);

} // namespace rt::bench
