// The live denoiser's kernel. Loops over pixels of a row are what compilers make vectors of.
// Included by one translation unit per instruction set; everything here has internal linkage.
#pragma once
#include <algorithm>
#include <cstddef>

#include "Common/Image/Denoise/Float8.h"
#include "Common/Image/Denoise/LiveKernel.h"

namespace rt::image {
namespace {

constexpr int kLiveChunk = 64; // pixels at a time: their sums stay in the nearest cache
static_assert(kLiveChunk % kLaneCount == 0);

struct LiveSums {
    float radiance[3][kLiveChunk] = {}, tones[3][kLiveChunk] = {}, weights[kLiveChunk] = {}, variance[kLiveChunk] = {};
};

// The squared differences of features between pixels of the chunk and those `offset` floats further; up to
// kLaneCount - 1 of them lie behind the row.
RT_CALL void measureFeatures(const LiveRow& row, std::ptrdiff_t first, std::ptrdiff_t offset, int count,
                             float* squared) {
    for (int i = 0; i < count; i += kLaneCount) {
        Float8 sum = broadcast(0);
        for (int feature = 0; feature < row.featureCount; ++feature) {
            const float* here = row.features[feature] + first + i;
            const Float8 difference = load(here) - load(here + offset);
            sum = multiplyAdd(difference, difference, sum);
        }
        store(squared + i, sum);
    }
}

RT_CALL void addWeighted(const float* weights, const float* values, int count, float* __restrict sums) {
    for (int i = 0; i < count; ++i) sums[i] += weights[i] * values[i];
}

// Adds what lies `offset` floats further.
RT_CALL void addNeighbours(const LiveHalf& half, std::ptrdiff_t first, std::ptrdiff_t offset, int count, float kernel,
                           const float* __restrict features, LiveSums& sums) {
    const float *r0 = half.tones[0] + first, *g0 = half.tones[1] + first, *b0 = half.tones[2] + first;
    const float *r1 = r0 + offset, *g1 = g0 + offset, *b1 = b0 + offset;
    const float *v0 = half.variance + first, *v1 = v0 + offset;
    float weights[kLiveChunk];
    for (int i = 0; i < count; ++i) {
        const float r = r0[i] - r1[i], g = g0[i] - g1[i], b = b0[i] - b1[i];
        const float distance = shared::denoiseDistance(r * r + g * g + b * b, v0[i], v1[i]);
        weights[i] = kernel * shared::liveWeight(distance, features[i]);
    }
    for (int i = 0; i < count; ++i) {
        sums.weights[i] += weights[i];
        sums.variance[i] += weights[i] * weights[i] * v1[i];
    }
    for (int c = 0; c < 3; ++c) {
        addWeighted(weights, half.radiance[c] + first + offset, count, sums.radiance[c]);
        addWeighted(weights, half.tones[c] + first + offset, count, sums.tones[c]);
    }
}

// A pixel is like itself, so that its weights are never all 0.
RT_CALL void storeMeans(const LiveHalf& half, std::ptrdiff_t first, int count, const LiveSums& sums) {
    float shares[kLiveChunk];
    for (int i = 0; i < count; ++i) shares[i] = 1.0f / sums.weights[i];
    for (int i = 0; i < count; ++i) half.newVariance[first + i] = sums.variance[i] * shares[i] * shares[i];
    for (int c = 0; c < 3; ++c) {
        float *radiance = half.newRadiance[c] + first, *tones = half.newTones[c] + first;
        for (int i = 0; i < count; ++i) radiance[i] = sums.radiance[c][i] * shares[i];
        for (int i = 0; i < count; ++i) tones[i] = sums.tones[c][i] * shares[i];
    }
}

void filterRow(const LiveRow& row) {
    for (int first = 0; first < row.width; first += kLiveChunk) {
        const int count = std::min(kLiveChunk, row.width - first);
        LiveSums sums[2];
        for (int down = -row.above; down <= row.below; ++down)
            for (int across = -shared::kLiveReach; across <= shared::kLiveReach; ++across) {
                const std::ptrdiff_t offset = down * row.step * row.pitch + across * row.step;
                const float kernel = shared::liveKernel(down) * shared::liveKernel(across);
                float features[kLiveChunk];
                measureFeatures(row, first, offset, count, features);
                for (int half = 0; half < 2; ++half)
                    addNeighbours(row.half[half], first, offset, count, kernel, features, sums[half]);
            }
        for (int half = 0; half < 2; ++half) storeMeans(row.half[half], first, count, sums[half]);
    }
}

} // namespace
} // namespace rt::image
