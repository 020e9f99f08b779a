// Files of models and scenes that other programs write: glTF, OBJ, pbrt.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Moment.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// The ending of a file, in lower case, with what is packed before ".gz".
std::string kindOfFile(const std::filesystem::path& path);

bool isModelFile(const std::filesystem::path& path); // by its ending

// A model that brings no light stands in a studio (Studio.h), which is the same at all moments. Throws InputError, and
// UsageError for an animation that there is not.
SceneDesc loadModelFile(const std::filesystem::path& path, const Moment& moment);

// Likewise, without a studio.
SceneDesc loadModelAlone(const std::filesystem::path& path, const Moment& moment);

bool isGltfFile(const std::filesystem::path& path); // by its ending

// A glTF file's scene at any time of its animations; it is read once. What surrounds it follows from the start of the
// animation, and stays where it is while the model moves: the studio, if there is one, and the view where the file has
// no camera. Throws what loadModelFile() throws.
class AnimatedModel {
  public:
    explicit AnimatedModel(const std::filesystem::path& path) : file_(path) {}
    bool isAnimated() const { return file_.isAnimated(); }
    SceneDesc at(const Moment& moment);

  private:
    struct Start {
        std::string animation;
        CameraDesc camera;
        Bounds bounds;
        bool bringsLight;
    };
    static Start startOf(const SceneDesc& scene, const std::string& animation);

    GltfScene file_;
    std::optional<Start> start_; // of the animation that was asked for last
};

} // namespace rt::scene
