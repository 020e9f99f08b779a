// Scenes of glTF 2.0, read by tinygltf: docs/gltf.md says what becomes of what.
#pragma once
#include <filesystem>
#include <memory>

#include "Common/Scene/Moment.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// A .gltf or .glb file as a scene: its default scene, posed as an animation has it, without other light than its own,
// seen by its first camera, or from the front where there is none. Images stay where they are, named by ImageTexture.
// What is left out gets a notice. Throws InputError in one line, naming the file and its JSON path, and UsageError for
// an animation that there is not.
SceneDesc loadGltfScene(const std::filesystem::path& path, const Moment& moment = {});

struct GltfFile;
struct GltfPoses;

// A file that is read once, to be posed as often as one likes: what no pose changes is made once.
class GltfScene {
  public:
    // Throws InputError as loadGltfScene() does.
    explicit GltfScene(const std::filesystem::path& path);
    ~GltfScene();

    bool isAnimated() const;
    // As loadGltfScene().
    SceneDesc at(const Moment& moment);

  private:
    const std::unique_ptr<const GltfFile> file_;
    const std::unique_ptr<GltfPoses> poses_;
};

} // namespace rt::scene
