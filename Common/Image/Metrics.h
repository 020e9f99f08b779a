// How far an image is from a reference, or from what it would converge to. All in double, over pixels and channels.
#pragma once
#include <array>
#include <string>

#include "Common/Image/ImageRows.h"

namespace rt::image {

inline constexpr double kRelativeFloor = 0.01; // of relMSE's denominator

struct ErrorFigures {
    double mse = 0;    // mean((x - ref)^2)
    double rmse = 0;   // its square root
    double relmse = 0; // mean((x - ref)^2 / (ref^2 + 0.01))
    double mae = 0;    // mean(|x - ref|)
    double psnr = 0;   // dB, of clamped sRGB-encoded values with peak 1; infinite for equal ones
    double maxAbs = 0; // largest |x - ref|
};

// Both linear. Throws InputError, saying what differs, unless both have the same size and channels and all values are
// finite.
void checkFinite(const Image& image, const std::string& name); // throws InputError that begins with the name
ErrorFigures compare(const Image& image, const Image& reference);

// |x - ref|, averaged over the channels, from black-blue over green to yellow, lightness rising throughout (readable
// with any colour vision). The brightest colour stands for the error that 1 pixel in 200 exceeds. As writeImage expects
// for .png.
Image heatMap(const Image& image, const Image& reference);

// Values from 0 to 1 in the same colours; what is outside is clamped.
Image colourise(const std::vector<float>& level, std::uint32_t width, std::uint32_t height);

// The part of a relMSE against `reference` that its own variance makes: mean(variance / (reference^2 + 0.01)). What
// relMSE a picture with this variance has itself says estimateRelMse() of ErrorEstimate.h.
double referenceRelMse(const Image& reference, const Image& variance);

// Per channel: the mean over all pixels, and the standard error of that mean when pixels are independent. Three equal
// numbers for an image of one channel.
std::array<double, 3> channelMeans(const ImageRows& image);
std::array<double, 3> standardErrors(const ImageRows& variance);

} // namespace rt::image
