// The same work by the other of both programs, without a window, for a comparison with what this one has rendered.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "Common/App/Interactive/RunHistory.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Image/Image.h"
#include "Common/Render/Settings.h"
#include "Common/Scene/CompiledScene.h"

namespace rt::app {

// What is rendered; all but the engine is this program's.
struct OtherJob {
    std::string program; // to be run, "ray-tracing-gpu"; found beside this one
    SceneRequest scene;  // its pose does not count
    std::shared_ptr<const scene::CompiledScene> compiled;
    scene::CameraDesc camera;
    RenderSettings settings;
    std::shared_ptr<const image::Image> reference; // of this view; null: the error is the film's own estimate
    double referenceError = 0;                     // its own relMSE; 0: not known
};

// The flags that make the other program render the job, to `picture` and `statistics`.
std::vector<std::string> argumentsFor(const OtherJob& job, const std::filesystem::path& picture,
                                      const std::filesystem::path& statistics);
// Samples per pixel that the last whole line of progress in a program's messages tells of; 0: none does.
std::uint64_t progressIn(const std::string& messages);

struct OtherState {
    enum class Phase { None, Running, Done, Failed, Cancelled };
    Phase phase = Phase::None;
    std::string program;
    std::uint64_t spp = 0, sppWanted = 0;      // of every pixel
    std::string error;                         // of Failed: one line
    std::shared_ptr<const image::Image> image; // of Done: linear
    RunRecord record;                          // likewise
    std::uint64_t serial = 0;                  // grows with each job that is done
};

// One job at a time, waited for on a thread of its own. The destructor ends the program that runs.
class OtherEngine {
  public:
    // `onChange` is called on that thread when the state has changed; the history gets what is done.
    OtherEngine(RunHistory& history, std::function<void()> onChange)
        : history_(history), onChange_(std::move(onChange)) {}
    ~OtherEngine() { close(); }
    OtherEngine(const OtherEngine&) = delete;
    OtherEngine& operator=(const OtherEngine&) = delete;

    void start(const OtherJob& job);  // does nothing while one runs
    void cancel() { cancel_ = true; } // ends the program soon
    void close();                     // and waits for that
    OtherState state() const;
    bool isRunning() const { return state().phase == OtherState::Phase::Running; }

    // Where the programs are, in place of this one's folder: for tests.
    std::filesystem::path folder;

  private:
    void work(const OtherJob& job);
    void finish(const OtherJob& job, const std::filesystem::path& picture, const std::filesystem::path& statistics);
    void update(const std::function<void(OtherState&)>& change);

    RunHistory& history_;
    std::function<void()> onChange_;
    mutable std::mutex mutex_; // guards the state
    OtherState state_;
    std::atomic<bool> cancel_{false};
    std::thread thread_;
};

} // namespace rt::app
