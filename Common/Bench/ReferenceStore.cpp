#include "Common/Bench/ReferenceStore.h"

#include <algorithm>
#include <cmath>

#include "Common/Image/Metrics.h"
#include "Common/Render/FilmRun.h"
#include "Common/Render/Stopwatch.h"

namespace rt::bench {
namespace {

namespace fs = std::filesystem;
using image::Film;

constexpr double kVarianceShare = 1.0 / 9; // of the measured mse: a third in standard errors
constexpr double kMaxGrowth = 8; // of the number of samples in one step, since the least error is only estimated
constexpr std::uint64_t kMaxSpp = 1u << 30;

const scene::CameraDesc& cameraOf(const ReferenceRequest& request) {
    return request.camera == nullptr ? request.scene->camera : *request.camera;
}

app::ReferenceKey keyOf(const ReferenceRequest& request) {
    return {request.scene->hash, cameraOf(request), request.width, request.height, request.maxDepth};
}

// By what factor its variance is too large; at most 1: it suffices.
double excess(const image::Reference& reference, std::span<const image::Image* const> measured) {
    double variance = 0;
    for (const float value : reference.variance.data) variance += value;
    variance /= static_cast<double>(reference.variance.data.size());
    const double relative = image::referenceRelMse(reference.mean, reference.variance);
    double maximum = 0;
    for (const image::Image* image : measured) {
        const image::ErrorFigures figures = image::compare(*image, reference.mean);
        // What chance leaves of an error after subtraction is not taken below a tenth of what was seen.
        const double mse = std::max(figures.mse - variance, 0.1 * figures.mse);
        const double relmse = std::max(figures.relmse - relative, 0.1 * figures.relmse);
        if (mse > 0) maximum = std::max(maximum, variance / (kVarianceShare * mse));
        const image::MeanSquares upTo1 = image::meanSquaresUpTo1(*image, reference);
        const double mseUpTo1 = std::max(upTo1.mse, 0.1 * (upTo1.mse + upTo1.referenceMse));
        if (relmse > 0) maximum = std::max(maximum, relative / (kVarianceShare * relmse));
        if (mseUpTo1 > 0) maximum = std::max(maximum, upTo1.referenceMse / (kVarianceShare * mseUpTo1));
    }
    return maximum;
}

std::uint64_t roundedUp(double spp) {
    constexpr std::uint64_t kRound = std::uint64_t{Film::kBlock} * app::kReferenceReplicates;
    const auto rounds = static_cast<std::uint64_t>(std::ceil(std::min(spp, double(kMaxSpp)) / double(kRound)));
    return std::clamp(rounds * kRound, kRound, kMaxSpp);
}

} // namespace

fs::path ReferenceStore::fileOf(const ReferenceRequest& request) const {
    return cache_.fileOf(keyOf(request));
}

std::optional<ReferenceResult> ReferenceStore::provide(const ReferenceRequest& request,
                                                       std::span<const image::Image* const> measured,
                                                       app::Engine& engine, const std::atomic<bool>& stop) {
    const app::ReferenceKey key = keyOf(request);
    app::RenderSettings settings = app::referenceSettings(key, 0);
    Film film = fresh_ ? Film() : cache_.load(key).value_or(Film());
    ReferenceResult result;
    result.cached = film.totalSamples() > 0;
    const std::uint64_t before = film.totalSamples();
    double target = static_cast<double>(std::max<std::uint64_t>(request.firstSpp, 2 * app::kReferenceReplicates));
    for (;;) {
        if (film.totalSamples() > 0) {
            result.reference = {film.resolve(), film.varianceOfMean()};
            result.spp = film.minSamples();
            const double factor = excess(result.reference, measured);
            result.sufficient = factor <= 1;
            if (result.sufficient || stop || result.seconds >= request.maxSeconds || result.spp >= kMaxSpp) break;
            target = static_cast<double>(result.spp) * std::clamp(1.2 * factor, 1.5, kMaxGrowth);
        }
        settings.spp = static_cast<std::uint32_t>(roundedUp(target));
        app::FilmRun run(engine, cameraOf(request), settings, std::move(film));
        run.limit({.seconds = request.maxSeconds - result.seconds});
        run.untilStopped(stop);
        result.seconds += run.seconds();
        film = engine.film();
        if (film.totalSamples() == 0) return std::nullopt;
    }
    if (film.totalSamples() > before) cache_.save(key, film);
    // A mean of fewer than two samples in each replicate has no variance to tell.
    if (result.spp < 2 * app::kReferenceReplicates) return std::nullopt;
    return result;
}

} // namespace rt::bench
