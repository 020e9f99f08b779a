// The worker's side of InteractiveSession: films, and what is shown of them.
#include <algorithm>
#include <cmath>
#include <utility>

#include "Common/App/Interactive/Draft.h"
#include "Common/App/Interactive/InteractiveSession.h"
#include "Common/App/Session/FilmEstimate.h"

namespace rt::app {
namespace {

constexpr double kDraftSeconds = 0.02; // of what is shown first after a change, which may wait for the end of another
constexpr double kMostDraftSeconds = 0.25; // when the next change waits already
constexpr std::uint32_t kDraftSpp = 4;     // at most
constexpr double kPublishShare = 0.2;      // of the worker's time, at most, goes into pictures
constexpr double kPictureShare = 0.1;      // of a sum's age passes between two pictures:
constexpr double kLeastInterval = 0.04;    // they cost the render a little, and differ the less the older it is
constexpr double kMostInterval = 0.25;
constexpr double kEarlySeconds = 2;        // after which a sum's pictures have the number of samples that is asked for
constexpr double kFrameSeconds = 1.0 / 30; // of a frame that is not accumulated and as large as there is time for
constexpr double kLongFrameSeconds = 0.5;  // after which a frame is shown while it is being rendered
// Drawing one picture by software takes as long as 30 ms of rendering on one core: few pictures of a sum, and soon only one a
// second, when they differ less.
constexpr double kSoftShare = 0.6, kLeastSoftInterval = 0.3, kMostSoftInterval = 1;
constexpr double kLeastSlice = 0.02;     // of one call of the engine, at whose end its threads wait for each other
constexpr double kPassSlice = 0.005;     // where the picture is shown as soon as it has its first samples
constexpr double kFeatureSeconds = 0.15; // that a view of albedo, depth, cost may take
constexpr double kRestSeconds = 0.3;     // after which a camera rests

// Quiet, and independent of what it will be compared with.
RenderSettings referenceSettings(RenderSettings settings, std::uint32_t spp) {
    settings.spp = spp;
    settings.sppIsKnown = true;
    settings.seed ^= 0x5f3759dfu;
    settings.lightSampling = LightSampling::Mis;
    settings.sampler = SamplerKind::Sobol;
    settings.replicates = 1;
    settings.secondMoments = false;
    return settings;
}

// Samples until every pixel has a block of them, or all.
std::uint64_t firstPass(const RenderSettings& settings) {
    return std::uint64_t{settings.width} * settings.height * std::min(settings.spp, image::Film::kBlock);
}

// Seconds from one picture of a sum of that age to the next, at least.
double leastInterval(double age) {
    return std::clamp(kPictureShare * age, kLeastInterval, kMostInterval);
}

void show(const std::shared_ptr<const ViewImage>& view, Picture& picture) {
    picture.image = {view, &view->image};
    picture.legend = view->legend;
    picture.isDisplay = true;
}

} // namespace

// ---- rendering -------------------------------------------------------------------------------------------------------

RenderSettings InteractiveSession::sizedSettings() const {
    Options options;
    options.size = request_.size;
    options.settings = request_.settings;
    settleImageSize(options, scene_->defaults.aspect);
    return options.settings;
}

void InteractiveSession::startFilm() {
    RenderSettings settings = sizedSettings();
    settings.seed += round_;
    settings.sppIsKnown = !request_.timeLimit;
    settings.secondMoments = settings.replicates < 2;
    if (!request_.accumulate) {
        settings.spp = samplesOfFrame(settings);
        settings.secondMoments = settings.secondMoments && setup_.options.wants(Aov::Variance);
    }
    if (referenceSpp_) settings = referenceSettings(settings, *referenceSpp_);
    settings.replicates = std::min(settings.replicates, settings.spp);

    // Kernels may have to be compiled, a large film takes a while to be had.
    const bool isAnotherSize = settings.width != settings_.width || settings.height != settings_.height;
    if (filmIsNew_ || isAnotherSize) setStage("Preparing " + scene_->title);
    if (filmIsNew_) unshown_.reset();
    filmIsNew_ = false;
    featureView_ = nullptr;
    featureIsFull_ = false;
    curve_.clear();
    if (round_ == 0) renderDraft(settings);
    if (!draft_.data.empty() && cameraMovesOn()) {
        setStage("");
        postponedFilm_ = settings;
        return;
    }
    beginFilm(settings);
    if (draft_.data.empty() && unshown_) renderFirstPass();
}

void InteractiveSession::beginFilm(RenderSettings settings) {
    postponedFilm_.reset();
    engine_->reset(camera_, settings);
    settings_ = settings;
    filmIsStale_ = false;
    status_ = {};
    publishedSamples_ = 0;
    status_.samplesTotal = std::uint64_t{settings.width} * settings.height * settings.spp;
    renderSeconds_ = 0;
    sinceStart_ = {};
    update([&](SessionState& state) {
        state.stage.clear();
        state.settings = settings;
        state.status = status_;
        state.renderSeconds = 0;
        state.report = engine_->report();
        state.isReferenceRender = referenceSpp_.has_value();
        state.referenceFits = referenceFits();
        state.relmse.reset();
        state.curve.clear();
    });
}

void InteractiveSession::learnSpeed(std::uint64_t samples, double seconds) {
    if (samples == 0) return;
    samplesPerSecond_ = 0.5 * samplesPerSecond_ + 0.5 * static_cast<double>(samples) / std::max(seconds, 1e-4);
}

// Something to look at at once, where the first samples of the whole image would take longer.
void InteractiveSession::renderDraft(const RenderSettings& settings) {
    const double pixels = static_cast<double>(settings.width) * settings.height;
    const double affordable = samplesPerSecond_ * kDraftSeconds;
    draft_ = {};
    if (affordable >= static_cast<double>(firstPass(settings))) return;
    const double scale = std::sqrt(std::min(1.0, affordable / pixels));
    RenderSettings draft = settings;
    draft.width = std::max(1u, static_cast<std::uint32_t>(settings.width * scale));
    draft.height = std::max(1u, static_cast<std::uint32_t>(settings.height * scale));
    draft.spp = std::clamp(static_cast<std::uint32_t>(affordable / pixels), 1u, kDraftSpp);
    draft.replicates = 1;
    draft.secondMoments = false;
    engine_->reset(camera_, draft);
    const Stopwatch watch;
    // Not interrupted by the next change: a camera in motion would never show anything.
    RenderStatus status;
    do status = engine_->renderSome({std::chrono::duration<double>(setup_.sliceSeconds), &cancelBuild_});
    while (!status.finished && !cancelBuild_ && (!cancelRender_ || watch.seconds() < kMostDraftSeconds));
    learnSpeed(status.samplesDone, watch.seconds());
    if (!status.finished) return;
    draft_ = engine_->snapshot().radiance;
    Picture picture;
    picture.radiance = std::make_shared<image::Image>(enlarge(draft_, settings.width, settings.height));
    picture.image = picture.radiance;
    if (aovsFor(view_.mode).any() || view_.mode == ViewMode::Heat) {
        ViewImage shown = view_.mode == ViewMode::Heat
                              ? showCost(shownCost(), engine_->renderCost(shownCost(), 1), view_.scale)
                              : showFeatures(view_.mode, engine_->renderAovs(aovsFor(view_.mode), 1));
        if (!shown.image.data.empty()) {
            shown.image = enlarge(shown.image, settings.width, settings.height);
            featureView_ = std::make_shared<ViewImage>(std::move(shown));
            show(featureView_, picture);
        }
    }
    update([&](SessionState& state) {
        picture.serial = state.picture.serial + 1;
        state.picture = std::move(picture);
    });
    noteAnswer();
}

// What is shown first after a change where that takes no longer than a draft would. The next change does not interrupt it either.
void InteractiveSession::renderFirstPass() {
    const Stopwatch watch;
    do status_ = engine_->renderSome({std::chrono::duration<double>(kPassSlice), &cancelBuild_});
    while (status_.samplesDone < firstPass(settings_) && !cancelBuild_ && watch.seconds() < kMostDraftSeconds);
    renderSeconds_ += watch.seconds();
    learnSpeed(status_.samplesDone, watch.seconds());
    publish();
}

void InteractiveSession::renderSlice() {
    if (filmIsStale_) startFilm();
    if (filmIsStale_) return;
    const Stopwatch watch;
    const std::uint64_t before = status_.samplesDone;
    const double untilDue = std::max(pictureInterval() - sincePublished_.seconds(), kLeastSlice);
    const double slice = std::min(setup_.sliceSeconds, untilDue);
    status_ = engine_->renderSome({std::chrono::duration<double>(slice), &cancelRender_});
    const double seconds = watch.seconds();
    renderSeconds_ += seconds;
    if (seconds > 0.5 * slice && !cancelRender_) {
        samplesPerSecond_ = 0.9 * samplesPerSecond_ + 0.1 * static_cast<double>(status_.samplesDone - before) / seconds;
    }
    writeWaiting();
    if (status_.finished) return finish(StopReason::Spp);
    if (request_.timeLimit && renderSeconds_ >= *request_.timeLimit) return finish(StopReason::TimeLimit);
    if (!cancelRender_ && isFrameDue()) publish();
}

// Of a frame that is not accumulated.
std::uint32_t InteractiveSession::samplesOfFrame(const RenderSettings& settings) const {
    if (request_.samplesPerFrame > 0) return request_.samplesPerFrame;
    const double pixels = static_cast<double>(settings.width) * settings.height;
    return static_cast<std::uint32_t>(std::clamp(samplesPerSecond_ * kFrameSeconds / pixels, 1.0, 65536.0));
}

// Seconds from one picture of a film to the next, at most.
double InteractiveSession::pictureInterval() const {
    if (!request_.accumulate) return kLongFrameSeconds;
    const double age = sinceStart_.seconds();
    if (setup_.drawnBySoftware && publishedSamples_ > 0) { // the first picture does not wait
        return std::clamp(kSoftShare * age, kLeastSoftInterval, kMostSoftInterval);
    }
    if (request_.samplesPerFrame > 0 && age >= kEarlySeconds) return kLongFrameSeconds;
    return leastInterval(age);
}

// Whether what has been rendered is to be shown before it is complete.
bool InteractiveSession::isFrameDue() const {
    const double seconds = sincePublished_.seconds();
    if (seconds <= publishSeconds_ / kPublishShare) return false;
    if (seconds > pictureInterval()) return true;
    if (!request_.accumulate || setup_.drawnBySoftware) return false;
    const std::uint64_t frame = std::uint64_t{request_.samplesPerFrame} * settings_.width * settings_.height;
    return seconds > leastInterval(sinceStart_.seconds()) && status_.samplesDone - publishedSamples_ >= frame;
}

// What the engine holds becomes the reference, or a run of the history.
void InteractiveSession::finish(StopReason reason) {
    if (!request_.accumulate) learnSpeed(status_.samplesDone, renderSeconds_); // slices of a short frame say too little
    publish();
    const std::uint64_t spp = engine_->film().minSamples();
    if (referenceSpp_) {
        adoptReference(engine_->film().resolve(), "rendered, " + std::to_string(spp) + " spp");
        referenceSpp_.reset();
        filmIsStale_ = true;
        return;
    }
    const EngineReport report = engine_->report();
    const LastRun run{{loadSeconds_, renderSeconds_, 0}, report.accelBuildSeconds, report.pipelineSeconds, spp};
    bool recorded = false;
    if (setup_.history != nullptr && request_.accumulate && spp > 0) {
        try {
            setup_.history->append(makeRecord());
            recorded = true;
        } catch (...) {
            fail(std::current_exception(), false); // the render itself is well
        }
    }
    update([&](SessionState& state) {
        state.lastRun = run;
        if (recorded) ++state.historySerial;
    });
    writeEnd(reason);
    if (reason != StopReason::Interrupted && (request_.loop || !request_.accumulate)) {
        ++round_;
        filmIsStale_ = true;
    } else {
        setActivity(reason == StopReason::Interrupted ? Activity::Stopped : Activity::Finished);
    }
}

RunRecord InteractiveSession::makeRecord() const {
    const EngineReport report = engine_->report();
    RunRecord record;
    record.time = utcNow();
    record.app = setup_.options.program;
    record.engine = report.engine;
    record.device = report.device;
    record.scene = scene_->id;
    record.lightSampling = nameOf(kLightSamplings, settings_.lightSampling);
    record.sampler = nameOf(kSamplers, settings_.sampler);
    record.width = settings_.width;
    record.height = settings_.height;
    record.maxDepth = settings_.maxDepth;
    record.threads = report.threads;
    record.spp = engine_->film().minSamples();
    record.loadSeconds = loadSeconds_;
    record.buildSeconds = report.accelBuildSeconds;
    record.pipelineSeconds = report.pipelineSeconds;
    record.renderSeconds = renderSeconds_;
    const double rays = static_cast<double>(report.rays.camera + report.rays.scattered + report.rays.shadow);
    if (renderSeconds_ > 0) {
        record.samplesPerSecond = static_cast<double>(status_.samplesDone) / renderSeconds_;
        record.raysPerSecond = rays / renderSeconds_;
    }
    record.hasReference = !curve_.empty();
    record.relmse = record.hasReference ? curve_.back().relmse : estimate(engine_->film()).relmse.value_or(0);
    for (const ErrorPoint& point : curve_) record.curve.push_back({point.seconds, point.relmse});
    return record;
}

// ---- what is shown ---------------------------------------------------------------------------------------------------

void InteractiveSession::publish() {
    if (isPreviewing()) return;
    const Stopwatch watch;
    const auto viewBefore = featureView_;
    Snapshot snapshot = engine_->snapshot();
    auto radiance = std::make_shared<image::Image>(std::move(snapshot.radiance));
    Picture picture;
    picture.spp = snapshot.leastSamples();
    if (picture.spp == 0 && !draft_.data.empty()) fillFromDraft(*radiance, snapshot.tileSamples, draft_);
    if (picture.spp > 0) followError(*radiance, status_.finished);
    picture.image = picture.radiance = std::move(radiance);
    if (const auto view = shownView(picture)) show(view, picture);
    if (view_.inspect) {
        const image::Film& film = engine_->film();
        picture.samples = std::make_shared<image::Image>(film.sampleCounts());
        if (hasVariance(film)) picture.variance = std::make_shared<image::Image>(film.varianceOfMean());
    }
    std::optional<double> relmse;
    if (!curve_.empty())
        relmse = curve_.back().relmse;
    else if (status_.finished)
        relmse = estimate(engine_->film()).relmse;
    const EngineReport report = engine_->report();
    update([&](SessionState& state) {
        picture.serial = state.picture.serial + 1;
        state.picture = std::move(picture);
        state.status = status_;
        state.renderSeconds = renderSeconds_;
        state.seconds.load = loadSeconds_;
        state.seconds.render = renderSeconds_;
        state.report = report;
        state.relmse = relmse;
        state.curve = curve_;
    });
    noteAnswer();
    if (featureView_ == viewBefore) publishSeconds_ = watch.seconds(); // a view that was made now does not come again
    publishedSamples_ = status_.samplesDone;
    sincePublished_ = {};
}

// What took long because something was built has been told as it was.
void InteractiveSession::noteAnswer() {
    if (!unshown_) return;
    const double seconds = unshown_->seconds();
    unshown_.reset();
    update([seconds](SessionState& state) { state.slowestAnswer = std::max(state.slowestAnswer, seconds); });
}

// None where it is the radiance that is to be shown.
std::shared_ptr<const ViewImage> InteractiveSession::shownView(const Picture& picture) {
    const double pixels = static_cast<double>(settings_.width) * settings_.height;
    const auto affordable = [&](std::uint32_t most) { // samples
        return static_cast<std::uint32_t>(std::clamp(samplesPerSecond_ * kFeatureSeconds / pixels, 1.0, most * 1.0));
    };
    switch (view_.mode) {
        case ViewMode::Picture:
            break;
        case ViewMode::Noise:
            if (!hasVariance(engine_->film())) break;
            return std::make_shared<ViewImage>(showNoise(engine_->film(), view_.scale));
        case ViewMode::Error:
            if (!referenceFits() || picture.spp == 0) break;
            return std::make_shared<ViewImage>(showError(*picture.radiance, *reference_, view_.scale));
        case ViewMode::Heat:
        case ViewMode::Albedo:
        case ViewMode::Normal:
        case ViewMode::Depth:
            // In full resolution once the camera rests.
            if (featureView_ && (featureIsFull_ || sinceStart_.seconds() < kRestSeconds)) return featureView_;
            if (view_.mode == ViewMode::Heat) {
                const image::Image cost = engine_->renderCost(shownCost(), affordable(16));
                if (cost.data.empty()) break;
                featureView_ = std::make_shared<ViewImage>(showCost(shownCost(), cost, view_.scale));
            } else {
                const AovImages aovs = engine_->renderAovs(aovsFor(view_.mode), affordable(8));
                featureView_ = std::make_shared<ViewImage>(showFeatures(view_.mode, aovs));
            }
            featureIsFull_ = true;
            return featureView_;
    }
    return nullptr;
}

void InteractiveSession::findFocus(std::uint32_t x, std::uint32_t y) {
    AovRequest request;
    request.depth = true;
    const image::Image depth = isPreviewing() ? preview_.depth : engine_->renderAovs(request, 1).depth;
    if (x >= depth.width || y >= depth.height) return;
    const float distance = *depth.pixel(x, y);
    if (!(distance > 0)) return; // the sky
    const double half = std::tan(0.5 * camera_.verticalFov * 0.017453292519943295);
    const double up = half * ((y + 0.5) / depth.height * 2 - 1);
    const double right = half * ((x + 0.5) / depth.width * 2 - 1) * depth.width / depth.height;
    const double cosine = 1 / std::sqrt(1 + up * up + right * right);
    update([&](SessionState& state) {
        state.focusDistance = distance * cosine;
        ++state.focusSerial;
    });
}

} // namespace rt::app
