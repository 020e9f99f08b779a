#include "Common/App/Interactive/InteractiveSession.h"

#include <utility>

#include "Common/App/Interactive/SessionThread.h"

namespace rt::app {
namespace {

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
    : setup_(std::move(setup)),
      sentSize_(setup_.request.size),
      state_(setup_.onChange),
      loader_([this](LoadedScene loaded) {
          mailbox_.post(Cancel::FirstPicture, [&](Requests& requests) {
              if (loader_.isWanted(loaded.request)) requests.scene = std::move(loaded);
          });
      }) {
    mailbox_.post(Cancel::Nothing, [this](Requests& requests) { requests.engine = setup_.engine; });
    state_.setStage("Loading " + setup_.scene.source);
    loader_.request(setup_.scene);
    // The engine is made, used and destroyed on this thread.
    thread_ = std::thread([this] { endFiles_ = SessionThread(setup_, mailbox_, state_, loader_).run(); });
}

InteractiveSession::~InteractiveSession() {
    close();
}

EndFiles InteractiveSession::close() {
    if (thread_.joinable()) {
        mailbox_.post(Cancel::Build, [](Requests& requests) { requests.quit = true; });
        thread_.join();
    }
    return endFiles_;
}

// What is being built for the scene before is of no use any more, and neither is one that waits for that.
void InteractiveSession::dropScenes() {
    mailbox_.post(Cancel::Build, [this](Requests& requests) {
        if (requests.scene && !loader_.isWanted(requests.scene->request)) requests.scene.reset();
        requests.dropsScene = true;
    });
}

void InteractiveSession::open(const std::string& source) {
    state_.setStage("Loading " + source); // first: it may be there in no time
    loader_.open(source);
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
    mailbox_.post(Cancel::Nothing, [this](Requests& requests) {
        if (requests.scene && !loader_.isWanted(requests.scene->request)) requests.scene.reset();
        noteChange(requests);
    });
    return number;
}

void InteractiveSession::nameEdited(const std::string& file) {
    loader_.rename(file);
    mailbox_.post(Cancel::Nothing, [&](Requests& requests) {
        requests.sceneFile = file;
        if (requests.scene && requests.scene->request.edits > 0) requests.scene->request.source = file;
    });
}

void InteractiveSession::change(const RenderRequest& request) {
    // Which lights there are is decided by the compiler.
    if (loader_.lastRequest().oneSidedLights != request.oneSidedLights) {
        state_.setStage("Loading " + loader_.lastRequest().source);
        loader_.setOneSidedLights(request.oneSidedLights);
        dropScenes();
    }
    // A film of another size is not waited for: to reserve a large one takes a while.
    const bool isAnotherSize = std::exchange(sentSize_, request.size) != request.size;
    mailbox_.post(isAnotherSize ? Cancel::FirstPicture : Cancel::Slice, [&](Requests& requests) {
        requests.request = request;
        noteChange(requests);
    });
}

void InteractiveSession::moveCamera(const scene::CameraDesc& camera, std::uint64_t sceneSerial) {
    mailbox_.post(Cancel::Slice, [&](Requests& requests) {
        requests.camera.emplace(sceneSerial, camera);
        noteChange(requests);
    });
}

SessionState InteractiveSession::state() const {
    SessionState state = state_.copy();
    if (const auto loading = loader_.busyWith(); loading && state.stage.empty()) state.stage = "Loading " + *loading;
    return state;
}

} // namespace rt::app
