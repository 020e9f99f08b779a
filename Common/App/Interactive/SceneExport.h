// Writes a scene to a file while a window goes on.
#pragma once
#include <atomic>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "Common/Scene/Moment.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::app {

class SceneExport {
  public:
    SceneExport() = default;
    ~SceneExport(); // gives up what has not been read yet
    SceneExport(const SceneExport&) = delete;
    SceneExport& operator=(const SceneExport&) = delete;

    // As --export-scene, which reads the scene once more. After the one before, if that is not done yet.
    // `assetsBelow`: as --assets-below; `moment`: as --time.
    void start(const std::string& source, const scene::Moment& moment, const std::string& assetsBelow,
               const std::string& file);
    // Likewise one that is at hand, whatever has become of its source.
    void start(scene::SceneDesc scene, const std::string& source, const std::string& assetsBelow,
               const std::string& file);
    // What is edited, as SceneFileText.h says.
    void startEdited(scene::SceneDesc scene, const std::string& source, const scene::Moment& moment,
                     const std::string& assetsBelow, const std::string& file);

    struct Result {
        std::string file;
        std::vector<std::string> notices; // of writing it
    };
    // Once, when it is done. Throws what has kept the file from being written.
    std::optional<Result> takeResult();

  private:
    void run(std::function<std::vector<std::string>()> write, const std::string& source, const std::string& assetsBelow,
             const std::string& file);

    std::atomic<bool> callOff_{false};
    std::future<Result> result_;
};

} // namespace rt::app
