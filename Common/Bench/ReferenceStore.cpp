#include "Common/Bench/ReferenceStore.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "Common/App/Session/FilmRun.h"
#include "Common/App/Session/Stopwatch.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Core/Hash.h"
#include "Common/Core/Log.h"
#include "Common/Image/Metrics.h"

namespace rt::bench {
namespace {

namespace fs = std::filesystem;
using image::Film;

constexpr double kVarianceShare = 1.0 / 9; // of the measured mse: a third in standard errors
constexpr double kMostGrowth = 8; // of the number of samples in one step, since the least error is only estimated
constexpr std::uint64_t kMostSpp = 1u << 30;
constexpr std::uint32_t kFormat = 1;

image::FilmDesc filmDesc(const ReferenceRequest& request) {
    return {request.width, request.height, kReferenceReplicates, false};
}

app::RenderSettings settingsFor(const ReferenceRequest& request) {
    app::RenderSettings settings; // the defaults are the best estimator there is
    settings.width = request.width;
    settings.height = request.height;
    settings.maxDepth = request.maxDepth;
    settings.seed = kReferenceSeed;
    settings.replicates = kReferenceReplicates;
    return settings;
}

std::optional<Film> load(const fs::path& file, const image::FilmDesc& desc) {
    std::error_code none;
    if (file.empty() || !fs::is_regular_file(file, none)) return std::nullopt;
    try {
        std::ifstream in(file, std::ios::binary);
        return Film::readState(desc, in, file.string());
    } catch (const InputError& error) {
        logWarning(std::string(error.what()) + "; the reference is made anew");
        return std::nullopt;
    }
}

void save(const fs::path& file, const Film& film) {
    if (file.empty()) return;
    try {
        fs::create_directories(file.parent_path());
        AtomicFile target(file);
        film.writeState(target.stream());
        target.commit();
    } catch (const std::exception& error) {
        logWarning(std::string("the reference is not kept: ") + error.what());
    }
}

// By what factor its variance is too large; at most 1: it suffices.
double excess(const image::Reference& reference, std::span<const image::Image* const> measured) {
    double variance = 0;
    for (const float value : reference.variance.data) variance += value;
    variance /= static_cast<double>(reference.variance.data.size());
    const double relative = image::estimatedRelMse(reference.mean, reference.variance);
    double most = 0;
    for (const image::Image* image : measured) {
        const image::ErrorFigures figures = image::compare(*image, reference.mean);
        // What chance leaves of an error after subtraction is not taken below a tenth of what was seen.
        const double mse = std::max(figures.mse - variance, 0.1 * figures.mse);
        const double relmse = std::max(figures.relmse - relative, 0.1 * figures.relmse);
        if (mse > 0) most = std::max(most, variance / (kVarianceShare * mse));
        const image::MeanSquares upTo1 = image::meanSquaresUpTo1(*image, reference);
        const double mseUpTo1 = std::max(upTo1.mse, 0.1 * (upTo1.mse + upTo1.referenceMse));
        if (relmse > 0) most = std::max(most, relative / (kVarianceShare * relmse));
        if (mseUpTo1 > 0) most = std::max(most, upTo1.referenceMse / (kVarianceShare * mseUpTo1));
    }
    return most;
}

std::uint64_t roundedUp(double spp) {
    constexpr std::uint64_t kRound = std::uint64_t{Film::kBlock} * kReferenceReplicates;
    const auto rounds = static_cast<std::uint64_t>(std::ceil(std::min(spp, double(kMostSpp)) / double(kRound)));
    return std::clamp(rounds * kRound, kRound, kMostSpp);
}

} // namespace

fs::path ReferenceStore::fileOf(const ReferenceRequest& request) const {
    if (folder_.empty()) return {};
    const std::uint64_t parts[] = {kFormat,          request.scene->hash,  request.width, request.height,
                                   request.maxDepth, kReferenceReplicates, kReferenceSeed};
    std::uint64_t hash = hashBytes(std::as_bytes(std::span(parts)));
    const std::string version = RT_VERSION;
    hash = hashBytes(std::as_bytes(std::span(version.data(), version.size())), hash);
    const scene::CameraDesc& c = request.scene->camera; // no part of the scene's hash
    const double camera[] = {c.lookFrom.x, c.lookFrom.y, c.lookFrom.z, c.lookAt.x,    c.lookAt.y,     c.lookAt.z,
                             c.up.x,       c.up.y,       c.up.z,       c.verticalFov, c.defocusAngle, c.focusDistance};
    hash = hashBytes(std::as_bytes(std::span(camera)), hash);
    char name[32];
    std::snprintf(name, sizeof name, "%016llx.rtr", static_cast<unsigned long long>(hash));
    return folder_ / name;
}

std::optional<ReferenceResult> ReferenceStore::provide(const ReferenceRequest& request,
                                                       std::span<const image::Image* const> measured,
                                                       app::Engine& engine, const std::atomic<bool>& stop) {
    const fs::path file = fileOf(request);
    app::RenderSettings settings = settingsFor(request);
    Film film = fresh_ ? Film() : load(file, filmDesc(request)).value_or(Film());
    ReferenceResult result;
    result.cached = film.totalSamples() > 0;
    const std::uint64_t before = film.totalSamples();
    double target = static_cast<double>(std::max<std::uint64_t>(request.firstSpp, 2 * kReferenceReplicates));
    for (;;) {
        if (film.totalSamples() > 0) {
            result.reference = {film.resolve(), film.varianceOfMean()};
            result.spp = film.minSamples();
            const double factor = excess(result.reference, measured);
            result.sufficient = factor <= 1;
            if (result.sufficient || stop || result.seconds >= request.maxSeconds || result.spp >= kMostSpp) break;
            target = static_cast<double>(result.spp) * std::clamp(1.2 * factor, 1.5, kMostGrowth);
        }
        settings.spp = static_cast<std::uint32_t>(roundedUp(target));
        app::FilmRun run(engine, request.scene->camera, settings, std::move(film));
        run.limit({.seconds = request.maxSeconds - result.seconds});
        run.untilStopped(stop);
        result.seconds += run.seconds();
        film = engine.film();
        if (film.totalSamples() == 0) return std::nullopt;
    }
    if (film.totalSamples() > before) save(file, film);
    // A mean of fewer than two samples in each replicate has no variance to tell.
    if (result.spp < 2 * kReferenceReplicates) return std::nullopt;
    return result;
}

} // namespace rt::bench
