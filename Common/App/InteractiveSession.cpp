#include "Common/App/InteractiveSession.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "Common/App/Draft.h"
#include "Common/App/FilmEstimate.h"
#include "Common/App/Outputs.h"
#include "Common/App/Platform.h"
#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Image/Display.h"
#include "Common/Image/ImageIo.h"

namespace rt::app {
namespace {

constexpr double kDraftSeconds = 0.04;     // of what is shown first after a change
constexpr double kMostDraftSeconds = 0.25; // when the next change waits already
constexpr std::uint32_t kDraftSpp = 4;     // at most
constexpr double kPublishShare = 0.2;      // of the worker's time, at most, goes into pictures
constexpr double kEarlySeconds = 2;        // pictures come often at first
constexpr double kEarlyInterval = 0.04;
constexpr double kLateInterval = 0.15;

std::string messageOf(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const std::exception& error) {
        return error.what();
    }
}

} // namespace

InteractiveSession::InteractiveSession(Setup setup)
    : setup_(std::move(setup)),
      wantedScene_(setup_.scene),
      oneSidedLights_(setup_.request.oneSidedLights),
      request_(setup_.request),
      loader_([this](LoadedScene loaded) {
          post(false, [&loaded](Requests& requests) { requests.scene = std::move(loaded); });
      }) {
    requests_.engine = setup_.engine;
    setStage("Loading " + setup_.scene.source);
    loader_.request(setup_.scene);
    worker_ = std::thread([this] { work(); });
}

InteractiveSession::~InteractiveSession() {
    cancelBuild_ = true;
    post(true, [](Requests& requests) { requests.quit = true; });
    worker_.join();
}

// ---- requests --------------------------------------------------------------------------------------------------------

template <class Change>
void InteractiveSession::post(bool interrupt, Change change) {
    {
        const std::scoped_lock lock(mutex_);
        change(requests_);
        if (interrupt) cancelRender_ = true;
    }
    wake_.notify_one();
}

template <class Change>
void InteractiveSession::update(Change change) {
    {
        const std::scoped_lock lock(mutex_);
        change(state_);
    }
    if (setup_.onChange) setup_.onChange();
}

void InteractiveSession::open(const std::string& source) {
    {
        const std::scoped_lock lock(mutex_);
        wantedScene_.source = source;
        loader_.request(wantedScene_);
    }
    setStage("Loading " + source);
}

void InteractiveSession::change(const RenderRequest& request) {
    post(true, [&](Requests& requests) {
        requests.request = request;
        if (wantedScene_.oneSidedLights == request.oneSidedLights) return;
        wantedScene_.oneSidedLights = request.oneSidedLights;
        loader_.request(wantedScene_); // which lights there are is decided by the compiler
    });
}

void InteractiveSession::choose(const EngineChoice& engine) {
    post(true, [&](Requests& requests) { requests.engine = engine; });
}

void InteractiveSession::moveCamera(const scene::CameraDesc& camera, std::uint64_t sceneSerial) {
    post(true, [&](Requests& requests) { requests.camera.emplace(sceneSerial, camera); });
}

void InteractiveSession::render() {
    post(false, [](Requests& requests) { requests.command = Command::Render; });
}
void InteractiveSession::pause() {
    post(true, [](Requests& requests) { requests.command = Command::Pause; });
}
void InteractiveSession::stop() {
    post(true, [](Requests& requests) { requests.command = Command::Stop; });
}
void InteractiveSession::reset() {
    post(true, [](Requests& requests) { requests.command = Command::Reset; });
}
void InteractiveSession::save(SaveRequest request) {
    post(false, [&](Requests& requests) { requests.saves.push_back(std::move(request)); });
}

SessionState InteractiveSession::state() const {
    const std::scoped_lock lock(mutex_);
    SessionState copy = state_;
    if (const auto loading = loader_.busyWith(); loading && copy.stage.empty()) copy.stage = "Loading " + *loading;
    copy.stageSeconds = stageWatch_.seconds();
    return copy;
}

void InteractiveSession::setStage(const std::string& stage) {
    update([&](SessionState& state) {
        state.stage = stage;
        stageWatch_ = {};
    });
}

// ---- the worker ------------------------------------------------------------------------------------------------------

void InteractiveSession::work() {
    lowerThreadPriority();
    while (true) {
        Requests requests = take();
        if (requests.quit) break;
        try {
            apply(std::move(requests));
            if (isActive() && engine_ && scene_) renderSlice();
        } catch (...) {
            fail(std::current_exception(), false);
            setActivity(Activity::Failed);
            filmIsStale_ = true;
        }
    }
    engine_.reset();
}

// Waits while there is nothing to do.
InteractiveSession::Requests InteractiveSession::take() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return requests_.any() || (isActive() && engine_ && scene_); });
    cancelRender_ = requests_.quit;
    return std::exchange(requests_, {});
}

void InteractiveSession::apply(Requests requests) {
    if (requests.engine) choice_ = *requests.engine;
    // A device that was lost does not come back to the engine that used it.
    if (requests.engine || (activity_ == Activity::Failed && requests.any())) makeEngine();
    if (requests.request && *requests.request != request_) {
        request_ = *requests.request;
        filmIsStale_ = true;
        round_ = 0;
    }
    if (requests.scene) adopt(std::move(*requests.scene));
    if (requests.camera && requests.camera->first == sceneSerial_ && requests.camera->second != camera_) {
        camera_ = requests.camera->second;
        filmIsStale_ = true;
        round_ = 0;
    }
    for (const SaveRequest& save : requests.saves) write(save);
    if (requests.command) obey(*requests.command);
    // What was changed is looked at, unless the user has stopped rendering.
    if (filmIsStale_ && activity_ != Activity::Stopped && activity_ != Activity::Rendering) {
        setActivity(Activity::Rendering);
    }
}

void InteractiveSession::makeEngine() {
    setStage("Starting the engine");
    try {
        std::unique_ptr<Engine> engine = setup_.makeEngine(choice_);
        if (scene_ && !engine->setScene(scene_, &cancelBuild_)) return;
        engine_ = std::move(engine);
        filmIsStale_ = filmIsNew_ = true;
    } catch (...) {
        fail(std::current_exception(), !engine_);
    }
    setStage("");
}

// A scene that cannot be had leaves the one before in place.
void InteractiveSession::adopt(LoadedScene loaded) {
    if (loaded.failure) {
        setStage("");
        return fail(loaded.failure, !scene_);
    }
    if (!engine_) return;
    setStage("Building " + loaded.scene->title);
    try {
        if (!engine_->setScene(loaded.scene, &cancelBuild_)) return;
    } catch (...) {
        setStage("");
        return fail(std::current_exception(), !scene_);
    }
    const bool another = !scene_ || loaded.scene->id != scene_->id || loaded.scene->camera != scene_->camera;
    scene_ = loaded.scene;
    loadSeconds_ = loaded.seconds;
    if (another) {
        camera_ = scene_->camera;
        ++sceneSerial_;
        if (activity_ == Activity::Stopped) setActivity(Activity::Rendering);
    }
    filmIsStale_ = filmIsNew_ = true;
    round_ = 0;
    for (const std::string& notice : scene_->notices) logInfo(scene_->id + ": " + notice);
    update([&](SessionState& state) {
        state.stage.clear();
        state.scene = scene_;
        state.source = loaded.request.source;
        state.sceneSerial = sceneSerial_;
    });
}

void InteractiveSession::obey(Command command) {
    switch (command) {
        case Command::Render:
            if (activity_ == Activity::Finished || activity_ == Activity::Stopped) filmIsStale_ = true;
            setActivity(Activity::Rendering);
            break;
        case Command::Pause:
            if (activity_ == Activity::Rendering) {
                publish();
                setActivity(Activity::Paused);
            }
            break;
        case Command::Stop:
            if (activity_ == Activity::Rendering || activity_ == Activity::Paused) finish(StopReason::Interrupted);
            break;
        case Command::Reset:
            filmIsStale_ = true;
            setActivity(Activity::Rendering);
            break;
    }
}

void InteractiveSession::fail(const std::exception_ptr& failure, bool fatal) {
    const std::string message = messageOf(failure);
    logWarning(message);
    update([&](SessionState& state) {
        state.error = message;
        ++state.errorSerial;
        if (fatal) state.fatal = failure;
    });
}

void InteractiveSession::setActivity(Activity activity) {
    activity_ = activity;
    update([activity](SessionState& state) { state.activity = activity; });
}

// ---- rendering -------------------------------------------------------------------------------------------------------

void InteractiveSession::startFilm() {
    Options options;
    options.size = request_.size;
    options.settings = request_.settings;
    settleImageSize(options, scene_->defaults.aspect);
    RenderSettings settings = options.settings;
    settings.seed += round_;
    settings.sppIsKnown = !request_.timeLimit;
    settings.secondMoments = settings.replicates < 2;
    if (!request_.accumulate) {
        settings.spp = request_.samplesPerFrame;
        settings.secondMoments = false;
    }
    settings.replicates = std::min(settings.replicates, settings.spp);

    if (filmIsNew_) setStage("Preparing " + scene_->title); // kernels may have to be compiled
    filmIsNew_ = false;
    if (round_ == 0) renderDraft(settings);
    engine_->reset(camera_, settings);
    settings_ = settings;
    filmIsStale_ = false;
    status_ = {};
    status_.samplesTotal = std::uint64_t{settings.width} * settings.height * settings.spp;
    renderSeconds_ = 0;
    sinceStart_ = {};
    update([&](SessionState& state) {
        state.stage.clear();
        state.settings = settings;
        state.status = status_;
        state.renderSeconds = 0;
        state.report = engine_->report();
    });
}

// Something to look at at once, where the first samples of the whole image would take longer.
void InteractiveSession::renderDraft(const RenderSettings& settings) {
    const double pixels = static_cast<double>(settings.width) * settings.height;
    const double affordable = samplesPerSecond_ * kDraftSeconds;
    const double firstPass = pixels * std::min(settings.spp, image::Film::kBlock);
    draft_ = {};
    if (affordable >= firstPass) return;
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
    do status = engine_->renderSome({std::chrono::duration<double>(kDraftSeconds), &cancelBuild_});
    while (!status.finished && !cancelBuild_ && (!cancelRender_ || watch.seconds() < kMostDraftSeconds));
    const double seconds = std::max(watch.seconds(), 1e-4);
    samplesPerSecond_ = 0.5 * samplesPerSecond_ + 0.5 * static_cast<double>(status.samplesDone) / seconds;
    if (!status.finished) return;
    draft_ = engine_->film().resolve();
    auto picture = std::make_shared<image::Image>(enlarge(draft_, settings.width, settings.height));
    update([&](SessionState& state) {
        state.picture.image = std::move(picture);
        state.picture.spp = 0;
        ++state.picture.serial;
    });
}

void InteractiveSession::renderSlice() {
    if (filmIsStale_) startFilm();
    const Stopwatch watch;
    const std::uint64_t before = status_.samplesDone;
    status_ = engine_->renderSome({std::chrono::duration<double>(setup_.sliceSeconds), &cancelRender_});
    const double seconds = watch.seconds();
    renderSeconds_ += seconds;
    if (seconds > 0.5 * setup_.sliceSeconds && !cancelRender_) {
        samplesPerSecond_ = 0.9 * samplesPerSecond_ + 0.1 * static_cast<double>(status_.samplesDone - before) / seconds;
    }
    if (status_.finished) return finish(StopReason::Spp);
    if (request_.timeLimit && renderSeconds_ >= *request_.timeLimit) return finish(StopReason::TimeLimit);
    const double interval = sinceStart_.seconds() < kEarlySeconds ? kEarlyInterval : kLateInterval;
    if (!cancelRender_ && sincePublished_.seconds() > std::max(interval, publishSeconds_ / kPublishShare)) publish();
}

void InteractiveSession::finish(StopReason reason) {
    publish();
    const bool again = reason != StopReason::Interrupted && (request_.loop || !request_.accumulate);
    const std::uint64_t spp = engine_->film().minSamples();
    const EngineReport report = engine_->report();
    const LastRun run{{loadSeconds_, renderSeconds_, 0}, report.accelBuildSeconds, report.pipelineSeconds, spp};
    bool recorded = false;
    if (setup_.history != nullptr && request_.accumulate && spp > 0) {
        RunRecord record;
        record.time = utcNow();
        record.app = setup_.program;
        record.engine = report.engine;
        record.device = report.device;
        record.scene = scene_->id;
        record.lightSampling = nameOf(kLightSamplings, settings_.lightSampling);
        record.sampler = nameOf(kSamplers, settings_.sampler);
        record.width = settings_.width;
        record.height = settings_.height;
        record.maxDepth = settings_.maxDepth;
        record.threads = report.threads;
        record.spp = spp;
        record.loadSeconds = loadSeconds_;
        record.buildSeconds = report.accelBuildSeconds;
        record.pipelineSeconds = report.pipelineSeconds;
        record.renderSeconds = renderSeconds_;
        const double rays = static_cast<double>(report.rays.camera + report.rays.scattered + report.rays.shadow);
        if (renderSeconds_ > 0) {
            record.samplesPerSecond = static_cast<double>(status_.samplesDone) / renderSeconds_;
            record.raysPerSecond = rays / renderSeconds_;
        }
        record.relmse = estimate(engine_->film()).relmse.value_or(0);
        try {
            setup_.history->append(record);
            recorded = true;
        } catch (...) {
            fail(std::current_exception(), false); // the render itself is well
        }
    }
    update([&](SessionState& state) {
        state.lastRun = run;
        if (recorded) ++state.historySerial;
    });
    if (again) {
        ++round_;
        filmIsStale_ = true;
    } else {
        setActivity(reason == StopReason::Interrupted ? Activity::Stopped : Activity::Finished);
    }
}

void InteractiveSession::publish() {
    const Stopwatch watch;
    const image::Film& film = engine_->film();
    auto picture = std::make_shared<image::Image>(film.resolve());
    const std::uint64_t spp = film.minSamples();
    if (spp == 0 && !draft_.data.empty()) fillFromDraft(*picture, film, draft_);
    update([&](SessionState& state) {
        state.picture.image = std::move(picture);
        state.picture.spp = spp;
        ++state.picture.serial;
        state.status = status_;
        state.renderSeconds = renderSeconds_;
        state.seconds.load = loadSeconds_;
        state.seconds.render = renderSeconds_;
        state.report = engine_->report();
    });
    publishSeconds_ = watch.seconds();
    sincePublished_ = {};
}

void InteractiveSession::write(const SaveRequest& request) {
    if (!engine_ || !scene_ || filmIsStale_) {
        const RenderError early("nothing to save yet: the picture is being prepared");
        return fail(std::make_exception_ptr(early), false);
    }
    const image::Image radiance = engine_->film().resolve();
    for (const std::string& file : request.files) {
        try {
            const bool display = image::isDisplayReferred(file);
            const auto curve = static_cast<std::uint32_t>(request.tonemap);
            image::writeImage(file, display ? image::toDisplay(radiance, request.exposure, curve) : radiance);
            update([&](SessionState& state) {
                state.message = "Saved " + file;
                ++state.messageSerial;
            });
        } catch (...) {
            fail(std::current_exception(), false);
        }
    }
}

} // namespace rt::app
