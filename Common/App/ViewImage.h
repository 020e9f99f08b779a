// What a window can show instead of the picture.
#pragma once
#include <cstdint>
#include <optional>

#include "Common/App/Engine.h"
#include "Common/App/Names.h"
#include "Common/Image/Film.h"
#include "Common/Image/Image.h"

namespace rt::app {

enum class ViewMode { Picture, Albedo, Normal, Depth, Noise, Error, Heat };

struct ViewRequest {
    ViewMode mode = ViewMode::Picture;
    double scale = 1;       // of Noise, Error and Heat: values are multiplied by it before they get a colour
    bool inspect = false;   // the state is to hold what the inspector shows
    Cost cost = Cost::Rays; // of Heat
    bool operator==(const ViewRequest&) const = default;
};

// First-hit features that the mode shows.
AovRequest aovsFor(ViewMode mode);

// Albedo, normal or depth as linear display intensities.
image::Image showFeatures(ViewMode mode, const AovImages& images);

// The standard error of each pixel's mean relative to that mean; 1 after scaling is the brightest colour. Requires what
// Film::varianceOfMean() requires.
image::Image showNoise(const image::Film& film, double scale);

// |picture - reference| relative to the reference, likewise.
image::Image showError(const image::Image& picture, const image::Image& reference, double scale);

// The cost of each pixel on a logarithmic scale: the most that any pixel costs is the brightest colour. Of times it is the most
// but for one pixel in 200, which were interrupted.
image::Image showCost(Cost cost, const image::Image& costs, double scale);

} // namespace rt::app
