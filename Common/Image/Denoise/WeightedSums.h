// Of the denoiser's kernel: weights of the pixels around eight that are fitted at a time, and the weighted sums that
// make the normal equations of the fits. Coordinates are counted from the pixel that is fitted: across, they are the
// same for all rows, down, for all of a row, so that most sums with them need no product of their own.
// Everything has internal linkage, as each instruction set's copy must stay in its own object file.
#pragma once
#include <cstddef>

#include "Common/Image/Denoise/DenoiseKernel.h"
#include "Common/Image/Denoise/Float8.h"
#include "Common/Shared/Denoise/DenoiseFit.h"

namespace rt::image {
namespace {

using shared::kDenoiseReach;

constexpr int kCoordinates = 3; // features that every tile has: 1, and coordinates from the pixel that is fitted
constexpr int kWeightValues = 2 * kLaneCount;             // of a place, see Reach
constexpr int kDenoiseRowOffsets = 2 * kDenoiseReach + 1; // of a row, and rows

// From a pixel to those in reach, row by row, in a plane.
struct Steps {
    int at[kDenoiseOffsets];
    constexpr Steps() : at() {
        int offset = 0;
        for (int dy = -kDenoiseReach; dy <= kDenoiseReach; ++dy)
            for (int dx = -kDenoiseReach; dx <= kDenoiseReach; ++dx) at[offset++] = dy * kDenoisePitch + dx;
    }
};
constexpr Steps kSteps;

// What eight pixels have in reach, row by row, where one of them has any weight.
struct Reach {
    std::ptrdiff_t places[kDenoiseOffsets];  // in a plane
    std::ptrdiff_t ends[kDenoiseRowOffsets]; // of each row, in `places`
    float* weights;             // [place][lane], and after each eight the same, times the coordinate across
    Float8 total, across, down; // sums of weights, and of weights times coordinates
    Float8 across2, acrossDown, down2;
};

// Of a row or column of what is in reach.
RT_FN Float8 coordinate(int rowOrColumn) {
    return broadcast(shared::kDenoisePixel * static_cast<float>(rowOrColumn - kDenoiseReach));
}

// Weights of what eight pixels have in reach, by the mean distances of their patches; `first`: the place of the eight.
RT_CALL void weigh(const DenoiseTile& tile, const float* patches, float perSquaredBandwidth, int first, Reach& reach) {
    const Float8 zero = broadcast(0);
    reach.total = reach.across = reach.down = reach.across2 = reach.acrossDown = reach.down2 = zero;
    std::ptrdiff_t count = 0;
    for (int row = 0; row < kDenoiseRowOffsets; ++row) {
        const std::ptrdiff_t start = first + kSteps.at[row * kDenoiseRowOffsets];
        const float *inside = tile.inside + start, *distances = patches + row * kDenoiseRowOffsets * kLaneCount;
        Float8 total = zero, across = zero, across2 = zero;
        float* weights = reach.weights + count * kWeightValues;
        float ofRow[kDenoiseRowOffsets * kLaneCount];
        for (int i = 0; i < kDenoiseRowOffsets * kLaneCount; ++i)
            ofRow[i] = shared::denoiseWeight(distances[i], perSquaredBandwidth);
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC unroll 17
#endif
        for (int column = 0; column < kDenoiseRowOffsets; ++column) {
            const Float8 step = coordinate(column);
            const Float8 weight = load(ofRow + column * kLaneCount) * load(inside + column);
            const Float8 acrossWeight = weight * step;
            total = total + weight;
            across = across + acrossWeight;
            across2 = multiplyAdd(acrossWeight, step, across2);
            store(weights, weight);
            store(weights + kLaneCount, acrossWeight);
            reach.places[count] = start + column;
            const std::ptrdiff_t any = isAnyPositive(weight) ? 1 : 0;
            count += any;
            weights += any * kWeightValues;
        }
        const Float8 down = coordinate(row);
        reach.ends[row] = count;
        reach.across2 = reach.across2 + across2;
        reach.total = reach.total + total;
        reach.across = reach.across + across;
        reach.acrossDown = multiplyAdd(across, down, reach.acrossDown);
        reach.down = multiplyAdd(total, down, reach.down);
        reach.down2 = multiplyAdd(total * down, down, reach.down2);
    }
}

// A row of the normal equations, and those after it, of the surface's features from the `kFeature`th on: sums of weight
// x this feature x (1, coordinates, each feature from this one on).
template <int kFeature, int kCount>
RT_CALL void sumFeature(const DenoiseTile& tile, const Reach& reach, Float8 (&products)[kCount][kCount]) {
    constexpr int kRow = kCoordinates + kFeature, kLater = kCount - kRow;
    Float8 total = broadcast(0), across = broadcast(0), down = broadcast(0), sums[kLater];
    const float* features[kLater];
    for (int i = 0; i < kLater; ++i) {
        sums[i] = broadcast(0);
        features[i] = tile.features[kFeature + i];
    }
    const float* weights = reach.weights;
    std::ptrdiff_t k = 0;
    for (int row = 0; row < kDenoiseRowOffsets; ++row) {
        Float8 ofRow = broadcast(0);
        for (; k < reach.ends[row]; ++k, weights += kWeightValues) {
            const std::ptrdiff_t place = reach.places[k];
            const Float8 own = load(features[0] + place);
            const Float8 weighed = load(weights) * own;
            ofRow = ofRow + weighed;
            across = multiplyAdd(load(weights + kLaneCount), own, across);
            sums[0] = multiplyAdd(weighed, own, sums[0]);
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC unroll 10
#endif
            for (int i = 1; i < kLater; ++i) sums[i] = multiplyAdd(weighed, load(features[i] + place), sums[i]);
        }
        total = total + ofRow;
        down = multiplyAdd(ofRow, coordinate(row), down);
    }
    products[kRow][0] = total;
    products[kRow][1] = across;
    products[kRow][2] = down;
    for (int i = 0; i < kLater; ++i) products[kRow + i][kRow] = sums[i];
    if constexpr (kRow + 1 < kCount) sumFeature<kFeature + 1, kCount>(tile, reach, products);
}

// The normal equations: lower triangle of the sums of weight x two features.
template <int kCount>
RT_FN void sumProducts(const DenoiseTile& tile, const Reach& reach, Float8 (&products)[kCount][kCount]) {
    products[0][0] = reach.total;
    products[1][0] = reach.across;
    products[1][1] = reach.across2;
    products[2][0] = reach.down;
    products[2][1] = reach.acrossDown;
    products[2][2] = reach.down2;
    if constexpr (kCount > kCoordinates) sumFeature<0, kCount>(tile, reach, products);
}
static_assert(kCoordinates == 3);

// Sums of weight x (solution . features) x radiance, of each channel.
template <int kCount>
RT_CALL void sumFitted(const DenoiseTile& tile, const Reach& reach, const Float8 (&solution)[kCount],
                       Float8 (&sums)[3]) {
    Float8 r = broadcast(0), g = broadcast(0), b = broadcast(0);
    const float *red = tile.radiance[0], *green = tile.radiance[1], *blue = tile.radiance[2];
    const float* weights = reach.weights;
    std::ptrdiff_t k = 0;
    for (int row = 0; row < kDenoiseRowOffsets; ++row) {
        const Float8 ofRow = multiplyAdd(solution[2], coordinate(row), solution[0]);
        for (; k < reach.ends[row]; ++k, weights += kWeightValues) {
            const std::ptrdiff_t place = reach.places[k];
            Float8 fit = ofRow;
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC unroll 10
#endif
            for (int i = kCoordinates; i < kCount; ++i)
                fit = multiplyAdd(solution[i], load(tile.features[i - kCoordinates] + place), fit);
            const Float8 weighed = multiplyAdd(load(weights + kLaneCount), solution[1], load(weights) * fit);
            r = multiplyAdd(weighed, load(red + place), r);
            g = multiplyAdd(weighed, load(green + place), g);
            b = multiplyAdd(weighed, load(blue + place), b);
        }
    }
    sums[0] = r;
    sums[1] = g;
    sums[2] = b;
}

} // namespace
} // namespace rt::image
