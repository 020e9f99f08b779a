// Which film, and which draft before it, a request comes to.
#pragma once
#include <cstdint>
#include <optional>

#include "Common/App/Interactive/InteractiveState.h"

namespace rt::app {

inline constexpr std::uint32_t kHalves = 2; // replicates, that a denoiser needs

// What an engine renders in a second, learnt as it goes: how large drafts and frames may be.
class RenderSpeed {
  public:
    void learn(std::uint64_t samples, double seconds, double weight = 0.5);
    bool isLearnt() const { return isLearnt_; }
    double samplesIn(double seconds) const { return perSecond_ * seconds; }
    // Of each pixel; 1 to `most`.
    std::uint32_t sppIn(double seconds, const RenderSettings& size, double maximum) const;

  private:
    double perSecond_ = 2e5; // a cautious guess at first
    bool isLearnt_ = false;
};

// With the size in pixels.
RenderSettings sizedSettings(const RenderRequest& request, const scene::CompiledScene& scene);

// `round`: films since the last change, each with a seed of its own. `wantsVariance`: of a frame that is not
// accumulated.
RenderSettings filmSettings(const RenderRequest& request, const scene::CompiledScene& scene, std::uint32_t round,
                            bool wantsVariance, const RenderSpeed& speed);

// Of low resolution, to be shown until the film has samples; none where its first pass takes no longer. One that is
// denoised, which takes so many seconds for a pixel, has two halves and takes no longer either.
std::optional<RenderSettings> draftSettings(const RenderSettings& film, const RenderSpeed& speed,
                                            std::optional<double> denoiseSecondsPerPixel = std::nullopt);

// Samples until every pixel of a film has a block of them, or all.
std::uint64_t firstPass(const RenderSettings& film);

} // namespace rt::app
