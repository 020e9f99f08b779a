// What kernels do with a scene beyond Common/Shared/Base/SceneAccess.h: tracing, and fetching lights ahead of their
// use. Everything here has internal linkage.
#pragma once
#include "Common/Accel/Simd/Prefetch.h"
#include "Common/Shared/Path/Opacity.h"
#include "RayTracingCPU/KernelArgs.h"

RT_SHARED_BEGIN

// Fetches what a descent through the light tree has come to: a node's six cache lines, or a light.
RT_FN void prefetchLights(SceneRef scene, uint child) {
    const bool isNode = (child & kLightLeaf) == 0u;
    const char* record = isNode ? reinterpret_cast<const char*>(scene.lightNodes + child)
                                : reinterpret_cast<const char*>(scene.lights + (child & ~kLightLeaf));
    const std::size_t bytes = isNode ? sizeof(LightNode) : sizeof(Light);
    for (std::size_t i = 0; i < bytes; i += 64) accel::prefetch(record + i);
    accel::prefetch(record + bytes - 1);
}

RT_FN bool isOccluded(const cpu::CpuScene& scene, const Ray& ray, float tMax) {
    return scene.tracer.occluded(scene.accel, ray, tMax);
}

// What a ray of the path of a sample hits, but for layers that it goes through; `number` as for goesThrough(). Its
// distance is from ray.origin.
RT_FN Hit traceRay(Features features, const cpu::CpuScene& scene, const Sampler& smp, uint number, const Ray& ray,
                   float tMax = kInfinity) {
    Hit hit = scene.tracer.closest(scene.accel, ray, tMax);
    if (!has(features, kFeatureOpacity)) return hit;
    LayeredRay r = beforeLayers(ray);
    while (goesThrough(features, scene, smp, number, hit, r)) {
        hit = scene.tracer.closest(scene.accel, r.ray, tMax - r.from);
    }
    if (hit.t >= 0.0f) hit.t += r.from;
    return hit;
}

RT_SHARED_END
