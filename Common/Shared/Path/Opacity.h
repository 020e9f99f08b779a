// Surfaces of which only a part is there: a ray goes on through what it hits with the probability that is left.
#ifndef RT_SHARED_OPACITY_H
#define RT_SHARED_OPACITY_H
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Material/PrincipledSurface.h"

RT_SHARED_BEGIN

const uint kMaxLayers = 4096u; // that a ray may go through

// A ray on its way through layers.
struct LayeredRay {
    Ray ray;     // from the last layer on
    float from;  // distance of its origin from that of the whole ray
    uint layers; // behind it
};

RT_FN LayeredRay beforeLayers(RT_IN(Ray) ray) {
    LayeredRay r;
    r.ray = ray;
    r.from = 0.0f;
    r.layers = 0u;
    return r;
}

// Whether the ray goes on through what it hits, from r on; then r is moved beyond. `ray` is the number of the ray in
// the path of this sample: 2 vertices, and 1 for a shadow ray.
RT_FN bool goesThrough(Features features, SceneRef scene, RT_IN(Sampler) smp, uint ray, RT_IN(Hit) hit,
                       RT_INOUT(LayeredRay) r) {
    if (hit.t < 0.0f || r.layers == kMaxLayers) return false;
    Surface s = makeSurface(features, scene, r.ray, hit);
    if (!isPrincipled(features, loadMaterial(scene, s.material))) return false;
    float opacity = surfaceOpacity(features, scene, loadPrincipled(scene, s.material), s);
    uvec3 word = uvec3(smp.key ^ 0x7feb352du, smp.base + smp.index, ray * kMaxLayers + r.layers);
    if (toUniform(hash3(word).x) < opacity) return false;
    vec3 origin = offsetOrigin(s.position, s.error, s.normal, r.ray.direction);
    r.from += dot(origin - r.ray.origin, r.ray.direction);
    r.ray.origin = origin;
    r.layers++;
    return true;
}

RT_SHARED_END

#endif
