#include "Common/Gui/SessionLink.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/EnginePanel.h"
#include "Common/Gui/Panels/SavePaths.h"
#include "Common/Gui/Panels/ViewModes.h"
#include "Common/Gui/UserFiles.h"
#include "Common/Image/Display.h"
#include "Common/Scene/FollowedCamera.h"

namespace rt::gui {

app::InteractiveSession::Setup sessionSetup(const app::Options& options, const WindowProgram& program,
                                            app::GuiSettings& settings, bool drawnBySoftware, app::RunHistory& history,
                                            std::atomic<bool>& isNews) {
    settings.request.halves = settings.denoise;
    settings.engine = servedChoice(settings.engine, program.devices, options); // what this machine has
    for (app::ViewportSettings& viewport : settings.viewports)
        viewport.engine = servedChoice(viewport.engine, program.devices, options);
    app::InteractiveSession::Setup setup;
    setup.options = options;
    setup.makeEngine = program.makeEngine;
    setup.engine = settings.engine;
    setup.request = settings.request;
    setup.scene = {settings.scene, settings.request.oneSidedLights, options.camera, options.assetsBelow, options.moment,
                   options.shutter};
    // A file that was open the last time may be gone by now.
    if (options.given.count("--scene") == 0) setup.fallbackScene = app::GuiSettings().scene;
    setup.atEnd = endFiles(options, settings);
    setup.preview = !settings.rayTracing;
    // Threads of the processor wait for each other at the end of a slice, and requests that do not interrupt it for
    // that end.
    setup.sliceSeconds = options.program != app::kGpuProgram ? 0.1 : 0.03;
    setup.drawnBySoftware = drawnBySoftware;
    setup.history = &history;
    setup.references = referenceCache(options);
    setup.onChange = [&isNews] { isNews = true; };
    return setup;
}

SessionLink::SessionLink(const app::Options& options, Gui& gui, Presenter& presenter)
    : options_(options),
      gui_(gui),
      presenter_(presenter),
      reference_(options.reference),
      sentEnd_(endFiles(options, gui.settings)) {
    now_.request = gui.settings.request;
    now_.engine = gui.settings.engine;
    now_.rayTracing = gui.settings.rayTracing;
    gui.timeline.setFrameRate(options.frameRate);
}

void SessionLink::take(bool hasFocus) {
    gui_.state = gui_.session.state();
    const app::SessionState& state = gui_.state;
    if (state.engineFailures != now_.engineFailures) {
        now_.engineFailures = state.engineFailures;
        gui_.settings.engine = state.engine;
    }
    if (state.sceneSerial > 0 && state.sceneSerial != now_.sceneSerial) {
        now_.sceneSerial = state.sceneSerial;
        gui_.camera.setHome(state.sceneCamera);
        now_.camera = state.sceneCamera;
    } else if (now_.scene && state.scenePoses > 0 && state.scene != now_.scene) {
        gui_.camera.moveHome(scene::followedCamera(gui_.camera.home(), *now_.scene, *state.scene));
    }
    now_.scene = state.scene;
    if (hasFocus) {
        rememberScene();
        showTitle();
        if (gui_.settings.reloadScenes && !gui_.editor.isDirty() && !gui_.editor.isSaving()) followFile();
    }
    if (state.focusSerial != now_.focusSerial) {
        now_.focusSerial = state.focusSerial;
        gui_.camera.focusAt(state.focusDistance, 1);
    }
    if (gui_.viewRequest.mode == app::ViewMode::Error && !state.referenceFits && !state.isReferenceRender) {
        gui_.viewRequest.mode = app::ViewMode::Picture; // there is nothing to compare with any more
    }
    const bool mayBeGone = app::showsDenoiser(gui_.viewRequest.mode) || state.picture.isOfRace;
    if (mayBeGone && !isAvailable(gui_, gui_.viewRequest.mode))
        gui_.viewRequest.mode = app::ViewMode::Picture; // there is nothing to show of it any more
    if (state.picture.image && state.picture.serial != now_.pictureSerial) {
        now_.pictureSerial = state.picture.serial;
        presenter_.setPicture(now_.slot, state.picture.image);
        if (gui_.settings.autoExposure) followExposure();
    }
    if (hasFocus && !reference_.empty() && state.picture.spp > 0) { // there is something to compare with
        gui_.session.loadReference(reference_);
        reference_.clear();
    }
    takeErrors();
}

void SessionLink::takeErrors() {
    const app::SessionState& state = gui_.state;
    const std::uint64_t fresh = std::min<std::uint64_t>(state.errorSerial - now_.errorSerial, state.errors.size());
    now_.errorSerial = state.errorSerial;
    for (std::size_t i = state.errors.size() - fresh; i < state.errors.size(); ++i)
        gui_.fail(state.errors[i].text, state.errors[i].source);
    if (state.messageSerial != now_.messageSerial) {
        now_.messageSerial = state.messageSerial;
        gui_.say(state.message);
    }
}

// Small differences between two pictures of a film do not make it flicker.
void SessionLink::followExposure() {
    constexpr float kMinStep = 0.1f; // stops
    const float wanted = image::autoExposure(*gui_.state.picture.radiance);
    if (std::abs(wanted - gui_.autoExposure) > kMinStep) gui_.autoExposure = wanted;
}

// The scene that there is, and among the files that were opened those that load.
void SessionLink::rememberScene() {
    const app::SessionState& state = gui_.state;
    app::GuiSettings& settings = gui_.settings;
    if (state.sceneFailures != sceneFailures_) {
        sceneFailures_ = state.sceneFailures;
        settings.removeRecent(state.failedSource);
    }
    if (state.sceneLoads == sceneLoads_) return;
    sceneLoads_ = state.sceneLoads;
    gui_.errors.dismiss(app::ErrorSource::Scene);
    // Of an edit there is no more to tell.
    const bool isReadAnew = std::exchange(sceneReads_, state.sceneReads) != state.sceneReads && state.scenePoses == 0;
    if (!isReadAnew && state.source == rememberedSource_) return;
    rememberedSource_ = state.source;
    settings.scene = state.source;
    std::error_code none;
    if (!std::filesystem::is_regular_file(state.source, none)) return; // a built-in one
    settings.scene = std::filesystem::absolute(state.source, none).string();
    settings.addRecent(settings.scene);
    const std::vector<std::string>& notices = state.scene->notices;
    if (notices.empty()) return;
    const std::size_t more = notices.size() - 1;
    gui_.say(state.scene->title + ": " + printable(notices.front()) +
             (more > 0 ? " (" + std::to_string(more) + " more in the panel Scene)" : ""));
}

// With a mark while there are edits that are not saved.
void SessionLink::showTitle() {
    if (!gui_.state.scene) return;
    const std::string title = gui_.state.scene->title + (gui_.editor.isDirty() ? "* - " : " - ") + options_.program;
    if (std::exchange(title_, title) != title) gui_.window.setTitle(title);
}

// A scene is read again when its file has changed, or that of a model in it: edits of the model stand in its file.
void SessionLink::followFile() {
    constexpr double kSeconds = 0.5; // between two looks
    if (sinceLook_.seconds() < kSeconds) return;
    sinceLook_ = {};
    std::vector<app::WatchedFile> files{{gui_.state.source, {gui_.state.sourceMark, gui_.editor.savedMark()}}};
    for (const app::FileFingerprint& mark : gui_.state.modelMarks) files.push_back({mark.file, {mark}});
    if (watch_.isDue(files) && gui_.session.reopen(gui_.state.source)) watch_.setAsked();
}

void SessionLink::send(bool hasFocus) {
    gui_.settings.request.halves = gui_.viewRequest.denoise = gui_.settings.denoise;
    if (gui_.settings.request != now_.request) {
        now_.request = gui_.settings.request;
        gui_.session.change(now_.request);
    }
    if (gui_.settings.engine != now_.engine) {
        now_.engine = gui_.settings.engine;
        gui_.session.choose(now_.engine);
    }
    if (gui_.settings.rayTracing != now_.rayTracing) {
        now_.rayTracing = gui_.settings.rayTracing;
        gui_.session.preview(!now_.rayTracing);
    }
    if (!now_.rayTracing && gui_.previewWidth != now_.previewWidth) {
        now_.previewWidth = gui_.previewWidth;
        gui_.session.previewWidth(now_.previewWidth);
    }
    const bool isHeld = hasFocus && gui_.isHeld;
    if (std::exchange(now_.held, isHeld) != isHeld) gui_.session.hold(isHeld);
    if (gui_.viewRequest != now_.view) {
        now_.view = gui_.viewRequest;
        gui_.session.view(now_.view);
    }
    if (!gui_.settings.showRace && gui_.state.race && gui_.state.race->isShown) gui_.session.leaveRace();
    if (hasFocus) sendEnd();
    gui_.pinned.follow(gui_.state, gui_.viewRequest);
    if (gui_.pinned.shown() != now_.shownHeld) {
        now_.shownHeld = gui_.pinned.shown();
        if (gui_.pinned) presenter_.setHeld(now_.slot, now_.shownHeld);
    }
    if (now_.sceneSerial > 0 && gui_.camera.camera() != now_.camera) {
        now_.camera = gui_.camera.camera();
        gui_.session.moveCamera(now_.camera, now_.sceneSerial);
    }
}

void SessionLink::sendEnd() {
    const app::SaveRequest end = filesOf(options_, gui_.exposure(), gui_.settings.tonemap);
    if (!sentEnd_ || end == *sentEnd_) return;
    sentEnd_ = end;
    gui_.session.writeAtEnd(end);
}

} // namespace rt::gui
