// An image against a reference that has an error of its own, and what the difference is made of.
#pragma once
#include <cstddef>

#include "Common/Image/Image.h"

namespace rt::image {

struct Reference {
    Image mean;
    Image variance; // of each value of `mean`
};

// Of some of the pixels, or of all.
struct MeanSquares {
    double share = 0;        // of all pixels; 0: there are none, and the rest is 0 too
    double mse = 0;          // the reference's own variance is subtracted, as in ErrorAnalysis
    double referenceMse = 0; // this variance
    // Standard error of mse from the spread of tiles of 8x8 pixels. Tiles also differ because the picture does, so this
    // is an upper bound.
    double mseError = 0;
};

// Of the pixels that the reference has at 1 or less in every channel, which a screen shows unclamped: without the
// lights that one sees, and what mirrors them. The images must be such as compare() accepts.
MeanSquares meanSquaresUpTo1(const Image& image, const Reference& reference);

struct ErrorAnalysis {
    // As in ErrorFigures, but the reference's own variance is subtracted from mse, rmse and relmse: their expectations
    // are those against an exact reference. Chance may make them negative (rmse: 0) where the image is as good as the
    // reference.
    double mse = 0, rmse = 0, relmse = 0;
    double mae = 0, psnr = 0, flip = 0;           // against the reference as it is
    double referenceMse = 0, referenceRelmse = 0; // what was subtracted
    double mseError = 0;                          // as in MeanSquares
    MeanSquares upTo1;                            // of meanSquaresUpTo1()
    // Of the test that both have the same mean over all pixels: standard deviations from 0 in the worst channel. Beyond
    // 4 one of the two is biased.
    double biasZ = 0;
    // Pixels that are brighter than the reference by more than 10 times the rmse in some channel, and what share of the
    // mse is theirs.
    std::size_t fireflies = 0;
    double fireflyShare = 0;
};

// The noise of pixels of a square of `dependentSide` may be alike, as in ErrorEstimate.h; others are independent.
// Throws InputError unless all sizes are equal and values finite.
ErrorAnalysis analyseError(const Image& image, const Reference& reference, std::uint32_t dependentSide);

} // namespace rt::image
