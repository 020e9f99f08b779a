// Reads a model that is to be added to the scene that a window edits, while the window goes on.
#pragma once
#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Edit/SceneEdit.h"

namespace rt::app {

class ModelReading {
  public:
    ModelReading() = default;
    ~ModelReading() { stop(); }
    ModelReading(const ModelReading&) = delete;
    ModelReading& operator=(const ModelReading&) = delete;

    // In place of the one before. `name`: by which the scene is going to call it; `assetsBelow`: as --assets-below.
    void start(const std::string& name, const std::string& file, const std::string& assetsBelow);
    void stop(); // it is not wanted any more
    bool isUnderWay() const { return reading_.valid(); }
    const std::string& file() const { return file_; }
    // Once, when it is there. Throws what has kept it from being read.
    std::optional<scene::SetModel> take();

  private:
    std::string file_;
    std::shared_ptr<std::atomic<bool>> callOff_;
    std::future<scene::SetModel> reading_;
    std::vector<std::future<scene::SetModel>> unwanted_; // whose threads still end
};

// As files of models and images are named in scenes: from the root, without "..".
std::string wholePath(const std::string& file);
// The model of the scene that this file is; empty: there is none.
std::string modelOfFile(const scene::SceneDesc& scene, const std::string& file);

// What puts an instance of a model into the scene, behind all other objects and where placeOfModel() says. `model`:
// what the scene is to take in first; none: it has it. `bounds`: of the scene.
std::vector<scene::SceneEdit> editsToAdd(const scene::SceneDesc& scene, const std::string& name,
                                         std::optional<scene::SetModel> model, const scene::Bounds& bounds,
                                         const scene::CameraDesc& camera);

// What takes models out of the scene of which nothing would be left to be seen without these objects.
std::vector<scene::SceneEdit> editsToDrop(const scene::SceneDesc& scene, const std::vector<scene::ObjectPath>& objects);

} // namespace rt::app
