#include "Common/Render/FilmRun.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Render/FilmEstimate.h"
#include "Common/Render/RenderParams.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kCheckGrowth = 1.1;     // samples between two looks at the error
constexpr std::uint32_t kMinSamples = 4; // of each replicate, before a look says anything

} // namespace

FilmRun::FilmRun(Engine& engine, const scene::CameraDesc& camera, const RenderSettings& settings, image::Film kept)
    : engine_(&engine), camera_(camera), settings_(settings), samplesRestored_(kept.totalSamples()) {
    engine.reset(camera, settings);
    if (samplesRestored_ > 0) engine.restore(std::move(kept));
    status_.samplesDone = samplesRestored_;
    status_.samplesTotal = pixels() * settings.spp;
    limit({});
}

void FilmRun::renderOnly(const image::TileList& tiles) {
    const image::Film& film = engine_->film();
    samplesRestored_ = status_.samplesDone = image::totalSamples(film, tiles);
    status_.samplesTotal = image::pixelCount(film, tiles) * settings_.spp;
    engine_->renderOnly(tiles, settings_.spp);
}

bool FilmRun::canTake(std::uint32_t spp) const {
    if (isMadeForSpp(settings_)) return spp == settings_.spp;
    return engine_->film().maxSamples() <= spp;
}

void FilmRun::setSpp(std::uint32_t spp) {
    image::Film film = engine_->film();
    before_ = report();
    settings_.spp = spp;
    engine_->reset(camera_, settings_);
    engine_->restore(std::move(film));
    status_.samplesTotal = pixels() * spp;
    status_.finished = status_.samplesDone >= status_.samplesTotal;
}

EngineReport FilmRun::report() const {
    EngineReport report = engine_->report();
    report.rays += before_.rays;
    report.nonfiniteSamples += before_.nonfiniteSamples;
    report.cutOff += before_.cutOff;
    report.renderDeviceSeconds += before_.renderDeviceSeconds;
    return report;
}

void FilmRun::limit(RunLimits limits) {
    limits_ = std::move(limits);
    limit_ = elapsed_ + limits_.seconds.value_or(kNever);
    nextSave_ = elapsed_ + limits_.saveEvery.value_or(kNever);
    nextCheck_ = 0;
    wasBelowTarget_ = false;
}

std::optional<StopReason> FilmRun::slice(double seconds, const std::atomic<bool>& cancel) {
    const Stopwatch watch;
    const double before = elapsed_;
    status_ = engine_->renderSome(
        {std::chrono::duration<double>(std::clamp(limit_ - before, 0.0, seconds)), &cancel, isWatched_});
    seconds_ += watch.seconds();
    elapsed_ = before + watch.seconds();

    if (status_.finished) return StopReason::Spp;
    if (cancel) return StopReason::Interrupted;
    if (elapsed_ >= limit_) return StopReason::TimeLimit;
    const bool isGoodEnough = reachesTargetError();
    elapsed_ = before + watch.seconds();
    if (isGoodEnough) return StopReason::TargetError;
    if (elapsed_ >= nextSave_) {
        limits_.save();
        elapsed_ = before + watch.seconds();
        nextSave_ = elapsed_ + *limits_.saveEvery;
    }
    return std::nullopt;
}

// Two looks one after the other must agree. Looks only when there are 10 % more samples than the last time, so that
// looking costs little and chance gets few opportunities.
bool FilmRun::reachesTargetError() {
    if (!limits_.targetError || static_cast<double>(status_.samplesDone) < nextCheck_) return false;
    nextCheck_ = kCheckGrowth * static_cast<double>(status_.samplesDone);
    const image::Film& film = engine_->film();
    if (film.minReplicateSamples() < kMinSamples) return false;
    const auto relmse =
        limits_.estimate ? limits_.estimate(film) : estimateRelMse(film, dependentSide(engine_->report().features));
    const bool isBelow = relmse && relmse->high() < *limits_.targetError;
    return std::exchange(wasBelowTarget_, isBelow) && isBelow;
}

StopReason FilmRun::untilStopped(const std::atomic<bool>& cancel) {
    std::optional<StopReason> reason;
    while (!reason) reason = slice(kSliceSeconds, cancel);
    return *reason;
}

ProgressState FilmRun::progress() const {
    ProgressState state{
        status_.samplesDone, status_.samplesTotal, samplesRestored_, status_.samplesTotal / settings_.spp, elapsed_,
        limits_.seconds};
    const std::vector<RankFigures> ranks = engine_->report().ranks;
    state.ranks = ranks.size();
    const auto isLess = [](const RankFigures& a, const RankFigures& b) { return a.busyShare < b.busyShare; };
    if (!ranks.empty()) state.minBusy = std::min_element(ranks.begin(), ranks.end(), isLess)->busyShare;
    return state;
}

const image::Film& FilmRun::keptFilm(std::string& lost) const {
    try {
        return engine_->film();
    } catch (const RenderError& error) {
        lost = error.what();
        return engine_->film();
    }
}

} // namespace rt::app
