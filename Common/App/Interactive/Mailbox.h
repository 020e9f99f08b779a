// What a window asks of its session, until the session's thread has time for it. Nobody who asks waits.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Common/App/Interactive/InteractiveState.h"
#include "Common/App/Session/SceneLoader.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {

// The last request of a kind counts, of files each. InteractiveSession says what they mean.
struct Requests {
    enum class Command { Render, GoOn, Pause, Stop, Reset };
    enum class RaceEnd { Stop, Leave }; // its picture stays, or gives way to the film's
    bool quit = false;
    bool dropsScene = false;                // that was loaded and is not wanted any more
    std::optional<std::string> sceneFile{}; // that the edited scene has been saved to
    std::optional<EngineChoice> engine{};
    std::optional<RenderRequest> request{};
    std::optional<LoadedScene> scene{};
    std::optional<std::pair<std::uint64_t, scene::CameraDesc>> camera{}; // and the serial of its scene
    std::optional<Command> command{};
    std::optional<bool> held{}; // the user has hold of something that changes the film
    std::vector<SaveRequest> saves{};
    std::optional<SaveRequest> atEnd{};
    std::optional<ViewRequest> view{};
    std::optional<bool> preview{};
    std::optional<std::uint32_t> previewWidth{};
    std::optional<std::uint32_t> referenceSpp{};
    std::optional<std::string> referenceFile{};
    std::optional<std::array<std::uint32_t, 2>> focus{}; // pixel
    std::optional<RaceRequest> race{};
    std::optional<RaceEnd> raceEnd{};
    std::optional<std::optional<std::size_t>> raceShown{}; // none within: who leads
    std::optional<Stopwatch> changed{};                    // since the first change of camera or settings

    bool any() const { return needEngine() || concernFiles() || concernRace() || dropsScene || held; }
    bool needEngine() const { return changeWhatIsSeen() || concernFilm(); }
    bool changeWhatIsSeen() const { return camera || changeAllButCamera(); }
    bool moveCameraAlone() const {
        return camera && !changeAllButCamera() && !concernFilm() && !concernFiles() && !concernRace();
    }

  private:
    bool changeAllButCamera() const { return engine || request || scene || preview || previewWidth; }
    bool concernFilm() const { return command || view || referenceSpp || referenceFile || focus; }
    bool concernRace() const { return race || raceEnd || raceShown; }
    bool concernFiles() const { return quit || !saves.empty() || atEnd || sceneFile; }
};

// What is given up for a request, each with those before it.
enum class Cancel {
    Nothing,
    Slice,        // of a film
    FirstPicture, // of a film: other requests wait for it, as a camera in motion would never show anything
    Build,        // of a scene; it begins anew unless the request replaces it
};

class Mailbox {
  public:
    // `onPost` is called after each request, on the thread that posts it; may be empty.
    explicit Mailbox(std::function<void()> onPost = {}) : onPost_(std::move(onPost)) {}

    // On any thread.
    void post(Cancel cancel, const std::function<void(Requests&)>& change);
    void interrupt(Cancel cancel); // as a request that asks for nothing: what is cancelled begins or goes on afterwards

    // On the session's thread: what was asked for since the last time.
    Requests take();
    bool hasRequests() const;
    bool isAskedToQuit() const;
    // Whether take() would return a camera and nothing else.
    bool moveCameraAlone() const;
    // True from a request that cancels this until it is taken.
    const std::atomic<bool>& cancelled(Cancel what) const { return cancelled_[static_cast<std::size_t>(what)]; }

  private:
    std::function<void()> onPost_;
    mutable std::mutex mutex_; // guards the requests
    Requests requests_;
    std::array<std::atomic<bool>, 4> cancelled_{};
};

} // namespace rt::app
