// What kernels do with a scene beyond Common/Shared/Base/SceneAccess.h: tracing, fetching lights ahead of their use, and the choice
// by contribution in vectors. Everything here has internal linkage.
#pragma once
#include "Common/Accel/Simd/Prefetch.h"
#include "Common/Accel/Simd/Simd.h"
#include "Common/Shared/Light/LightContribution.h"
#include "RayTracingCPU/KernelArgs.h"

RT_SHARED_BEGIN

// Of what a descent through the light tree has got to: a node's six cache lines, or a light.
RT_FN void expectLightChild(SceneRef scene, uint child) {
    const bool isNode = (child & kLightLeaf) == 0u;
    const char* record = isNode ? reinterpret_cast<const char*>(scene.lightNodes + child)
                                : reinterpret_cast<const char*>(scene.lights + (child & ~kLightLeaf));
    const std::size_t bytes = isNode ? sizeof(LightNode) : sizeof(Light);
    for (std::size_t i = 0; i < bytes; i += 64) accel::prefetch(record + i);
    accel::prefetch(record + bytes - 1);
}

RT_FN Hit traceRay(const cpu::CpuScene& scene, const Ray& ray) {
    return scene.tracer.closest(scene.accel, ray, kInfinity);
}

RT_FN bool isOccluded(const cpu::CpuScene& scene, const Ray& ray, float tMax) {
    return scene.tracer.occluded(scene.accel, ray, tMax);
}

RT_FN LightBound lightBoundAt(const cpu::LightBoundsSoa& bounds, uint i) {
    LightBound bound;
    bound.center = vec3(bounds.centerX[i], bounds.centerY[i], bounds.centerZ[i]);
    bound.radius = bounds.radius[i];
    bound.axis = vec3(bounds.axisX[i], bounds.axisY[i], bounds.axisZ[i]);
    bound.twoSided = bounds.twoSided[i];
    bound.intensity = bounds.intensity[i];
    return bound;
}

// As in LightSelection.h, in whole vectors of lights; the entries that pad the table have no intensity and so no weight.
#define RT_PICKS_CONTRIBUTIONS
RT_FN LightPick pickContribution(SceneRef scene, uint count, vec3 position, vec3 normal, float u) {
    static_assert(kContributionLights == 32);
    alignas(32) float weights[kContributionLights];
    alignas(32) float sums[kContributionLights];
    const cpu::LightBoundsSoa& bounds = *static_cast<const cpu::CpuScene&>(scene).lightBoundsSoa;
    const uint padded = (count + 7u) & ~7u;
    for (uint i = 0u; i < padded; i++) {
        weights[i] = lightContribution(lightBoundAt(bounds, i), position, normal);
    }
    float total = 0.0f;
    for (uint i = 0u; i < padded; i += 8u) {
        const accel::Float8 eight = accel::runningSums(accel::load(weights + i));
        accel::store(sums + i, eight + accel::broadcast(total));
        total += accel::lane(eight, 7);
    }
    const float place = u * total;
    unsigned above = 1u << 31; // the sums, a bit each
    for (uint i = 0u; i < padded; i += 8u) {
        above |= accel::bits(accel::broadcast(place) < accel::load(sums + i)) << i;
    }
    const uint light = min(accel::lowestBit(above), count - 1u);
    return {light, weights[light], sums[light] - place, total};
}

RT_SHARED_END
