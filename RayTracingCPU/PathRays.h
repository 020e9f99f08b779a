// What the loops around paths have in common. Included by one translation unit per instruction set; all it defines has internal
// linkage.
#pragma once
#include "RayTracingCPU/SceneAccess.h"

#include "Common/Shared/Path/PathStep.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// Adds what the shadow ray brings, if it arrives.
template <std::uint32_t kFeatures>
RT_FN void traceShadow(const CpuScene& scene, const DirectLight& direct, PathState& path, KernelCounters& counters) {
    if (!(direct.distance > 0.0f)) return;
    ++counters.shadow;
    if (!isOccluded(scene, shadowRay(path, direct), direct.distance)) addDirectLight(kFeatures, scene, direct, path);
}

// The same for a path that goes on, together with its next ray.
template <std::uint32_t kFeatures>
RT_FN Hit traceOn(const CpuScene& scene, const DirectLight& direct, PathState& path, KernelCounters& counters) {
    if (!(direct.distance > 0.0f)) return traceRay(scene, path.ray);
    ++counters.shadow;
    bool isOccluded;
    const Hit hit = scene.tracer.both(scene.accel, path.ray, direct.direction, direct.distance, isOccluded);
    if (!isOccluded) addDirectLight(kFeatures, scene, direct, path);
    return hit;
}

} // namespace
} // namespace rt::cpu
