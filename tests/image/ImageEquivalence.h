// Do two renderings, made with independent random numbers, estimate the same image?
#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "Common/Image/Image.h"

namespace rt::image {

struct ImageTestResult {
    // Of the means over the whole image: least p of Welch's test over the channels, times their number (Bonferroni).
    double globalP = 1;
    // Rejected by Benjamini and Hochberg's procedure at q = 1e-3: 8x8 tiles summed beforehand, and single pixels, each
    // channel counting as one.
    std::size_t tileDiscoveries = 0;
    std::size_t pixelDiscoveries = 0;
    // The mean of t^2 over the pixels against its expectation, in standard deviations, of the channel where it is
    // farthest off: large where the variance is wrong or pixels are correlated. 0 below 6 degrees of freedom.
    double spreadZ = 0;
    // What the global test can detect: 4 standard errors of the difference over the mean, worst channel.
    double detectableBias = 0;
    Image pixelP; // p of each pixel and channel, to look at when the test fails

    bool passed() const;         // globalP > 1e-3, no discovery, |spreadZ| <= 4
    std::string summary() const; // one line
};

// `a` and `b` are images of independent blocks of samples, all blocks of the same number of samples, >= 2 (better 32)
// each; or `b` is a single image, which is then taken as exact. All of the same size.
ImageTestResult testImages(std::span<const Image> a, std::span<const Image> b);

} // namespace rt::image
