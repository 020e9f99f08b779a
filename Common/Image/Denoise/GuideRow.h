// The kernel of DenoiseGuide.h: one row of a half's tones, less noisy by those around. Included by one translation unit
// per instruction set; everything here has internal linkage.
#pragma once
#include <algorithm>

#include "Common/Image/Denoise/DenoiseKernel.h"
#include "Common/Image/Denoise/PixelDistances.h"
#include "Common/Shared/Denoise/DenoiseGuide.h"

namespace rt::image {
namespace {

constexpr int kGuideColumns = 64; // pixels that are filtered at a time
constexpr int kGuideDistances = kGuideColumns + 2 * shared::kDenoiseGuidePatchReach;

// Sums, down the columns of patches, of the distances between pixels from `first` on and those `step` floats behind.
RT_CALL void sumGuideColumns(const DenoiseGuideRow& row, int first, int step, float* sums) {
    for (int i = 0; i < kGuideDistances; ++i) sums[i] = 0;
    for (int dy = -shared::kDenoiseGuidePatchReach; dy <= shared::kDenoiseGuidePatchReach; ++dy) {
        const int here = first + dy * row.pitch - shared::kDenoiseGuidePatchReach;
        float distances[kGuideDistances];
        measurePixels<kGuideDistances>(row.tones, row.variance, here, here + step, distances);
        for (int i = 0; i < kGuideDistances; ++i) sums[i] += distances[i];
    }
}

// What the weights of a pixel's neighbours sum up to.
struct GuideSums {
    float weights[kGuideColumns], squares[kGuideColumns], tones[3][kGuideColumns];
};

RT_CALL void addGuideOffset(const DenoiseGuideRow& row, int first, int step, GuideSums& sums) {
    constexpr float kShare = 1.0f / 9;
    float columns[kGuideDistances];
    sumGuideColumns(row, first, step, columns);
    const float* inside = row.inside + first + step;
    const float *r = row.tones[0] + first + step, *g = row.tones[1] + first + step, *b = row.tones[2] + first + step;
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC ivdep
#endif
    for (int i = 0; i < kGuideColumns; ++i) {
        const float distance = kShare * (columns[i] + columns[i + 1] + columns[i + 2]);
        const float weight = step == 0 ? 1.0f : inside[i] * shared::denoiseGuideWeight(distance);
        sums.weights[i] += weight;
        sums.squares[i] += weight * weight;
        sums.tones[0][i] += weight * r[i];
        sums.tones[1][i] += weight * g[i];
        sums.tones[2][i] += weight * b[i];
    }
}
static_assert(shared::kDenoiseGuidePatchReach == 1);

void smoothGuideRow(const DenoiseGuideRow& row) {
    for (int first = 0; first < row.width; first += kGuideColumns) {
        GuideSums sums{};
        for (int dy = -shared::kDenoiseGuideReach; dy <= shared::kDenoiseGuideReach; ++dy)
            for (int dx = -shared::kDenoiseGuideReach; dx <= shared::kDenoiseGuideReach; ++dx)
                addGuideOffset(row, first, dy * row.pitch + dx, sums);
        const int count = std::min(kGuideColumns, row.width - first);
        for (int i = 0; i < count; ++i) {
            for (int c = 0; c < 3; ++c)
                row.guide[c][first + i] =
                    shared::denoiseGuideTone(row.tones[c][first + i], sums.tones[c][i] / sums.weights[i]);
            row.guideVariance[first + i] =
                row.variance[first + i] * shared::denoiseGuideVariance(sums.weights[i], sums.squares[i]);
        }
    }
}

} // namespace
} // namespace rt::image
