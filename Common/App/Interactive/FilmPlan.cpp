#include "Common/App/Interactive/FilmPlan.h"

#include <algorithm>
#include <cmath>

#include "Common/Render/RenderParams.h"

namespace rt::app {
namespace {

constexpr double kFrameSeconds = 1.0 / 30; // of a frame that is not accumulated and as large as there is time for
constexpr double kDraftSeconds = 0.02; // of what is shown first after a change, which may wait for the end of another
constexpr double kFirstDraftSeconds = 0.1; // of the very first, by the guess: no camera moves yet
constexpr std::uint32_t kDraftSpp = 4;     // at most

double pixelsOf(const RenderSettings& settings) {
    return static_cast<double>(settings.width) * settings.height;
}

} // namespace

void RenderSpeed::learn(std::uint64_t samples, double seconds, double weight) {
    isLearnt_ = true;
    perSecond_ = (1 - weight) * perSecond_ + weight * static_cast<double>(samples) / std::max(seconds, 1e-4);
}

std::uint32_t RenderSpeed::sppIn(double seconds, const RenderSettings& size, double maximum) const {
    return static_cast<std::uint32_t>(std::clamp(samplesIn(seconds) / pixelsOf(size), 1.0, maximum));
}

RenderSettings sizedSettings(const RenderRequest& request, const scene::CompiledScene& scene) {
    Options options;
    options.size = request.size;
    options.settings = request.settings;
    settleImageSize(options, scene.id, scene.defaults.aspect);
    return options.settings;
}

RenderSettings filmSettings(const RenderRequest& request, const scene::CompiledScene& scene, std::uint32_t round,
                            bool wantsVariance, const RenderSpeed& speed) {
    RenderSettings settings = sizedSettings(request, scene);
    settings.seed += round;
    settings.sppIsKnown = !request.timeLimit && !request.targetError;
    if (request.targetError) settings.replicates = std::max(settings.replicates, kErrorReplicates);
    if (!request.accumulate)
        settings.spp =
            request.samplesPerFrame > 0 ? request.samplesPerFrame : speed.sppIn(kFrameSeconds, settings, 65536);
    if (request.halves) settings.replicates += settings.replicates % kHalves;
    settings.replicates = std::min(settings.replicates, settings.spp);
    if (request.halves && settings.replicates > kHalves) settings.replicates -= settings.replicates % kHalves;
    settleReplicates(settings);
    settings.secondMoments = settings.replicates < 2 && (request.accumulate || wantsVariance);
    return settings;
}

std::optional<RenderSettings> draftSettings(const RenderSettings& film, const RenderSpeed& speed,
                                            std::optional<double> denoiseSecondsPerPixel) {
    const double budget = speed.isLearnt() ? kDraftSeconds : kFirstDraftSeconds;
    double affordable = speed.samplesIn(budget);
    if (affordable >= static_cast<double>(firstPass(film))) return std::nullopt;
    const bool isDenoised = denoiseSecondsPerPixel && film.replicates % kHalves == 0;
    if (isDenoised) // the pixels of two samples that there is time for
        affordable = budget / (kHalves * budget / affordable + *denoiseSecondsPerPixel);
    const double scale = std::sqrt(std::min(1.0, affordable / pixelsOf(film)));
    const auto scaled = [scale](std::uint32_t side) { return std::max(1u, static_cast<std::uint32_t>(side * scale)); };
    RenderSettings draft = film;
    draft.width = scaled(film.width);
    draft.height = scaled(film.height);
    draft.spp = speed.sppIn(budget, film, kDraftSpp);
    draft.adaptive = false;
    draft.replicates = isDenoised ? kHalves : 1;
    if (isDenoised) draft.spp = kHalves;
    draft.secondMoments = false;
    return draft;
}

std::uint64_t firstPass(const RenderSettings& film) {
    return std::uint64_t{film.width} * film.height * std::min(film.spp, image::Film::kBlock);
}

} // namespace rt::app
