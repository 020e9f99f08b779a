#include "Common/Probe/ArrivingLight.h"

#include <algorithm>

#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Probe/NextHit.h"
#include "Common/Render/RenderParams.h"
#include "Common/Shared/Path/PathStep.h"

namespace rt::probe {

using namespace rt::shared;

namespace {

// Paths by themselves, each with all that it finds: what pixels share, and more rays at edges, are of a film.
app::RenderSettings settingsOfPaths(app::RenderSettings settings) {
    settings.lightSampling = app::LightSampling::Mis;
    settings.specularConnections = settings.edgeRays = false;
    settings.pathReuse = app::PathReuse::Off;
    settings.features.reset();
    return settings;
}

} // namespace

ArrivingLight::ArrivingLight(const SceneFormulas& scene) : scene_(&scene) {
    const app::RenderSettings settings = settingsOfPaths(scene.options().settings);
    params_ = app::makeRenderParams(*scene.compiled(), settings);
    params_.maxDepth = std::max(params_.maxDepth, 1u) - 1u;
    features_ = app::renderFeatures(*scene.compiled(), scene.compiled()->camera, settings);
}

Hit ArrivingLight::closest(const Ray& ray) const {
    const float end = kInfinity;
    Hit hit;
    accel::rayQuery().closest(scene_->accel(), &ray, &end, &hit, 1);
    return hit;
}

shared::vec3 ArrivingLight::trace(const Ray& ray, const Sampler& sampler) const {
    PathState path = startPath(ray);
    TechniqueStep step = beginTechniqueStep();
    for (bool goesOn = true; goesOn;) {
        const Hit hit = nextHit(*scene_, features_, path.ray, sampler, 2u * path.vertex, kInfinity);
        DirectLight direct = noDirectLight();
        goesOn = stepPath(features_, scene_->view(), params_, sampler, hit, path, direct, step);
        if (!(direct.distance > 0.0f)) continue;
        const Hit occluder =
            nextHit(*scene_, features_, shadowRay(path, direct), sampler, 2u * path.vertex + 1u, direct.distance);
        if (occluder.t < 0.0f) addDirectLight(features_, scene_->view(), direct, path);
    }
    return path.radiance;
}

} // namespace rt::probe
