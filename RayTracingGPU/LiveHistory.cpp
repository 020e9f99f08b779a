#include "RayTracingGPU/LiveHistory.h"

#include <cstddef>
#include <utility>

#include "Shaders/DenoiseRecords.h"

namespace rt::gpu {
namespace {

app::RenderSettings withoutSampling(app::RenderSettings settings) {
    const app::RenderSettings any;
    settings.width = any.width;
    settings.height = any.height;
    settings.spp = any.spp;
    settings.sppIsKnown = any.sppIsKnown;
    settings.seed = any.seed;
    settings.replicates = any.replicates;
    settings.secondMoments = any.secondMoments;
    settings.adaptive = any.adaptive;
    return settings;
}

} // namespace

void LiveHistory::begin(const shared::Camera& camera, const app::RenderSettings& settings) {
    const app::RenderSettings same = withoutSampling(settings);
    if (same != settings_) forget();
    settings_ = same;
    if (next_->isMade) std::swap(last_, next_); // else the film before has shown nothing
    next_->isMade = false;
    camera_ = camera;
    ++films_;
}

void LiveHistory::forget() {
    last_->isMade = next_->isMade = false;
}

HistoryStep LiveHistory::step(std::uint32_t width, std::uint32_t height, std::uint64_t samples, bool isOne) {
    const auto make = [&](std::size_t bytes) {
        return vulkan::Buffer(context_.memory(), bytes, 0, vulkan::Memory::Device, "the history of live pictures");
    };
    if (views_.bytes() == 0) views_ = make(sizeof(shared::HistoryCameras));
    if (next_->width != width || next_->height != height) {
        *next_ = {}; // its memory may be needed
        next_->planes = make(std::size_t{width} * height * shared::kHistoryPlanes * sizeof(shared::vec4));
        next_->width = width;
        next_->height = height;
    }
    next_->camera = camera_;
    next_->isMade = true;
    const bool usesLast = last_->isMade && static_cast<float>(samples) <= shared::kHistorySamples;
    HistoryStep step{usesLast ? last_ : nullptr, *next_, views_, static_cast<float>(samples), std::nullopt};
    if (isOne) step.firstHalfOfOne = films_ % 2;
    return step;
}

} // namespace rt::gpu
