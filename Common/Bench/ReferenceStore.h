// References: images so good that what is measured against them is not their own error. Kept on disk, and made better
// when a later measurement asks for more.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "Common/App/Session/ReferenceCache.h"
#include "Common/Image/ErrorAnalysis.h"
#include "Common/Render/Engine.h"
#include "Common/Scene/CompiledScene.h"

namespace rt::bench {

// What two renders must have in common to converge to one image, beside the scene.
struct ReferenceRequest {
    const scene::CompiledScene* scene = nullptr;
    std::uint32_t width = 0, height = 0;
    std::uint32_t maxDepth = 0;
    double maxSeconds = 60;                    // of rendering
    std::uint64_t firstSpp = 256;              // to begin with where nothing is cached
    const scene::CameraDesc* camera = nullptr; // null: the scene's
};

struct ReferenceResult {
    image::Reference reference;
    std::uint64_t spp = 0;
    double seconds = 0;  // spent on it now
    bool cached = false; // a part of it was made earlier
    // Its standard error is at most a third of the least error measured against it; otherwise time ran out.
    bool sufficient = false;
};

class ReferenceStore {
  public:
    // `folder` empty: nothing is kept. With `fresh` what is there is not read.
    ReferenceStore(std::filesystem::path folder, bool fresh) : cache_(std::move(folder)), fresh_(fresh) {}

    // Adds samples until every image of `measured` is at least three times as far off, standard error against error, of
    // mse by all pixels, mse by those up to 1, and relmse. The engine has the scene. Nothing when stopped before there
    // was anything.
    std::optional<ReferenceResult> provide(const ReferenceRequest& request,
                                           std::span<const image::Image* const> measured, app::Engine& engine,
                                           const std::atomic<bool>& stop);

    // The file of a request: named after a hash of all that its image depends on.
    std::filesystem::path fileOf(const ReferenceRequest& request) const;

  private:
    app::ReferenceCache cache_;
    bool fresh_;
};

} // namespace rt::bench
