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
    if (before.accumulate && after.accumulate) after.samplesPerFrame = before.samplesPerFrame; // only when it is shown
    return after != before;
}

bool differsInBudgetsAlone(const RenderRequest& before, RenderRequest after) {
    after.settings.spp = before.settings.spp;
    after.timeLimit = before.timeLimit;
    after.targetError = before.targetError;
    after.samplesPerFrame = before.samplesPerFrame;
    return after == before;
}

InteractiveSession::InteractiveSession(Setup setup)
    : setup_(std::move(setup)), state_(setup_.onChange), loader_([this](LoadedScene loaded) {
          mailbox_.post(Cancel::Nothing, [&](Requests& requests) { requests.scene = std::move(loaded); });
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

void InteractiveSession::open(const std::string& source) {
    state_.setStage("Loading " + source);
    loader_.open(source);
}

bool InteractiveSession::reopen(const std::string& source) {
    if (!state().stage.empty()) return false;
    open(source);
    return true;
}

void InteractiveSession::change(const RenderRequest& request) {
    // Which lights there are is decided by the compiler.
    if (loader_.setOneSidedLights(request.oneSidedLights)) state_.setStage("Loading " + loader_.lastRequest().source);
    mailbox_.post(Cancel::Slice, [&](Requests& requests) {
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
