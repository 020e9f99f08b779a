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
constexpr int kDenoiseRowOffsets = 2 * kDenoiseReach + 1; // of a row, and rows
#if defined(__AVX512VL__)
constexpr int kRowsAtOnce = 4; // of the normal equations: as many as registers hold the sums of
#else
constexpr int kRowsAtOnce = 2;
#endif

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
    struct Place {
        int inPlane;
        float step; // the coordinate across
    };
    Place places[kDenoiseOffsets];
    std::ptrdiff_t ends[kDenoiseRowOffsets]; // of each row, in `places`
    float* weights;                          // [place][lane]
    Float8 total, across, down;              // sums of weights, and of weights times coordinates
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
        const int start = first + kSteps.at[row * kDenoiseRowOffsets];
        const float *inside = tile.inside + start, *distances = patches + row * kDenoiseRowOffsets * kLaneCount;
        Float8 total = zero, across = zero, across2 = zero;
        float* weights = reach.weights + count * kLaneCount;
        RT_UNROLL
        for (int column = 0; column < kDenoiseRowOffsets; ++column) {
            const Float8 step = coordinate(column);
            float ofLanes[kLaneCount];
            RT_AS_VECTOR
            for (int lane = 0; lane < kLaneCount; ++lane)
                ofLanes[lane] = shared::denoiseWeight(distances[column * kLaneCount + lane], perSquaredBandwidth);
            const Float8 weight = load(ofLanes) * load(inside + column);
            const Float8 acrossWeight = weight * step;
            total = total + weight;
            across = across + acrossWeight;
            across2 = multiplyAdd(acrossWeight, step, across2);
            store(weights, weight);
            reach.places[count] = {start + column, shared::kDenoisePixel * static_cast<float>(column - kDenoiseReach)};
            const std::ptrdiff_t any = isAnyPositive(weight) ? 1 : 0;
            count += any;
            weights += any * kLaneCount;
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

// Rows of the normal equations, and those after them, of the surface's features from the `kFeature`th on: sums of
// weight x a feature x (1, coordinates, each feature from this one on).
template <int kFeature, int kCount>
RT_CALL void sumFeatures(const DenoiseTile& tile, const Reach& reach, Float8 (&products)[kCount][kCount]) {
    constexpr int kRow = kCoordinates + kFeature, kLater = kCount - kRow;
    constexpr int kRows = kLater < kRowsAtOnce ? kLater : kRowsAtOnce;
    Float8 total[kRows]{}, across[kRows]{}, down[kRows]{}, sums[kRows][kLater]{};
    const float* features[kLater];
    for (int i = 0; i < kLater; ++i) features[i] = tile.features[kFeature + i];
    const float* weights = reach.weights;
    std::ptrdiff_t k = 0;
    for (int row = 0; row < kDenoiseRowOffsets; ++row) {
        Float8 ofRow[kRows]{};
        for (; k < reach.ends[row]; ++k, weights += kLaneCount) {
            const std::ptrdiff_t place = reach.places[k].inPlane;
            const Float8 weight = load(weights), step = broadcast(reach.places[k].step);
            Float8 own[kLater];
            RT_UNROLL
            for (int i = 0; i < kLater; ++i) own[i] = load(features[i] + place);
            RT_UNROLL
            for (int i = 0; i < kRows; ++i) {
                const Float8 weighed = weight * own[i];
                ofRow[i] = ofRow[i] + weighed;
                across[i] = multiplyAdd(weighed, step, across[i]);
                RT_UNROLL
                for (int j = i; j < kLater; ++j) sums[i][j] = multiplyAdd(weighed, own[j], sums[i][j]);
            }
        }
        RT_UNROLL
        for (int i = 0; i < kRows; ++i) {
            total[i] = total[i] + ofRow[i];
            down[i] = multiplyAdd(ofRow[i], coordinate(row), down[i]);
        }
    }
    RT_UNROLL
    for (int i = 0; i < kRows; ++i) {
        products[kRow + i][0] = total[i];
        products[kRow + i][1] = across[i];
        products[kRow + i][2] = down[i];
        RT_UNROLL
        for (int j = i; j < kLater; ++j) products[kRow + j][kRow + i] = sums[i][j];
    }
    if constexpr (kRow + kRows < kCount) sumFeatures<kFeature + kRows, kCount>(tile, reach, products);
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
    if constexpr (kCount > kCoordinates) sumFeatures<0, kCount>(tile, reach, products);
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
        for (; k < reach.ends[row]; ++k, weights += kLaneCount) {
            const std::ptrdiff_t place = reach.places[k].inPlane;
            Float8 fit = multiplyAdd(solution[1], broadcast(reach.places[k].step), ofRow);
            RT_UNROLL
            for (int i = kCoordinates; i < kCount; ++i)
                fit = multiplyAdd(solution[i], load(tile.features[i - kCoordinates] + place), fit);
            const Float8 weighed = load(weights) * fit;
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
