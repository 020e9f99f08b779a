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

bool isGltfFile(const std::filesystem::path& path); // by its ending

// A glTF file's scene at any time of an animation; it is read once. What surrounds it follows from its start, and stays
// where it is while the model moves: the studio, if there is one, and the view where the file has no camera. Throws
// what loadModelFile() throws.
class AnimatedModel {
  public:
    // Of the moment all but its time.
    AnimatedModel(const std::filesystem::path& path, Moment moment);
    bool isAnimated() const { return file_.isAnimated(); }
    SceneDesc at(double seconds);

  private:
    struct Start {
        CameraDesc camera;
        Bounds bounds;
        bool bringsLight = false;
    };
    static Start startOf(const SceneDesc& scene);

    const GltfScene file_;
    const Moment moment_;
    std::optional<Start> start_; // once a pose was asked for
};

} // namespace rt::scene
