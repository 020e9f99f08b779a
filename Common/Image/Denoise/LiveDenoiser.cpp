#include "Common/Image/Denoise/LiveDenoiser.h"

#include <algorithm>
#include <cmath>

#include "Common/Core/Interruption.h"
#include "Common/Core/KernelSets.h"
#include "Common/Core/Parallel.h"
#include "Common/Image/Denoise/Planes.h"

namespace rt::image {
namespace {

constexpr std::size_t kRowsAtATime = 4; // that a thread takes

LiveKernel bestLiveKernel() {
    const InstructionSet best = bestInstructionSet();
#define RT_TAKE(set, suffix) \
    if (best >= InstructionSet::set) return liveKernel_##suffix();
    RT_KERNEL_SETS(RT_TAKE)
#undef RT_TAKE
    failWithoutKernels(best);
}

template <class Work>
void forEachRow(std::size_t threads, std::size_t height, const Work& work) {
    parallelChunks(threads, height, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
        interruptionPoint();
        for (std::size_t y = begin; y < end; ++y) work(y);
    });
}

float bounded(float value, float low, float high) {
    return std::isfinite(value) ? std::clamp(value, low, high) : 0.0f;
}

} // namespace

void LiveDenoiser::MarginPlane::resize(std::size_t width, std::size_t height, float outside) {
    if (width == width_ && height == height_) return;
    width_ = width;
    height_ = height;
    pitch_ = width + 2 * kLiveMargin;
    data_.assign(height * pitch_ + kLiveOverrun, outside);
}

void LiveDenoiser::loadRow(const DenoiseInput& input, std::uint32_t y) {
    for (std::size_t half = 0; half < 2; ++half) {
        const float* values = (half == 0 ? input.halfA : input.halfB).pixel(0, y);
        for (std::size_t c = 0; c < 3; ++c) {
            float* radiance = levels_[0][1 - half].radiance[c].row(y); // by the other one's weights
            float* tones = levels_[0][half].tones[c].row(y);
            for (std::size_t x = 0; x < width_; ++x)
                radiance[x] = bounded(values[3 * x + c], 0, shared::kDenoiseMaxRadiance);
            for (std::size_t x = 0; x < width_; ++x) tones[x] = shared::denoiseTone(radiance[x]);
        }
    }
    loadFeatures(input, y);
}

void LiveDenoiser::loadFeatures(const DenoiseInput& input, std::uint32_t y) {
    constexpr float kMost = 2;
    std::size_t feature = 0;
    for (std::size_t c = 0; c < 3 && !input.albedo.data.empty(); ++c, ++feature)
        for (std::uint32_t x = 0; x < width_; ++x)
            features_[feature].row(y)[x] = shared::kLiveAlbedoScale * bounded(input.albedo.pixel(x, y)[c], 0, kMost);
    for (std::size_t c = 0; c < 3 && !input.normal.data.empty(); ++c, ++feature)
        for (std::uint32_t x = 0; x < width_; ++x)
            features_[feature].row(y)[x] =
                shared::kLiveNormalScale * bounded(input.normal.pixel(x, y)[c], -kMost, kMost);
    if (input.depth.data.empty()) return;
    for (std::uint32_t x = 0; x < width_; ++x)
        features_[feature].row(y)[x] = shared::liveDepthFeature(bounded(*input.depth.pixel(x, y), 0, 1e30f));
}

void LiveDenoiser::load(const DenoiseInput& input, std::size_t threads) {
    width_ = input.halfA.width;
    height_ = input.halfA.height;
    featureCount_ =
        (input.albedo.data.empty() ? 0 : 3) + (input.normal.data.empty() ? 0 : 3) + (input.depth.data.empty() ? 0 : 1);
    for (MarginPlane& feature : features_) feature.resize(width_, height_, 0);
    for (auto& level : levels_)
        for (Half& half : level) {
            half.variance.resize(width_, height_, 0);
            for (MarginPlane& plane : half.radiance) plane.resize(width_, height_, 0);
            for (MarginPlane& plane : half.tones) plane.resize(width_, height_, kLiveOutside);
        }
    Plane variance(width_, height_); // of a tone of either half, summed over the channels
    forEachRow(threads, height_, [&](std::size_t y) {
        loadRow(input, static_cast<std::uint32_t>(y));
        float* row = variance.row(y);
        for (std::size_t c = 0; c < 3; ++c) {
            const float *a = levels_[0][0].tones[c].row(y), *b = levels_[0][1].tones[c].row(y);
            for (std::size_t x = 0; x < width_; ++x) row[x] += 0.5f * (a[x] - b[x]) * (a[x] - b[x]);
        }
    });
    boxMeans({&variance, 1}, shared::kDenoiseVarianceReach, threads);
    for (Half& half : levels_[0])
        for (std::size_t y = 0; y < height_; ++y) std::copy_n(variance.row(y), width_, half.variance.row(y));
}

LiveRow LiveDenoiser::describe(int level, std::size_t y) {
    const std::size_t step = static_cast<std::size_t>(shared::liveStep(level)), reach = shared::kLiveReach;
    LiveRow row;
    row.width = static_cast<int>(width_);
    row.step = static_cast<int>(step);
    row.above = static_cast<int>(std::min(reach, y / step));
    row.below = static_cast<int>(std::min(reach, (height_ - 1 - y) / step));
    row.pitch = static_cast<std::ptrdiff_t>(features_[0].pitch());
    row.featureCount = featureCount_;
    for (std::size_t i = 0; i < features_.size(); ++i) row.features[i] = features_[i].row(y);
    for (std::size_t i = 0; i < 2; ++i) {
        Half &from = levels_[static_cast<std::size_t>(level) % 2][i],
             &to = levels_[static_cast<std::size_t>(level + 1) % 2][i];
        LiveHalf& half = row.half[i];
        for (std::size_t c = 0; c < 3; ++c) {
            half.radiance[c] = from.radiance[c].row(y);
            half.tones[c] = from.tones[c].row(y);
            half.newRadiance[c] = to.radiance[c].row(y);
            half.newTones[c] = to.tones[c].row(y);
        }
        half.variance = from.variance.row(y);
        half.newVariance = to.variance.row(y);
    }
    return row;
}

Image LiveDenoiser::filter(const DenoiseInput& input, std::size_t threads) {
    const LiveKernel kernel = bestLiveKernel();
    load(input, threads);
    for (int level = 0; level < shared::kLiveLevels; ++level)
        forEachRow(threads, height_, [&](std::size_t y) { kernel(describe(level, y)); });
    const std::array<Half, 2>& halves = levels_[shared::kLiveLevels % 2];
    Image picture(input.halfA.width, input.halfA.height);
    forEachRow(threads, height_, [&](std::size_t y) {
        float* pixels = picture.pixel(0, static_cast<std::uint32_t>(y));
        for (std::size_t c = 0; c < 3; ++c) {
            const float *a = halves[0].radiance[c].row(y), *b = halves[1].radiance[c].row(y);
            for (std::size_t x = 0; x < width_; ++x) pixels[3 * x + c] = 0.5f * (a[x] + b[x]);
        }
    });
    return picture;
}

} // namespace rt::image
