// A scene that moves: read once, and compiled at any time of its animations.
#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "Common/App/Session/FileFingerprint.h"
#include "Common/App/Session/SceneImages.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Compiler/CompileMemory.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/ModelFile.h"
#include "Common/Scene/Moment.h"

namespace rt::app {

// What no pose changes is taken over from the pose before: images, meshes that stay as they are, and what was made of
// those that stay where they are. On any thread, of which the others wait.
class PosedScene {
  public:
    // Of the request all but its moment, shutter and numbers. Throws what compile() throws.
    explicit PosedScene(SceneRequest request);

    bool isAnimated() const { return isAnimated_; }
    // Whether it is what this request's source names, at whatever moment.
    bool isOf(const SceneRequest& request) const;
    const std::optional<FileFingerprint>& mark() const { return mark_; } // of its file, before it was read
    // As compile(), and the same bits.
    std::shared_ptr<const scene::CompiledScene> at(const scene::Moment& moment);

  private:
    scene::SceneDesc describe(const scene::Moment& moment);

    const SceneRequest request_;
    const std::optional<FileFingerprint> mark_;
    std::mutex mutex_; // guards what follows
    std::unique_ptr<scene::AnimatedModel> model_;
    std::unique_ptr<scene::PosedSceneFile> file_; // one of them, or none
    bool isAnimated_ = false;
    const TexelLoader loadTexels_ = makeKeepingTexelLoader();
    scene::CompileMemory memory_;
    std::vector<std::unique_ptr<const scene::SceneDesc>> described_; // that the memory knows meshes of
};

// Poses by `scene` at the moment's animation, whatever the moment's time.
PoseScene posesOf(std::shared_ptr<PosedScene> scene, const scene::Moment& moment);

} // namespace rt::app
