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

#include "Common/App/Session/FileFingerprint.h"
#include "Common/App/Session/SceneSource.h"

namespace rt::app {

struct LoadedScene {
    std::shared_ptr<const scene::CompiledScene> scene; // empty: it failed
    std::exception_ptr failure;
    SceneRequest request;
    std::optional<FileFingerprint> mark; // of its file, as it was before it was read
    double seconds = 0;
};

class SceneLoader {
  public:
    // `onLoaded` is called on the loader's thread.
    explicit SceneLoader(std::function<void(LoadedScene)> onLoaded);
    ~SceneLoader(); // calls a load in progress off

    // Replaces a request that has not begun; one that has begun is called off.
    void request(SceneRequest request);
    void open(const std::string& source); // as what was requested last, but for the camera: the scene's own
    bool setOneSidedLights(bool on);      // loads anew what was requested last; false: it is loaded so
    SceneRequest lastRequest() const;
    // What is loaded or has just been; the last request is then the one before that was handed over.
    void giveUp();
    bool isWanted(const SceneRequest& request) const; // nothing else has been requested, nor has it been given up
    // What is being loaded, if anything.
    std::optional<std::string> busyWith() const;

  private:
    void work();

    std::function<void(LoadedScene)> onLoaded_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    SceneRequest last_; // requested
    SceneRequest handedOver_;
    bool isGivenUp_ = false; // what is being loaded
    std::optional<SceneRequest> next_;
    std::optional<SceneRequest> current_;
    bool quit_ = false;
    std::atomic<bool> callOff_{false}; // what is being loaded
    std::thread thread_;
};

} // namespace rt::app
