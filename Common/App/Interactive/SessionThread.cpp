#include "Common/App/Interactive/SessionThread.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "Common/App/Interactive/FilmFiles.h"
#include "Common/App/Session/Reference.h"
#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Log.h"
#include "Common/Scene/FollowedCamera.h"

namespace rt::app {

SessionThread::SessionThread(const SessionSetup& setup, Mailbox& mailbox, PublishedState& state, SceneLoader& loader)
    : setup_(setup),
      mailbox_(mailbox),
      state_(state),
      loader_(loader),
      request_(setup.request),
      film_(setup, mailbox, state),
      previewIsWanted_(setup.preview),
      atEnd_(setup.atEnd) {
    ViewRequest view;
    view.denoise = setup.request.halves; // until the window says what it shows
    film_.publisher.setView(view);
}

bool SessionThread::step() {
    Requests requests = mailbox_.take();
    if (requests.atEnd) atEnd_ = requests.atEnd;
    if (requests.quit) return false;
    try {
        // While nothing but the camera moves, draft follows draft. All else wants the film that belongs to the last
        // one.
        if (isReady() && !requests.moveCameraAlone()) film_.beginPostponed(subject());
        apply(std::move(requests));
        if (hasFilmWork()) isRacing() ? renderRace() : isPreviewing() ? renderPreview() : renderFilm();
    } catch (const Interrupted&) { // by a request that comes next
        state_.setStage("");
    } catch (...) {
        state_.fail(std::current_exception());
        state_.setStage("");
        setActivity(Activity::Failed);
        film_.beginAnew(); // but is kept until another engine takes over
    }
    return true;
}

EndFiles SessionThread::end() {
    for (const SaveRequest& save : std::exchange(waiting_, {})) write(save);
    writeEnd(activity_ == Activity::Failed ? StopReason::Failure : StopReason::Interrupted);
    return endFiles_;
}

// ---- what was asked for --------------------------------------------------------------------------------------------

void SessionThread::apply(Requests requests) {
    applyToRace(requests);
    if (requests.dropsScene && waitingScene_ && !loader_.isWanted(waitingScene_->request)) waitingScene_.reset();
    if (!requests.scene) requests.scene = std::exchange(waitingScene_, std::nullopt);
    if (!requests.engine) requests.engine = waitingEngine_;
    waitingEngine_.reset();
    film_.publisher.awaitPicture(requests.changed);
    // A device that was lost does not come back to the engine that used it.
    const bool needEngine = requests.needEngine();
    const bool isBroken = !engine_ || (activity_ == Activity::Failed && needEngine);
    if (isBroken || (requests.engine && *requests.engine != choice_)) makeEngine(requests.engine.value_or(choice_));
    if (requests.request) {
        const bool lacksHalves = requests.request->halves && isReady() && !film_.hasHalves();
        const bool isAnother = needsAnotherFilm(request_, *requests.request) || lacksHalves;
        const bool isOnlyMore = isAnother && !lacksHalves && differsInBudgetsAlone(request_, *requests.request);
        request_ = *requests.request;
        const bool goesOn = isOnlyMore && isReady() && film_.goOn(subject());
        if (goesOn && activity_ == Activity::Finished && !film_.isFinished()) setActivity(Activity::Rendering);
        isAnother && !goesOn ? film_.change() : requests.request.reset();
    }
    takeCamera(requests.camera); // of the scene that there is, before another pose moves what the user has not
    if (requests.scene) adopt(std::move(*requests.scene));
    if (requests.sceneFile) nameScene(*requests.sceneFile);
    takeCamera(requests.camera);
    if (requests.previewWidth) previewWidth_ = *requests.previewWidth;
    if (requests.changeWhatIsSeen()) previewIsStale_ = true;
    if (requests.preview) switchPreview(*requests.preview);
    std::move(requests.saves.begin(), requests.saves.end(), std::back_inserter(waiting_));
    if (requests.referenceFile) readReferenceFile(*requests.referenceFile);
    if (requests.referenceSpp) startReference(*requests.referenceSpp);
    if (requests.focus) findFocus((*requests.focus)[0], (*requests.focus)[1]);
    if (requests.view && film_.publisher.setView(*requests.view)) showFilm();
    if (requests.command && !isPreviewing()) obey(*requests.command);
    if (requests.race) startRace(*requests.race);
    // There may be nothing new to see.
    if (!film_.isStale() || activity_ == Activity::Stopped) film_.publisher.forgetLatency();
    // What was changed is looked at, unless the user has stopped rendering.
    if (film_.isStale() && needEngine && activity_ != Activity::Stopped && !isActive() && !isRaceShown_)
        setActivity(Activity::Rendering);
    if (requests.held && std::exchange(isHeld_, *requests.held) && !isHeld_) recordWaiting();
    writeWaiting();
}

void SessionThread::takeCamera(const std::optional<std::pair<std::uint64_t, scene::CameraDesc>>& camera) {
    if (!camera || camera->first != sceneSerial_ || camera->second == camera_) return;
    camera_ = camera->second;
    film_.change();
}

// An engine that cannot be had leaves the one before at work.
void SessionThread::makeEngine(const EngineChoice& choice) {
    state_.setStage(setup_.options.program == kGpuProgram ? "Compiling shaders" : "Starting the engine");
    film_.publisher.forgetLatency();
    try {
        std::unique_ptr<Engine> made = setup_.makeEngine(choice), blurred = blurring(*made, loaded_);
        Engine* const engine = blurred ? blurred.get() : made.get();
        if (loaded_.scene && !engine->setScene(loaded_.scene, &mailbox_.cancelled(Cancel::Build))) {
            waitingEngine_ = choice;
            return state_.setStage("");
        }
        // Compiles what a film like the present one needs.
        if (const auto& film = film_.run()) engine->reset(film->camera(), film->settings());
        film_.discard();
        engine_ = engine;
        blurring_ = std::move(blurred);
        made_ = std::move(made);
        choice_ = choice;
        state_.update([&](SessionState& state) {
            state.engine = choice;
            state.canShowCost = engine_->knowsCost(Cost::Rays);
            state.canShowTime = engine_->knowsCost(Cost::Time);
            state.canPreview = engine_->canPreview();
        });
    } catch (...) {
        state_.fail(std::current_exception(), ErrorSource::Engine, !engine_,
                    [](SessionState& state) { ++state.engineFailures; });
    }
    state_.setStage("");
}

// What takes samples of all the times at which the shutter is open; null: of one instant.
std::unique_ptr<Engine> SessionThread::blurring(Engine& engine, const LoadedScene& loaded) {
    if (!loaded.poses) return nullptr;
    const scene::Shutter& shutter = loaded.request.shutter;
    const double time = loaded.scene->motion.time - shutter.middle();
    return makeShutterEngine(engine, time + shutter.open, time + shutter.close, loaded.poses);
}

// Of another scene its own; of another pose where that has the one that is seen. Whether it is another one.
bool SessionThread::adoptCamera(const LoadedScene& loaded) {
    const bool isSameSource = loaded_.scene && loaded.request.source == loaded_.request.source;
    if (isSameSource && loaded.request.edits > 0) return false;
    const scene::CompiledScene& scene = *loaded.scene;
    scene::CameraDesc camera = scene.camera;
    if (isSameSource && loaded.request.poses > 0) {
        camera = followedCamera(camera_, *loaded_.scene, scene);
        if (camera == camera_) return false;
    } else if (loaded_.scene && scene.id == loaded_.scene->id && scene.camera == loaded_.scene->camera) {
        return false;
    }
    camera_ = camera;
    return true;
}

// A scene that cannot be had leaves the one before in place.
void SessionThread::adopt(LoadedScene loaded) {
    const bool isSameSource = loaded_.scene && loaded.request.source == loaded_.request.source;
    const bool isEdited = isSameSource && loaded.request.edits > 0;
    const bool isPose = isSameSource && !isEdited && loaded.request.poses > 0;
    const auto failScene = [&](const std::exception_ptr& failure, bool fatal) {
        state_.setStage("");
        state_.fail(failure, ErrorSource::Scene, fatal, [&](SessionState& state) {
            if (isPose) state.failedPose = loaded.request.poses;
            if (isEdited || isPose) return; // the source itself is well
            state.failedSource = loaded.request.source;
            ++state.sceneFailures;
        });
    };
    if (loaded.failure) {
        const bool canFallBack = !setup_.fallbackScene.empty() && loaded.request.source != setup_.fallbackScene;
        failScene(loaded.failure, !loaded_.scene && !canFallBack);
        if (loaded_.scene || !canFallBack) return;
        state_.setStage("Loading " + setup_.fallbackScene);
        return loader_.open(setup_.fallbackScene);
    }
    if (!engine_) {
        if (waitingEngine_) waitingScene_ = std::move(loaded);
        return;
    }
    const scene::CompiledScene& scene = *loaded.scene;
    state_.setStage("Building " + scene.title);
    film_.publisher.forgetLatency();
    std::unique_ptr<Engine> blurred = blurring(*made_, loaded);
    Engine* const engine = blurred ? blurred.get() : made_.get();
    try {
        if (!engine->setScene(loaded.scene, &mailbox_.cancelled(Cancel::Build))) {
            waitingScene_ = std::move(loaded); // until the request that has interrupted it says otherwise
            return state_.setStage("");
        }
    } catch (...) {
        return failScene(std::current_exception(), !loaded_.scene);
    }
    if (isEdited) loaded.mark = loaded_.mark; // the file is what it was when it was read
    if (isEdited || isPose) keepMarks(loaded_.models, loaded.models);
    if (adoptCamera(loaded)) {
        ++sceneSerial_;
        if (activity_ == Activity::Stopped && !isPose) setActivity(Activity::Rendering);
    }
    loaded_ = std::move(loaded);
    film_.discard();
    film_.change();
    engine_ = engine;
    blurring_ = std::move(blurred);
    if (!isEdited && !isPose)
        for (const std::string& notice : scene.notices) logInfo(scene.id + ": " + notice);
    state_.update([&](SessionState& state) {
        state.stage.clear();
        state.scene = loaded_.scene;
        state.source = loaded_.request.source;
        state.moment = loaded_.request.moment;
        state.shutter = loaded_.request.shutter;
        state.poses = loaded_.poses;
        state.scenePoses = loaded_.request.poses;
        state.sceneCamera = camera_;
        state.sourceMark = loaded_.mark;
        state.modelMarks = loaded_.models;
        state.seconds.load = loaded_.seconds;
        ++state.sceneLoads;
        state.sceneReads = loaded_.reads;
        state.sceneEdits = loaded_.request.edits;
        state.sceneSerial = sceneSerial_;
    });
}

void SessionThread::nameScene(const std::string& file) {
    loaded_.request.source = file;
    loaded_.request.moment = {}; // which the file is written at
    loaded_.mark = markOf(file);
    state_.update([&](SessionState& state) {
        state.source = file;
        state.moment = {};
        state.sourceMark = loaded_.mark;
        ++state.sceneLoads;
    });
}

void SessionThread::obey(Requests::Command command) {
    using Command = Requests::Command;
    const bool isEnded = activity_ == Activity::Finished || activity_ == Activity::Stopped;
    if (command == Command::Pause) {
        if (!isActive()) return;
        film_.show();
        return setActivity(Activity::Paused);
    }
    if (command == Command::Stop && !film_.reference.renderedSpp()) {
        if (activity_ == Activity::Preparing) setActivity(Activity::Stopped);
        if (isActive() || activity_ == Activity::Paused) finish(StopReason::Interrupted);
        return state_.setStage("");
    }
    if (command == Command::Stop) film_.reference.giveUp(); // the picture before comes back
    if (command == Command::GoOn && !film_.isStale() && film_.isFinished()) return;
    if (command != Command::GoOn && (command != Command::Render || isEnded)) film_.beginAnew();
    setActivity(Activity::Rendering);
}

void SessionThread::switchPreview(bool on) {
    if (std::exchange(previewIsWanted_, on) == on || on || !isReady()) return;
    film_.publisher.discardPreview();
    film_.isStale() ? setActivity(Activity::Rendering) : film_.show();
}

void SessionThread::startReference(std::uint32_t spp) {
    if (isPreviewing())
        return state_.fail(std::make_exception_ptr(RenderError("a reference needs ray tracing, which is off")),
                           ErrorSource::Reference);
    film_.reference.render(spp);
    film_.beginAnew();
    setActivity(Activity::Rendering);
}

void SessionThread::readReferenceFile(const std::string& file) {
    try {
        if (film_.isStale()) throw InputError(file + ": nothing to compare with yet");
        film_.reference.set(readReference(file, film_.run()->settings().width, film_.run()->settings().height));
        film_.publishReference(file);
        showFilm();
    } catch (...) {
        state_.fail(std::current_exception(), ErrorSource::Reference);
    }
}

void SessionThread::findFocus(std::uint32_t x, std::uint32_t y) {
    if (!isPreviewing() && film_.isStale()) return;
    AovRequest request;
    request.depth = true;
    const image::Image depth = isPreviewing() ? film_.publisher.preview().depth : engine_->renderAovs(request, 1).depth;
    const auto distance = focusDistance(depth, x, y, camera_.verticalFov);
    if (!distance) return state_.say("Nothing is there that could be made sharp");
    state_.update([&](SessionState& state) {
        state.focusDistance = *distance;
        ++state.focusSerial;
    });
}

void SessionThread::setActivity(Activity activity) {
    activity_ = activity;
    state_.update([activity](SessionState& state) { state.activity = activity; });
}

void SessionThread::renderFilm() {
    if (film_.isRefining()) film_.refine();
    if (!isActive()) return film_.filter();
    const auto ended = film_.slice(subject());
    writeWaiting();
    ended ? finish(*ended) : film_.showIfDue(request_);
}

void SessionThread::showFilm() {
    if (isRaceShown_) return publishRace(true);
    if (!isPreviewing()) film_.show();
}

void SessionThread::renderPreview() {
    previewIsStale_ = false;
    state_.setStage("Drawing the preview of " + loaded_.scene->title);
    const RenderSettings settings = sizedSettings(request_, *loaded_.scene);
    if (film_.isStale()) {
        state_.update([&](SessionState& state) {
            state.settings = settings;
            state.status = {};
        });
    }
    film_.publisher.showPreview(*engine_, camera_, settings, previewWidth_ > 0 ? previewWidth_ : settings.width);
    state_.update([](SessionState& state) { state.stage.clear(); });
    writeWaiting();
}

// The film becomes the reference, or a run of the history.
void SessionThread::finish(StopReason reason) {
    if (!film_.hasSamples()) return setActivity(Activity::Stopped);
    film_.show();
    const std::uint64_t spp = engine_->film().samplesPerPixel();
    if (film_.reference.renderedSpp()) {
        const image::Film& film = engine_->film();
        setup_.references.save(film_.reference.film(), film);
        film_.setReference(film, "rendered");
        film_.reference.giveUp();
        film_.beginAnew();
        return;
    }
    const bool recorded = spp > 0 && record();
    const EngineReport report = engine_->report();
    state_.update([&](SessionState& state) {
        state.lastRun = LastRun{
            {loaded_.seconds, film_.run()->seconds(), 0}, report.accelBuildSeconds, report.pipelineSeconds, spp};
        if (recorded) ++state.historySerial;
    });
    writeEnd(reason);
    if (reason != StopReason::Interrupted && (request_.loop || !request_.accumulate)) {
        film_.beginNext();
    } else {
        setActivity(reason == StopReason::Interrupted ? Activity::Stopped : Activity::Finished);
    }
}

void SessionThread::recordWaiting() {
    const bool hasEnded = activity_ == Activity::Finished || activity_ == Activity::Stopped;
    const bool isStillSeen = hasEnded && !film_.isStale();
    if (std::exchange(waitsForRecord_, false) && isStillSeen && record())
        state_.update([](SessionState& state) { ++state.historySerial; });
}

bool SessionThread::record() {
    if (setup_.history == nullptr || !request_.accumulate || blurring_) return false; // of works of one instant
    waitsForRecord_ = isHeld_;
    if (isHeld_) return false;
    try {
        setup_.history->append(makeRecord(setup_.options.program, loaded_, *film_.run(), film_.reference));
        return true;
    } catch (...) {
        state_.fail(std::current_exception()); // the render itself is well
        return false;
    }
}

} // namespace rt::app
