// A compiled scene with what its rays and formulas need.
#pragma once
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "Common/Accel/AccelInput.h"
#include "Common/Accel/CpuAccel.h"
#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/App/Options/Options.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Shared/Base/SceneAccess.h"

namespace rt::probe {

// Immutable, but for the acceleration structure, which is built when the first ray is traced. Any thread may use it.
class SceneFormulas {
  public:
    // Settles the size of the image in the options. Throws UsageError and InputError.
    SceneFormulas(std::shared_ptr<const scene::CompiledScene> compiled, app::Options options, double seconds);
    // This scene with other options, which would have compiled it alike. Both share the acceleration structure.
    std::shared_ptr<SceneFormulas> with(app::Options options) const;

    const std::shared_ptr<const scene::CompiledScene>& compiled() const { return compiled_; }
    const app::Options& options() const { return options_; }
    double seconds() const { return seconds_; } // that loading and compiling took

    const shared::SceneView& view() const { return view_; }
    const shared::RenderParams& params() const { return params_; }
    const shared::Camera& camera() const { return camera_; }
    shared::Features features() const { return features_; } // of the scene and the methods that the options ask for
    const accel::AccelView& accel() const;
    // Builds the acceleration structure, unless it is there; false: *cancel became true first.
    bool prepare(const std::atomic<bool>& cancel) const;

    // Between coordinates as authored and those of the compiled scene, which begin at its camera.
    shared::vec3 toScene(const shared::vec3& world) const;
    shared::vec3 toWorld(const shared::vec3& scene) const;

  private:
    std::shared_ptr<const scene::CompiledScene> compiled_;
    app::Options options_;
    double seconds_;
    std::array<float, 256> srgbToLinear_{};
    shared::SceneView view_;
    shared::RenderParams params_{};
    shared::Camera camera_{};
    shared::Features features_;
    struct SharedAccel {
        std::mutex mutex;
        std::unique_ptr<const accel::CpuAccel> built;
    };
    std::shared_ptr<SharedAccel> accel_ = std::make_shared<SharedAccel>();
};

// Of a scene as these settings would render it. What `kept`, which may be null, has built for the scene stays.
std::shared_ptr<const SceneFormulas> formulasFor(const std::shared_ptr<const scene::CompiledScene>& scene,
                                                 const app::RenderSettings& rendering,
                                                 std::shared_ptr<const SceneFormulas> kept = nullptr);

} // namespace rt::probe
