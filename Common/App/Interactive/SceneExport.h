// Writes a scene as a scene file while a window goes on: as --export-scene does, the scene is read once more.
#pragma once
#include <atomic>
#include <future>
#include <optional>
#include <string>

#include "Common/Scene/Moment.h"

namespace rt::app {

class SceneExport {
  public:
    SceneExport() = default;
    ~SceneExport(); // gives up what has not been read yet
    SceneExport(const SceneExport&) = delete;
    SceneExport& operator=(const SceneExport&) = delete;

    // After the one before, if that is not done yet. `assetsBelow`: as --assets-below; `moment`: as --time.
    void start(const std::string& source, const scene::Moment& moment, const std::string& assetsBelow,
               const std::string& file);
    // Once, when it is done: the file. Throws what has kept it from being written.
    std::optional<std::string> takeResult();

  private:
    std::atomic<bool> callOff_{false};
    std::future<std::string> file_;
};

} // namespace rt::app
