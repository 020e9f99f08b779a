// Whether a light that was sampled arrives. Included by one translation unit per instruction set; all it defines has
// internal linkage.
#pragma once
#include "Common/Shared/Path/DirectLight.h"
#include "RayTracingCPU/SceneAccess.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// `direct` was sampled from the last vertex of a sample's path, and has a shadow ray.
template <Features kFeatures>
bool arrives(const CpuScene& scene, const Sampler& smp, const PathState& path, const DirectLight& direct) {
    const Ray ray = shadowRay(path, direct);
    if (!has(kFeatures, kFeatureOpacity)) return !isOccluded(scene, ray, direct.distance);
    return traceRay(kFeatures, scene, smp, 2u * path.vertex + 1u, ray, direct.distance).t < 0.0f;
}

} // namespace
} // namespace rt::cpu
