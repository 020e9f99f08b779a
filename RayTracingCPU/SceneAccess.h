// Gives Common/Shared its access to the scene on the CPU: SceneRef, every load...(), tracing. Include it before the headers
// that fetch; everything here has internal linkage.
#pragma once
#include "Common/Accel/Simd/Prefetch.h"
#include "Common/Accel/Simd/Simd.h"
#include "Common/Shared/Light/LightContribution.h"
#include "Common/Shared/Light/Lights.h"
#include "RayTracingCPU/KernelArgs.h"

RT_SHARED_BEGIN

using SceneRef = const cpu::CpuScene&;

const uint kFarLights = 4096u; // more than a core's own cache holds

RT_FN const SceneGlobals& loadGlobals(SceneRef scene) {
    return scene.globals;
}
#define RT_LOAD(Type, name, load, title)             \
    RT_FN const Type& load(SceneRef scene, uint i) { \
        return scene.name[i];                        \
    }
#define RT_DEFINED_BELOW(Type, name, load, title)
RT_SCENE_ARRAYS(RT_LOAD, RT_DEFINED_BELOW)
#undef RT_LOAD
#undef RT_DEFINED_BELOW

RT_FN vec3 loadSphereMotion(SceneRef scene, uint i) {
    return scene.sphereMotions != nullptr ? scene.sphereMotions[i] : vec3(0.0f);
}
RT_FN LightCluster loadLightCluster(SceneRef scene, uint node, uint i) {
    const LightNode& n = scene.lightNodes[node];
    LightCluster c;
    c.center = vec3(n.centerX[i], n.centerY[i], n.centerZ[i]);
    c.radius = n.radius[i];
    c.axis = vec3(n.axisX[i], n.axisY[i], n.axisZ[i]);
    c.alignment = n.alignment[i];
    c.spreadCosine = n.spreadCosine[i];
    c.facing = n.facing[i];
    c.around = n.around[i];
    c.child = n.child[i];
    return c;
}
RT_FN void expectLights(SceneRef scene, uint node) {
    if (scene.globals.lightCount < kFarLights) return;
    for (const uint child : scene.lightNodes[node].child) {
        if ((child & kLightLeaf) == 0u) continue;
        const char* light = reinterpret_cast<const char*>(scene.lights + (child & ~kLightLeaf));
        accel::prefetch(light);
        accel::prefetch(light + sizeof(Light) - 1);
    }
}
// The same of what a descent has got to: a node's six lines, or a light.
RT_FN void expectLightChild(SceneRef scene, uint child) {
    const bool isNode = (child & kLightLeaf) == 0u;
    const char* record = isNode ? reinterpret_cast<const char*>(scene.lightNodes + child)
                                : reinterpret_cast<const char*>(scene.lights + (child & ~kLightLeaf));
    const std::size_t bytes = isNode ? sizeof(LightNode) : sizeof(Light);
    for (std::size_t i = 0; i < bytes; i += 64) accel::prefetch(record + i);
    accel::prefetch(record + bytes - 1);
}
RT_FN uint loadLightNodeParent(SceneRef scene, uint node) {
    return loadLightPlace(scene, scene.globals.lightCount + node);
}

RT_FN vec3 loadTexel(SceneRef scene, const Image& image, uint x, uint y) {
    const uint texel = y * image.width + x;
    if (image.format == kTexelLinearF32) {
        const uint* words = scene.texels + image.firstTexel + 3u * texel;
        return vec3(uintBitsToFloat(words[0]), uintBitsToFloat(words[1]), uintBitsToFloat(words[2]));
    }
    const uint word = scene.texels[image.firstTexel + texel];
    return vec3(scene.srgbToLinear[word & 255u], scene.srgbToLinear[word >> 8u & 255u],
                scene.srgbToLinear[word >> 16u & 255u]);
}

RT_FN Hit traceRay(SceneRef scene, const Ray& ray) {
    return scene.tracer.closest(scene.accel, ray, kInfinity);
}

RT_FN bool isOccluded(SceneRef scene, const Ray& ray, float tMax) {
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
    const cpu::LightBoundsSoa& bounds = *scene.lightBoundsSoa;
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
