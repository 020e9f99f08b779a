#include "Common/App/Interactive/InteractiveSession.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "Common/App/Interactive/ViewportThread.h"

namespace rt::app {
namespace {

constexpr ViewportId kFirstViewport = 1;

void noteChange(Requests& requests) {
    if (!requests.changed) requests.changed.emplace();
}

} // namespace

bool needsAnotherFilm(const RenderRequest& before, RenderRequest after) {
    after.halves = before.halves; // which the film may have all the same
    if (before.accumulate && after.accumulate) after.samplesPerFrame = before.samplesPerFrame; // only when it is shown
    return after != before;
}

bool differsInBudgetsAlone(const RenderRequest& before, RenderRequest after) {
    after.settings.spp = before.settings.spp;
    after.timeLimit = before.timeLimit;
    after.targetError = before.targetError;
    after.samplesPerFrame = before.samplesPerFrame;
    after.halves = before.halves;
    return after == before;
}

InteractiveSession::InteractiveSession(Setup setup)
    : setup_(std::move(setup)), loader_([this](LoadedScene loaded) { hand(std::move(loaded)); }) {
    addressed_ = add(setup_);
    board_.setFocus(addressed_);
    at().state.setStage("Loading " + setup_.scene.source);
    loader_.request(setup_.scene);
    // Engines are made, used and destroyed on this thread.
    thread_ = std::thread([this] { endFiles_ = ViewportThread(board_, loader_).run(); });
}

InteractiveSession::~InteractiveSession() {
    close();
}

EndFiles InteractiveSession::close() {
    if (thread_.joinable()) {
        postToAll(Cancel::Build, [](Requests& requests) { requests.quit = true; });
        thread_.join();
    }
    return endFiles_;
}

// ---- viewports -----------------------------------------------------------------------------------------------------

std::vector<std::shared_ptr<Viewport>> InteractiveSession::viewports() const {
    const std::scoped_lock lock(mutex_);
    return viewports_;
}

std::shared_ptr<Viewport> InteractiveSession::viewport(ViewportId id) const {
    for (const auto& viewport : viewports())
        if (viewport->id == id) return viewport;
    throw std::logic_error("there is no such viewport");
}

ViewportId InteractiveSession::add(Setup setup) {
    const ViewportId id = ++lastId_;
    sentSizes_[id] = setup.request.size;
    auto viewport = std::make_shared<Viewport>(id, std::move(setup), [this] { board_.ring(); });
    viewport->mailbox.post(Cancel::Nothing, [&](Requests& requests) { requests.engine = viewport->setup.engine; });
    // Pictures of two of them are told apart by their serials.
    viewport->state.update([id](SessionState& state) { state.picture.serial = std::uint64_t{id - 1} << 32; });
    {
        const std::scoped_lock lock(mutex_);
        viewports_.push_back(viewport);
    }
    board_.open(std::move(viewport));
    return id;
}

ViewportId InteractiveSession::openViewport(const RenderRequest& request, const EngineChoice& engine,
                                            const scene::CameraDesc& camera, bool preview) {
    Setup setup = setup_;
    setup.request = request;
    setup.engine = engine;
    setup.preview = preview;
    setup.atEnd.reset(); // of the first one
    const SessionState now = state();
    LoadedScene loaded;
    loaded.scene = now.scene;
    loaded.request = loader_.lastRequest();
    loaded.request.source = now.source;
    loaded.request.moment = now.moment;
    loaded.request.shutter = now.shutter;
    loaded.request.edits = now.sceneEdits;
    loaded.request.poses = now.scenePoses;
    loaded.poses = now.poses;
    loaded.mark = now.sourceMark;
    loaded.models = now.modelMarks;
    loaded.seconds = now.seconds.load;
    loaded.reads = now.sceneReads;
    const ViewportId id = add(std::move(setup));
    viewport(id)->mailbox.post(Cancel::Nothing, [&](Requests& requests) {
        if (!requests.scene) requests.scene = std::move(loaded); // a newer one may be there
        requests.camera.emplace(1, camera);                      // of the first scene that it gets
    });
    return id;
}

void InteractiveSession::closeViewport(ViewportId id) {
    const std::shared_ptr<Viewport> leaving = viewport(id);
    {
        const std::scoped_lock lock(mutex_);
        viewports_.erase(std::find(viewports_.begin(), viewports_.end(), leaving));
    }
    sentSizes_.erase(id);
    leaving->mailbox.post(Cancel::Build, [](Requests& requests) { requests.quit = true; });
}

// To the one that is addressed. What the user does where the focus is, others give way to.
void InteractiveSession::post(Cancel cancel, const std::function<void(Requests&)>& change) {
    at().mailbox.post(cancel, change);
    if (cancel == Cancel::Nothing || addressed_ != board_.focus()) return;
    for (const auto& other : viewports())
        if (other->id != addressed_) other->mailbox.interrupt(Cancel::Build);
}

void InteractiveSession::postToAll(Cancel cancel, const std::function<void(Requests&)>& change) {
    for (const auto& viewport : viewports()) viewport->mailbox.post(cancel, change);
}

void InteractiveSession::noteMotion() {
    if (addressed_ == board_.focus()) board_.noteMotion();
}

// Of a scene that cannot be had one of them tells.
void InteractiveSession::hand(LoadedScene loaded) {
    if (loaded.scene && loaded.request.edits == 0) ++reads_;
    loaded.reads = reads_;
    const bool isPose = loaded.request.edits == 0 && loaded.request.poses > 0;
    if (loaded.request.edits > 0 || isPose) board_.noteMotion(); // seen first where it was wished
    for (const auto& viewport : viewports()) {
        if (loaded.failure && viewport->id != board_.focus()) continue;
        viewport->mailbox.post(isPose ? Cancel::Slice : Cancel::FirstPicture, [&](Requests& requests) {
            if (loader_.isWanted(loaded.request)) requests.scene = loaded;
        });
    }
}

// What is being built for the scene before is of no use any more, and neither is one that waits for that.
void InteractiveSession::dropScenes() {
    postToAll(Cancel::Build, [this](Requests& requests) {
        if (requests.scene && !loader_.isWanted(requests.scene->request)) requests.scene.reset();
        requests.dropsScene = true;
    });
}

void InteractiveSession::open(const std::string& source, std::optional<scene::Moment> moment) {
    at().state.setStage("Loading " + source); // first: it may be there in no time
    loader_.open(source, std::move(moment));
    dropScenes();
}

void InteractiveSession::stop() {
    loader_.giveUp();
    dropScenes();
    post(Cancel::Build, Command::Stop);
}

bool InteractiveSession::reopen(const std::string& source) {
    if (!state().stage.empty()) return false;
    open(source);
    return true;
}

std::uint64_t InteractiveSession::edit(std::vector<scene::SceneEdit> edits, bool isGesture) {
    const std::uint64_t number = loader_.edit(std::move(edits), isGesture);
    noteMotion();
    postToAll(Cancel::Nothing, [this](Requests& requests) {
        if (requests.scene && !loader_.isWanted(requests.scene->request)) requests.scene.reset();
        noteChange(requests);
    });
    return number;
}

std::uint64_t InteractiveSession::pose(const scene::Moment& moment, const scene::Shutter& shutter) {
    const std::uint64_t number = loader_.pose(moment, shutter);
    noteMotion();
    postToAll(Cancel::Nothing, [](Requests& requests) { noteChange(requests); });
    return number;
}

void InteractiveSession::nameEdited(const std::string& file) {
    loader_.rename(file);
    postToAll(Cancel::Nothing, [&](Requests& requests) {
        requests.sceneFile = file;
        if (requests.scene && requests.scene->request.edits > 0) requests.scene->request.source = file;
    });
}

void InteractiveSession::writeAtEnd(const SaveRequest& request) {
    const auto first = viewports().front();
    if (first->id != kFirstViewport) return; // that one is closed, and they are written
    first->mailbox.post(Cancel::Nothing, [&](Requests& requests) { requests.atEnd = request; });
}

void InteractiveSession::tell(const WindowFigures& figures) {
    for (const auto& viewport : viewports()) viewport->state.tell(figures);
}

void InteractiveSession::change(const RenderRequest& request) {
    // Which lights there are is decided by the compiler.
    if (loader_.lastRequest().oneSidedLights != request.oneSidedLights) {
        at().state.setStage("Loading " + loader_.lastRequest().source);
        loader_.setOneSidedLights(request.oneSidedLights);
        dropScenes();
    }
    // A film of another size is not waited for: to reserve a large one takes a while.
    const bool isAnotherSize = std::exchange(sentSizes_[addressed_], request.size) != request.size;
    noteMotion();
    post(isAnotherSize ? Cancel::FirstPicture : Cancel::Slice, [&](Requests& requests) {
        requests.request = request;
        noteChange(requests);
    });
}

void InteractiveSession::moveCamera(const scene::CameraDesc& camera, std::uint64_t sceneSerial) {
    noteMotion();
    post(Cancel::Slice, [&](Requests& requests) {
        requests.camera.emplace(sceneSerial, camera);
        noteChange(requests);
    });
}

SessionState InteractiveSession::state() const {
    SessionState state = at().state.copy();
    if (const auto loading = loader_.busyWith(); loading && state.stage.empty()) state.stage = "Loading " + *loading;
    return state;
}

} // namespace rt::app
