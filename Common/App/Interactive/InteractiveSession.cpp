#include "Common/App/Interactive/InteractiveSession.h"

#include <utility>

#include "Common/App/Platform.h"
#include "Common/Core/Error.h"
#include "Common/Core/Log.h"

namespace rt::app {
namespace {

std::string messageOf(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const std::exception& error) {
        return error.what();
    }
}

} // namespace

bool needsAnotherFilm(const RenderRequest& before, RenderRequest after) {
    if (before.accumulate && after.accumulate) after.samplesPerFrame = before.samplesPerFrame; // only when it is shown
    return after != before;
}

InteractiveSession::InteractiveSession(Setup setup)
    : setup_(std::move(setup)),
      wantedScene_(setup_.scene),
      oneSidedLights_(setup_.request.oneSidedLights),
      atEnd_(setup_.atEnd),
      request_(setup_.request),
      previewIsWanted_(setup_.preview),
      loader_([this](LoadedScene loaded) {
          post(false, [&loaded](Requests& requests) { requests.scene = std::move(loaded); });
      }) {
    requests_.engine = setup_.engine;
    setStage("Loading " + setup_.scene.source);
    loader_.request(setup_.scene);
    worker_ = std::thread([this] { work(); });
}

InteractiveSession::~InteractiveSession() {
    close();
}

std::vector<std::string> InteractiveSession::close() {
    if (worker_.joinable()) {
        cancelBuild_ = true;
        post(true, [](Requests& requests) { requests.quit = true; });
        worker_.join();
    }
    return endFailures_;
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

void InteractiveSession::update(const std::function<void(SessionState&)>& change) {
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
        wantedScene_.pose.clear();
        loader_.request(wantedScene_);
    }
    setStage("Loading " + source);
}

void InteractiveSession::change(const RenderRequest& request) {
    post(true, [&](Requests& requests) {
        requests.request = request;
        if (!unanswered_) unanswered_.emplace();
        if (wantedScene_.oneSidedLights == request.oneSidedLights) return;
        wantedScene_.oneSidedLights = request.oneSidedLights;
        loader_.request(wantedScene_); // which lights there are is decided by the compiler
        stageWatch_ = {};
    });
}

void InteractiveSession::choose(const EngineChoice& engine) {
    post(true, [&](Requests& requests) { requests.engine = engine; });
}

void InteractiveSession::moveCamera(const scene::CameraDesc& camera, std::uint64_t sceneSerial) {
    post(true, [&](Requests& requests) {
        requests.camera.emplace(sceneSerial, camera);
        if (!unanswered_) unanswered_.emplace();
    });
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

void InteractiveSession::view(const ViewRequest& view) {
    post(true, [&](Requests& requests) { requests.view = view; });
}
void InteractiveSession::preview(bool on) {
    post(true, [on](Requests& requests) { requests.preview = on; });
}
void InteractiveSession::renderReference(std::uint32_t spp) {
    post(true, [&](Requests& requests) { requests.referenceSpp = spp; });
}
void InteractiveSession::loadReference(const std::string& file) {
    post(false, [&](Requests& requests) { requests.referenceFile = file; });
}
void InteractiveSession::pickFocus(std::uint32_t x, std::uint32_t y) {
    post(true, [&](Requests& requests) { requests.focus = {x, y}; });
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

void InteractiveSession::writeAtEnd(const SaveRequest& request) {
    const std::scoped_lock lock(mutex_);
    atEnd_ = request;
}

void InteractiveSession::tell(const WindowFigures& figures) {
    const std::scoped_lock lock(mutex_);
    window_ = figures;
}

// ---- the worker ------------------------------------------------------------------------------------------------------

void InteractiveSession::work() {
    lowerThreadPriority();
    while (true) {
        Requests requests = take();
        const bool quit = requests.quit;
        try {
            // While nothing but the camera moves, draft follows draft. All else wants the film that the engine should hold.
            if (postponedFilm_ && !requests.movesCameraAlone()) beginFilm(*postponedFilm_);
            if (!quit) apply(std::move(requests));
            if (!quit && hasWork()) isPreviewing() ? renderPreview() : renderSlice();
        } catch (...) {
            fail(std::current_exception(), false);
            setStage("");
            setActivity(Activity::Failed);
            filmIsStale_ = true;
        }
        if (quit) break;
    }
    for (const SaveRequest& save : std::exchange(waiting_, {})) write(save);
    writeEnd(StopReason::Interrupted);
    engine_.reset();
}

// Waits while there is nothing to do.
InteractiveSession::Requests InteractiveSession::take() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return requests_.any() || hasWork(); });
    cancelRender_ = requests_.quit;
    if (unanswered_ && !unshown_) unshown_ = unanswered_;
    unanswered_.reset();
    return std::exchange(requests_, {});
}

bool InteractiveSession::cameraMovesOn() const {
    const std::scoped_lock lock(mutex_);
    return requests_.movesCameraAlone();
}

void InteractiveSession::apply(Requests requests) {
    // A device that was lost does not come back to the engine that used it.
    const bool isBroken = !engine_ || (activity_ == Activity::Failed && requests.any());
    if (isBroken || (requests.engine && *requests.engine != choice_)) makeEngine(requests.engine.value_or(choice_));
    if (requests.request) {
        const bool isAnother = needsAnotherFilm(request_, *requests.request);
        request_ = *requests.request;
        if (!isAnother) requests.request.reset();
    }
    if (requests.request) {
        filmIsStale_ = true;
        round_ = 0;
        referenceSpp_.reset();
    }
    if (requests.scene) adopt(std::move(*requests.scene));
    if (requests.camera && requests.camera->first == sceneSerial_ && requests.camera->second != camera_) {
        camera_ = requests.camera->second;
        filmIsStale_ = true;
        round_ = 0;
        referenceSpp_.reset();
    }
    if (requests.changesWhatIsSeen()) previewIsStale_ = true;
    if (requests.preview) switchPreview(*requests.preview);
    for (SaveRequest& save : requests.saves) waiting_.push_back(std::move(save));
    if (requests.referenceFile) readReferenceFile(*requests.referenceFile);
    if (requests.referenceSpp && isPreviewing()) {
        fail(std::make_exception_ptr(RenderError("a reference needs ray tracing, which is off")), false);
    } else if (requests.referenceSpp) {
        referenceSpp_ = requests.referenceSpp;
        filmIsStale_ = true;
        setActivity(Activity::Rendering);
    }
    if (requests.focus && (isPreviewing() || !filmIsStale_)) findFocus((*requests.focus)[0], (*requests.focus)[1]);
    if (requests.view && *requests.view != view_) {
        featureView_ = nullptr;
        featureIsFull_ = false;
        view_ = *requests.view;
        if (isReady() && !filmIsStale_) publish();
    }
    if (requests.command && !isPreviewing()) obey(*requests.command);
    if (!filmIsStale_ || activity_ == Activity::Stopped) unshown_.reset(); // there will be nothing new to see
    // What was changed is looked at, unless the user has stopped rendering.
    if (filmIsStale_ && activity_ != Activity::Stopped && activity_ != Activity::Rendering) {
        setActivity(Activity::Rendering);
    }
    writeWaiting();
}

// An engine that cannot be had leaves the one before at work.
void InteractiveSession::makeEngine(const EngineChoice& choice) {
    setStage("Starting the engine");
    unshown_.reset();
    try {
        std::unique_ptr<Engine> engine = setup_.makeEngine(choice);
        if (scene_ && !engine->setScene(scene_, &cancelBuild_)) return;
        if (scene_ && !filmIsNew_) engine->reset(camera_, settings_); // compiles what a film like the present one needs
        engine_ = std::move(engine);
        choice_ = choice;
        update([&](SessionState& state) {
            state.engine = choice;
            state.canShowCost = engine_->knowsCost(Cost::Rays);
            state.canShowTime = engine_->knowsCost(Cost::Time);
            state.canPreview = engine_->canPreview();
        });
        filmIsStale_ = filmIsNew_ = true;
    } catch (...) {
        fail(std::current_exception(), !engine_);
        update([](SessionState& state) { ++state.engineFailures; });
    }
    setStage("");
}

// A scene that cannot be had leaves the one before in place.
void InteractiveSession::adopt(LoadedScene loaded) {
    const auto failScene = [&](const std::exception_ptr& failure, bool fatal) {
        setStage("");
        update([&](SessionState& state) {
            state.failedSource = loaded.request.source;
            ++state.sceneFailures;
        });
        fail(failure, fatal);
    };
    if (loaded.failure) {
        const bool canFallBack = !setup_.fallbackScene.empty() && loaded.request.source != setup_.fallbackScene;
        failScene(loaded.failure, !scene_ && !canFallBack);
        if (!scene_ && canFallBack) open(setup_.fallbackScene);
        return;
    }
    if (!engine_) return;
    setStage("Building " + loaded.scene->title);
    unshown_.reset();
    try {
        if (!engine_->setScene(loaded.scene, &cancelBuild_)) return;
    } catch (...) {
        return failScene(std::current_exception(), !scene_);
    }
    const bool another = !scene_ || loaded.scene->id != scene_->id || loaded.scene->camera != scene_->camera;
    scene_ = loaded.scene;
    source_ = loaded.request.source;
    loadSeconds_ = loaded.seconds;
    if (another) {
        camera_ = scene_->camera;
        ++sceneSerial_;
        if (activity_ == Activity::Stopped) setActivity(Activity::Rendering);
    }
    filmIsStale_ = filmIsNew_ = true;
    round_ = 0;
    referenceSpp_.reset();
    for (const std::string& notice : scene_->notices) logInfo(scene_->id + ": " + notice);
    update([&](SessionState& state) {
        state.stage.clear();
        state.scene = scene_;
        state.source = loaded.request.source;
        ++state.sceneLoads;
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
            if (referenceSpp_) { // the picture before comes back
                referenceSpp_.reset();
                filmIsStale_ = true;
                setActivity(Activity::Rendering);
                break;
            }
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

} // namespace rt::app
