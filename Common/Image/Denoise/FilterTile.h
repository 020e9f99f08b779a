// The denoiser's kernel: first-order regression after Bitterli et al. 2016, "Nonlinearly Weighted First-order
// Regression for Denoising Monte Carlo Renderings". Around each pixel of a half, radiance is fitted by a linear
// function of features, by weighted least squares; what the function is at the pixel replaces its radiance.
// Included by one translation unit per instruction set; everything here has internal linkage.
#pragma once
#include <cstdint>

#include "Common/Image/Denoise/DenoiseKernel.h"
#include "Common/Image/Denoise/Float8.h"
#include "Common/Image/Denoise/PixelDistances.h"
#include "Common/Image/Denoise/WeightedSums.h"
#include "Common/Shared/Denoise/DenoiseFit.h"

namespace rt::image {
namespace {

using shared::kDenoisePatchReach;
using shared::uint;

constexpr int kPatchesOfRow = 2 * kDenoiseOffsets * kDenoiseTile;

// The parts of DenoiseTile::scratch.
struct Scratch {
    float* ring;    // [offset][row mod kDenoiseRing][column]: distances of pixels
    float* patches; // [of two rows][patch size][column / 8][offset][lane]: mean distances of patches
    float* weights; // Reach::weights

    explicit Scratch(float* memory)
        : ring(memory),
          patches(ring + kDenoiseOffsets * kDenoiseRing * kDenoiseDistances),
          weights(patches + 2 * kPatchesOfRow) {}

    float* rowOfRing(int offset, int row) const {
        return ring + (offset * kDenoiseRing + (row + kDenoiseRing) % kDenoiseRing) * kDenoiseDistances;
    }
};

// Distances of the pixels of `row`, which may be in the margin, to those at an offset.
RT_CALL void measureRow(const DenoiseTile& tile, int row, int offset, float* distances) {
    const int from = kDenoiseOrigin + row * kDenoisePitch - kDenoisePatchReach;
    const int to = from + kSteps.at[offset];
    measurePixels<kDenoiseDistances>(tile.guide, tile.variance, from, to, distances);
}

// Sums of a column of patch distances become means of patches, eight pixels at a time.
template <int kReach>
RT_FN void averageColumns(const float* columns, float* patches) {
    constexpr int kSide = 2 * kReach + 1;
    const Float8 share = broadcast(1.0f / (kSide * kSide));
    for (int i = 0; i < kDenoiseTile; i += kLaneCount) {
        Float8 sum = load(columns + i + kDenoisePatchReach - kReach);
        for (int dx = 1 - kReach; dx <= kReach; ++dx) sum = sum + load(columns + i + kDenoisePatchReach + dx);
        store(patches + i * kDenoiseOffsets, share * sum);
    }
}

// Sums of the columns of patches of both sizes, of the pixels of two rows and those at one offset.
struct ColumnSums {
    float small[2][kDenoiseDistances], large[2][kDenoiseDistances];
};

// `ring` has the rows that the larger patches need, the upper ones first; both rows have most of them in common.
RT_CALL void sumColumns(const float* const (&ring)[kDenoiseRing], ColumnSums& sums) {
    for (int i = 0; i < kDenoiseDistances; i += kLaneCount) {
        const Float8 middle = load(ring[3] + i) + load(ring[4] + i);
        const Float8 upper = load(ring[2] + i) + middle, lower = middle + load(ring[5] + i);
        const Float8 common = load(ring[1] + i) + (upper + load(ring[5] + i)) + load(ring[6] + i);
        store(sums.small[0] + i, upper);
        store(sums.small[1] + i, lower);
        store(sums.large[0] + i, load(ring[0] + i) + common);
        store(sums.large[1] + i, common + load(ring[7] + i));
    }
}
static_assert(kDenoiseRing == 8);

// Of a symmetric positive definite system, given by its lower triangle: L D L^T, with L in its place and 1 / D.
template <int kCount>
RT_FN void factorize(Float8 (&a)[kCount][kCount], Float8 (&inverse)[kCount]) {
    Float8 diagonal[kCount];
    for (int i = 0; i < kCount; ++i) {
        Float8 d = a[i][i];
        for (int k = 0; k < i; ++k) d = negateMultiplyAdd(a[i][k] * a[i][k], diagonal[k], d);
        diagonal[i] = maximum(d, broadcast(1.0e-7f)); // rounding must not make it negative
        inverse[i] = broadcast(1) / diagonal[i];
        for (int j = i + 1; j < kCount; ++j) {
            Float8 sum = a[j][i];
            for (int k = 0; k < i; ++k) sum = negateMultiplyAdd(a[j][k] * a[i][k], diagonal[k], sum);
            a[j][i] = sum * inverse[i];
        }
    }
}

template <int kCount>
RT_FN void solve(const Float8 (&l)[kCount][kCount], const Float8 (&inverse)[kCount], Float8 (&x)[kCount]) {
    for (int i = 0; i < kCount; ++i)
        for (int j = 0; j < i; ++j) x[i] = negateMultiplyAdd(l[i][j], x[j], x[i]);
    for (int i = kCount - 1; i >= 0; --i) {
        x[i] = x[i] * inverse[i];
        for (int j = i + 1; j < kCount; ++j) x[i] = negateMultiplyAdd(l[j][i], x[j], x[i]);
    }
}

// Where eight pixels are, what they have in reach, and where their results go.
struct Eight {
    int first; // in a plane
    int pixel; // in the planes that are written
    int row;   // of the tile
    uint candidate;
};

// Adds to `factors` that by which the radiance of eight pixels, each so many steps from one of the eight that are
// fitted, enters the fit. `solution`: inverse of the products . features at the pixel that is fitted.
template <int kCount>
RT_CALL void addFactor(const DenoiseTile& tile, const Eight& eight, const float* patches, int stepAcross, int stepDown,
                       const Float8 (&solution)[kCount], Float8& factors) {
    const float perSquaredBandwidth = shared::denoisePerSquaredBandwidth(eight.candidate);
    const int down = shared::denoisePartner(stepDown, eight.row);
    float weights[kLaneCount], features[kCount][kLaneCount];
    for (int lane = 0; lane < kLaneCount; ++lane) {
        const int across = shared::denoisePartner(stepAcross, lane),
                  place = eight.first + lane + down * kDenoisePitch + across;
        const int offset = (down + kDenoiseReach) * kDenoiseRowOffsets + across + kDenoiseReach;
        weights[lane] =
            tile.inside[place] * shared::denoiseWeight(patches[offset * kLaneCount + lane], perSquaredBandwidth);
        features[0][lane] = 1;
        features[1][lane] = shared::kDenoisePixel * static_cast<float>(across);
        features[2][lane] = shared::kDenoisePixel * static_cast<float>(down);
        for (int i = kCoordinates; i < kCount; ++i) features[i][lane] = tile.features[i - kCoordinates][place];
    }
    Float8 fit = broadcast(0);
    for (int i = 0; i < kCount; ++i) fit = multiplyAdd(solution[i], load(features[i]), fit);
    factors = multiplyAdd(load(weights), fit, factors);
}

// What is fitted at a pixel is a sum over those in reach of weight x (features at the pixel . inverse of the products .
// features there) x radiance: one system serves all channels, and no product of features and radiance is needed.
template <int kCount>
RT_CALL void regress(const DenoiseTile& tile, const Reach& reach, const Eight& eight, const float* patches) {
    Float8 products[kCount][kCount], inverse[kCount], solution[kCount], fitted[3];
    sumProducts<kCount>(tile, reach, products);
    products[0][0] = products[0][0] + broadcast(shared::kDenoiseTiny);
    for (int i = 1; i < kCount; ++i)
        products[i][i] = products[i][i] +
                         multiplyAdd(broadcast(shared::kDenoiseRidge), products[0][0], broadcast(shared::kDenoiseTiny));
    factorize(products, inverse);
    for (int i = 0; i < kCoordinates; ++i) solution[i] = broadcast(i == 0 ? 1.0f : 0.0f);
    for (int i = kCoordinates; i < kCount; ++i) solution[i] = load(tile.features[i - kCoordinates] + eight.first);
    solve(products, inverse, solution);
    sumFitted<kCount>(tile, reach, solution, fitted);
    for (int c = 0; c < 3; ++c)
        store(tile.filtered[eight.candidate][c] + eight.pixel, maximum(fitted[c], broadcast(0)));
    Float8 own = broadcast(0), partners = broadcast(0);
    addFactor(tile, eight, patches, 0, 0, solution, own);
    store(tile.ownFactor[eight.candidate] + eight.pixel, own);
    if (tile.dependentSide == 1) return;
    addFactor(tile, eight, patches, 1, 0, solution, partners);
    addFactor(tile, eight, patches, 0, 1, solution, partners);
    addFactor(tile, eight, patches, 1, 1, solution, partners);
    store(tile.partnerFactor[eight.candidate] + eight.pixel, partners);
}

RT_CALL void regress(const DenoiseTile& tile, const Reach& reach, const Eight& eight, const float* patches) {
    switch (tile.featureCount) {
        case 0:
            return regress<3>(tile, reach, eight, patches);
        case 1:
            return regress<4>(tile, reach, eight, patches);
        case 2:
            return regress<5>(tile, reach, eight, patches);
        case 3:
            return regress<6>(tile, reach, eight, patches);
        default:
            return regress<7>(tile, reach, eight, patches);
    }
}
static_assert(kDenoiseSurfaceFeatures == 4);

// Mean distances of the patches of a row and the next: for each eight pixels, by offset. First the columns of all
// offsets of a row are summed, as what has just been stored takes long to load again at another place.
RT_CALL void averageRows(Scratch scratch, int row) {
    ColumnSums sums[kDenoiseRowOffsets];
    for (int first = 0; first < kDenoiseOffsets; first += kDenoiseRowOffsets) {
        for (int i = 0; i < kDenoiseRowOffsets; ++i) {
            const float* ring[kDenoiseRing];
            for (int k = 0; k < kDenoiseRing; ++k) ring[k] = scratch.rowOfRing(first + i, row + k - kDenoisePatchReach);
            sumColumns(ring, sums[i]);
        }
        for (int which = 0; which < 2; ++which)
            for (int i = 0; i < kDenoiseRowOffsets; ++i) {
                float* patches = scratch.patches + which * kPatchesOfRow + (first + i) * kLaneCount;
                averageColumns<1>(sums[i].small[which], patches);
                averageColumns<kDenoisePatchReach>(sums[i].large[which], patches + kDenoiseTile * kDenoiseOffsets);
            }
    }
}

void filterTile(const DenoiseTile& tile) {
    const Scratch scratch(tile.scratch);
    Reach reach;
    reach.weights = scratch.weights;
    const auto measure = [&](int row) {
        for (int offset = 0; offset < kDenoiseOffsets; ++offset)
            measureRow(tile, row, offset, scratch.rowOfRing(offset, row));
    };
    for (int row = -kDenoisePatchReach; row < kDenoisePatchReach; ++row) measure(row);
    for (int row = 0; row < tile.rows; ++row) {
        if (row % 2 == 0) { // the last may be beyond the tile, but is in its margin
            measure(row + kDenoisePatchReach);
            measure(row + kDenoisePatchReach + 1);
            averageRows(scratch, row);
        }
        for (int column = 0; column < tile.columns; column += kLaneCount) {
            const int first = kDenoiseOrigin + row * kDenoisePitch + column;
            for (std::uint32_t i = 0; i < shared::kDenoiseBandwidths; ++i) {
                const int size = shared::denoiseBandwidth(i).patchReach == 1 ? 0 : 1;
                const float* patches =
                    scratch.patches + row % 2 * kPatchesOfRow + (size * kDenoiseTile + column) * kDenoiseOffsets;
                weigh(tile, patches, shared::denoisePerSquaredBandwidth(i), first, reach);
                regress(tile, reach, {first, row * kDenoiseTile + column, row, i}, patches);
            }
        }
    }
}

} // namespace
} // namespace rt::image
