// What a window can show instead of the picture.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Film.h"
#include "Common/Image/Image.h"
#include "Common/Render/Engine.h"
#include "Common/Render/Names.h"

namespace rt::app {

enum class ViewMode { Picture, Albedo, Normal, Depth, Noise, Error, Heat, HalfA, HalfB, DenoisedError, Bandwidth };

struct ViewRequest {
    ViewMode mode = ViewMode::Picture;
    double scale = 1;       // of Noise, both errors and Heat: divides the value that has the brightest colour
    bool inspect = false;   // the state is to hold what the inspector shows
    Cost cost = Cost::Rays; // of Heat
    bool denoise = false;   // pictures and halves have less noise, where the film has halves
    bool operator==(const ViewRequest&) const = default;
};

// First-hit features that the mode shows.
AovRequest aovsFor(ViewMode mode);

// Whether the mode shows what the denoiser knows beside the picture; of a film's halves also without it.
bool showsDenoiser(ViewMode mode);

// What the colours of a view stand for: values from 0 to `most`; those beyond have the colour of `most`.
struct Legend {
    enum class Quantity {
        Rays,          // of a sample
        Time,          // of a sample, in the engine's unit
        StandardError, // of a pixel's mean, relative to it
        Error,         // relative to the reference
        DenoisedError, // of the denoised picture, estimated, relative to it
        Bandwidth,     // of the denoiser: the number of the candidate that a pixel keeps, the last of which is raw
        Distance,      // to the first surface, in the scene's unit; near is bright, 0 stands for no surface
    };
    Quantity quantity = Quantity::Rays;
    float maximum = 0; // 0: there is nothing to show
    float unit = 0;    // below it the scale is about linear, above it about logarithmic; 0: it is linear throughout

    float level(float value) const; // the value's place on the scale: 0 to 1, or beyond
    float value(float level) const; // the other way round
};

// A row-major image of values in the legend's colours, as linear display intensities.
image::Image paint(const Legend& legend, const std::vector<float>& values, std::uint32_t width, std::uint32_t height);

// Linear display intensities, and what they stand for unless they are the values themselves.
struct ViewImage {
    image::Image image;
    std::optional<Legend> legend;
    image::Image values{}; // that the pixels show: one channel with a legend, else three; of a picture's draft none
};

// Albedo, normal or depth.
ViewImage showFeatures(ViewMode mode, const AovImages& images);

// The standard error of each pixel's mean relative to that mean; what one pixel in a hundred exceeds, rounded up and
// divided by `scale`, has the brightest colour. Requires what Film::varianceOfMean() requires.
ViewImage showNoise(const image::Film& film, double scale);

// |picture - reference| relative to the reference; 1 / scale has the brightest colour.
ViewImage showError(const image::Image& picture, const image::Image& reference, double scale);

// The error that a denoised picture is estimated to have, relative to it; scaled as noise is. Both require its details.
ViewImage showDenoisedError(const image::Denoised& denoised, double scale);
ViewImage showBandwidth(const image::Denoised& denoised);

// The cost of each pixel on a logarithmic scale: the most that any pixel costs, divided by `scale`, has the brightest
// colour. Of times it is the most but for one pixel in 200, which were interrupted.
ViewImage showCost(Cost cost, const image::Image& costs, double scale);

} // namespace rt::app
