// Loads and compiles scenes on a thread of its own, so that the scene before stays in use until the next one is ready.
#pragma once
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "Common/App/Session/FileFingerprint.h"
#include "Common/App/Session/PosedScene.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Compiler/CompileMemory.h"
#include "Common/Scene/Edit/SceneEdit.h"

namespace rt::app {

struct LoadedScene {
    std::shared_ptr<const scene::CompiledScene> scene; // empty: it failed
    std::exception_ptr failure;
    SceneRequest request;
    std::optional<FileFingerprint> mark; // of its file, as it was before it was read
    std::vector<FileFingerprint> models; // of the files of models that it has taken in, likewise
    double seconds = 0;
    PoseScene poses;         // at other times than the request's, where its shutter is open; none: nothing moves
    std::uint64_t reads = 0; // of scenes from their sources, this one included; counted by who shows them
};

class SceneLoader {
  public:
    // `onLoaded` is called on the loader's thread.
    explicit SceneLoader(std::function<void(LoadedScene)> onLoaded);
    ~SceneLoader(); // calls a load in progress off

    // Replaces a request that has not begun; one that has begun is called off.
    void request(SceneRequest request);
    // As what was requested last, but for the camera: the scene's own. Without a moment: at that of the same scene.
    void open(const std::string& source, std::optional<scene::Moment> moment = {});
    // What is loaded or was requested last, at another moment: its file is not read again. One that has begun goes on
    // and is handed over, or playing would never show anything; the last that has not begun counts. What is edited is
    // forgotten. Returns SceneRequest::poses.
    std::uint64_t pose(const scene::Moment& moment, const scene::Shutter& shutter);
    bool setOneSidedLights(bool on); // loads anew what was requested last; false: it is loaded so
    SceneRequest lastRequest() const;
    // What is loaded or has just been; the last request is then the one before that was handed over.
    void giveUp();
    bool isWanted(const SceneRequest& request) const; // nothing else has been requested, nor has it been given up
    // From now on the scene that was handed over last is edited: this is its description. It is compiled once where
    // nobody waits for it, so that the first edit takes over as much as those after it.
    void startEditing(scene::SceneDesc scene);
    void stopEditing(); // forgets it
    // Edits that the window's own description has got; what they make of this one is compiled and handed over. What is
    // being compiled of the edits before is called off, unless these are of a gesture: a drag would never show
    // anything.
    // Returns SceneRequest::edits of what they make.
    std::uint64_t edit(std::vector<scene::SceneEdit> edits, bool isGesture);
    // Which file the edited scene is in by now.
    void rename(const std::string& source);
    bool isResting() const; // neither loads nor prepares anything, nor is about to
    // What is being loaded, if anything.
    std::optional<std::string> busyWith() const;

  private:
    LoadedScene load(const SceneRequest& request);
    void loadPose(const SceneRequest& request, LoadedScene& result);
    void ask(SceneRequest request);
    void forgetDescription();
    void prepareEdits(const SceneRequest& request, const std::weak_ptr<const scene::CompiledScene>& shown);
    void work();

    std::function<void(LoadedScene)> onLoaded_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    SceneRequest last_; // requested
    SceneRequest handedOver_;
    std::weak_ptr<const scene::CompiledScene> shown_; // as it was handed over last
    bool isGivenUp_ = false;                          // what is being loaded
    std::optional<SceneRequest> next_;
    std::optional<SceneRequest> current_;
    bool isPreparing_ = false; // for edits that may come
    bool quit_ = false;
    std::atomic<bool> callOff_{false};                // what is being loaded, or prepared
    SceneRequest edited_;                             // of the scene that is edited, as it was handed over
    std::uint64_t edits_ = 0;                         // of requests so far
    std::optional<scene::SceneDesc> nextDescription_; // of a scene that has begun to be edited
    std::vector<scene::SceneEdit> nextEdits_;
    std::optional<scene::SceneDesc> description_; // the thread's own, with all edits but the next ones
    // Of the thread's own description. Meshes that edits took out of it stay where they are until it no longer knows
    // them.
    scene::CompileMemory memory_;
    std::vector<scene::SceneEdit> doneEdits_; // since the latest compilation that succeeded
    bool forgetsDescription_ = false;         // when the thread comes to it
    std::uint64_t poses_ = 0;                 // of requests so far
    std::shared_ptr<PosedScene> posed_;       // the thread's own; null: no other moment was wished of what is shown
    std::thread thread_;
};

} // namespace rt::app
