#include "Common/Probe/NextHit.h"

#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Shared/Path/Opacity.h"

namespace rt::probe {

using namespace rt::shared;

Hit nextHit(const SceneFormulas& scene, Features features, const Ray& ray, const Sampler& sampler, std::uint32_t number,
            float end) {
    Hit hit;
    accel::rayQuery().closest(scene.accel(), &ray, &end, &hit, 1);
    if (!has(features, kFeatureOpacity)) return hit;
    LayeredRay layered = beforeLayers(ray);
    while (goesThrough(features, scene.view(), sampler, number, hit, layered)) {
        const float left = end - layered.from;
        accel::rayQuery().closest(scene.accel(), &layered.ray, &left, &hit, 1);
    }
    if (hit.t >= 0.0f) hit.t += layered.from;
    return hit;
}

} // namespace rt::probe
