#include "Common/Probe/SceneFormulas.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "Common/Render/RenderParams.h"
#include "Common/Scene/CameraRecord.h"

namespace rt::probe {

SceneFormulas::SceneFormulas(std::shared_ptr<const scene::CompiledScene> compiled, app::Options options, double seconds)
    : compiled_(std::move(compiled)), options_(std::move(options)), seconds_(seconds) {
    const scene::CompiledScene& s = *compiled_;
    app::settleImageSize(options_, s.id, s.defaults.aspect);
    for (std::size_t i = 0; i < srgbToLinear_.size(); ++i) {
        const double encoded = static_cast<double>(i) / 255.0;
        srgbToLinear_[i] =
            static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
    }
    view_ = shared::viewOf(s, s.globals);
    view_.srgbToLinear = srgbToLinear_.data();
    const app::RenderSettings& settings = options_.settings;
    features_ = app::renderFeatures(s, s.camera, settings);
    params_ = app::makeRenderParams(s, settings);
    camera_ = scene::makeCamera(s.camera, settings.width, settings.height, s.origin);
}

std::shared_ptr<SceneFormulas> SceneFormulas::with(app::Options options) const {
    auto scene = std::make_shared<SceneFormulas>(compiled_, std::move(options), 0.0);
    scene->accel_ = accel_;
    return scene;
}

bool SceneFormulas::prepare(const std::atomic<bool>& cancel) const {
    const std::scoped_lock lock(accel_->mutex);
    if (!accel_->built) accel_->built = accel::CpuAccel::build(accel::inputOf(*compiled_), {}, &cancel);
    return accel_->built != nullptr;
}

const accel::AccelView& SceneFormulas::accel() const {
    static const std::atomic<bool> isNever{false};
    prepare(isNever);
    return accel_->built->view();
}

shared::vec3 SceneFormulas::toScene(const shared::vec3& world) const {
    return shared::vec3(glm::dvec3(world) - compiled_->origin);
}

shared::vec3 SceneFormulas::toWorld(const shared::vec3& scene) const {
    return shared::vec3(glm::dvec3(scene) + compiled_->origin);
}

std::shared_ptr<const SceneFormulas> formulasFor(const std::shared_ptr<const scene::CompiledScene>& scene,
                                                 const app::RenderSettings& rendering,
                                                 std::shared_ptr<const SceneFormulas> kept) {
    const bool isOfScene = kept && kept->compiled() == scene;
    if (isOfScene && kept->options().settings == rendering) return kept;
    app::Options options;
    options.settings = rendering;
    options.size = {rendering.width, rendering.height, {}};
    if (isOfScene) return kept->with(std::move(options));
    return std::make_shared<SceneFormulas>(scene, std::move(options), 0.0);
}

} // namespace rt::probe
