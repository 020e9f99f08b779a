// The loops around a path on the CPU: tiles, pixels, samples. Included by one translation unit per instruction set; all it
// defines has internal linkage.
#pragma once
#include "RayTracingCPU/SceneAccess.h"

#include "Common/Shared/PathStep.h"
#include "RayTracingCPU/NumberTable.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// A sample that is not a number is dropped and counted, and stays in the divisor.
RT_FN void addSample(const PathState& path, vec3& total, KernelCounters& counters) {
    counters.scattered += path.vertex - 1u;
    if (isFinite(path.radiance)) {
        total += path.radiance;
    } else {
        ++counters.nonfinite;
    }
}

// Adds what the shadow ray brings, if it arrives.
template <std::uint32_t kFeatures>
RT_FN void traceShadow(const CpuScene& scene, const DirectLight& direct, PathState& path, KernelCounters& counters) {
    if (!(direct.distance > 0.0f)) return;
    ++counters.shadow;
    if (!isOccluded(scene, shadowRay(path, direct), direct.distance)) addDirectLight(kFeatures, scene, direct, path);
}

// ---- one path after the other ---------------------------------------------------------------------------------------

template <std::uint32_t kFeatures>
RT_CALL void tracePaths(const KernelContext& context, uvec2 pixel, Sampler smp, std::uint32_t count, vec3& total,
                        KernelCounters& counters) {
    const CpuScene& scene = *context.scene;
    NumberTable numbers(smp, count, kFeatures);
    for (std::uint32_t i = 0; i < count; ++i, ++smp.index) {
        PathState path = startPath(kFeatures, context.params, context.camera, smp, pixel, numbers.pixelNumbers(smp));
        Hit hit = traceRay(scene, path.ray);
        for (;;) {
            DirectLight direct = noDirectLight();
            Vertex vertex;
            const bool goesOn = pathVertex(vertex, kFeatures, scene, context.params, smp,
                                           numbers.vertexNumbers(smp, path.vertex), hit, path, direct);
            if (!goesOn) {
                traceShadow<kFeatures>(scene, direct, path, counters);
                break;
            }
            if (!(direct.distance > 0.0f)) {
                hit = traceRay(scene, path.ray);
                continue;
            }
            ++counters.shadow;
            bool isOccluded;
            hit = scene.tracer.both(scene.accel, path.ray, direct.direction, direct.distance, isOccluded);
            if (!isOccluded) addDirectLight(kFeatures, scene, direct, path);
        }
        addSample(path, total, counters);
    }
}

// ---- all paths of a pixel side by side ------------------------------------------------------------------------------
// For scenes in which paths wait for memory: what one waits for arrives during the turns of the others.

constexpr std::uint32_t kPaths = image::Film::kBlock;

// A path, and the vertex at which it is.
struct Flight {
    PathState path;
    Vertex vertex;
    DirectLight direct;
};

// Some of the paths, by their places among all.
struct FlightList {
    std::uint32_t count = 0;
    std::uint32_t places[kPaths] = {};
    void add(std::uint32_t place) { places[count++] = place; }
    const std::uint32_t* begin() const { return places; }
    const std::uint32_t* end() const { return places + count; }
};

RT_FN Sampler samplerOf(Sampler first, std::uint32_t place) {
    first.index += place;
    return first;
}

// To where the path scatters. False: it ends before.
template <std::uint32_t kFeatures>
RT_FN bool arrive(const CpuScene& scene, const RenderParams& params, const Sampler& smp, const VertexNumbers& numbers,
                  Flight& f) {
    const Hit hit = traceRay(scene, f.path.ray);
    if (!pathVertex(f.vertex, kFeatures | kLightAwaited, scene, params, smp, numbers, hit, f.path, f.direct))
        return false;
    f.path.last = lightContext(params, f.vertex);
    return true;
}

// The choice among lights in a tree, which all paths go down level by level.
template <std::uint32_t kFeatures>
RT_FN void chooseLights(const CpuScene& scene, const Sampler& first, Flight* flights, const FlightList& list) {
    TreeDescent descents[kPaths];
    FlightList descending;
    for (const std::uint32_t i : list) {
        const Vertex& v = flights[i].vertex;
        if (isDeltaVertex(kFeatures, v)) continue;
        descents[i] = beginDescent(selectionNumbers(kFeatures, scene.globals, samplerOf(first, i), v));
        descending.add(i);
    }
    while (descending.count > 0) {
        FlightList next;
        for (const std::uint32_t i : descending) {
            LightContext& context = flights[i].path.last;
            TreeDescent& d = descents[i];
            descend(scene, context.position, context.normal, d);
            if (d.child != kNone) expectLightChild(scene, d.child);
            if (isAtNode(d)) {
                next.add(i);
            } else {
                const TreeChoice drawn = endDescent(d);
                context.total = drawn.total;
                context.chosen = {drawn.light, drawn.probability, 0.0f};
            }
        }
        descending = next;
    }
}

template <std::uint32_t kFeatures>
RT_CALL void tracePathsSideBySide(const KernelContext& context, uvec2 pixel, const Sampler& first, std::uint32_t count,
                                  vec3& total, KernelCounters& counters) {
    const CpuScene& scene = *context.scene;
    const RenderParams& params = context.params;
    NumberTable numbers(first, count, kFeatures);
    Flight flights[kPaths];
    FlightList going;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Sampler smp = samplerOf(first, i);
        flights[i].path = startPath(kFeatures, params, context.camera, smp, pixel, numbers.pixelNumbers(smp));
        going.add(i);
    }
    while (going.count > 0) {
        FlightList arrived;
        for (const std::uint32_t i : going) {
            Flight& f = flights[i];
            const Sampler smp = samplerOf(first, i);
            if (arrive<kFeatures>(scene, params, smp, numbers.vertexNumbers(smp, f.path.vertex), f)) arrived.add(i);
        }
        chooseLights<kFeatures>(scene, first, flights, arrived);
        going.count = 0;
        for (const std::uint32_t i : arrived) {
            Flight& f = flights[i];
            f.direct = noDirectLight();
            if (scatter(kFeatures | kLightChosen, scene, params, samplerOf(first, i), f.vertex, f.path, f.direct))
                going.add(i);
        }
        for (const std::uint32_t i : arrived) {
            traceShadow<kFeatures>(scene, flights[i].direct, flights[i].path, counters);
        }
    }
    for (std::uint32_t i = 0; i < count; ++i) addSample(flights[i].path, total, counters);
}

// ---- pixels and tiles -----------------------------------------------------------------------------------------------

template <std::uint32_t kFeatures>
void renderPixel(const KernelContext& context, const TileTask& task, uvec2 pixel, float* sum,
                 KernelCounters& counters) {
    const RenderParams& params = context.params;
    const Sampler first = makeSampler(params, pixel.y * params.width + pixel.x, task.replicate, task.first);
    vec3 total(sum[0], sum[1], sum[2]);
    const bool descends = usesMis(params) && params.lightSelection == kSelectContribution;
    if (descends && usesLightTree(kFeatures, context.scene->globals.lightCount)) {
        tracePathsSideBySide<kFeatures>(context, pixel, first, task.count, total, counters);
    } else {
        tracePaths<kFeatures>(context, pixel, first, task.count, total, counters);
    }
    for (int c = 0; c < 3; ++c) sum[c] = total[c];
}

template <std::uint32_t kFeatures>
bool renderTile(const KernelContext& context, const TileTask& task, KernelCounters& counters) {
    for (std::uint32_t y = 0; y < task.height; ++y) {
        for (std::uint32_t x = 0; x < task.width; ++x) {
            if (task.cancel != nullptr && task.cancel->load(std::memory_order_relaxed)) return false;
            float* sum = task.sum + 3 * (y * task.stride + x);
            renderPixel<kFeatures>(context, task, uvec2(task.x + x, task.y + y), sum, counters);
        }
    }
    counters.camera += std::uint64_t{task.width} * task.height * task.count;
    return true;
}

// Not worth a specialisation: one first hit a sample.
void renderAovs(const KernelContext& context, const AovTask& task) {
    constexpr std::uint32_t kFeatures = kFeatureAll;
    const CpuScene& scene = *context.scene;
    for (std::uint32_t x = 0; x < context.params.width; ++x) {
        vec3 albedo(0.0f), normal(0.0f);
        float depth = 0.0f;
        std::uint32_t hits = 0;
        Sampler smp = makeSampler(context.params, task.y * context.params.width + x, 0u, 0u);
        for (; smp.index < task.count; ++smp.index) {
            const Ray ray =
                startPath(kFeatures, context.params, context.camera, smp, uvec2(x, task.y), randomPair(smp, kPairPixel))
                    .ray;
            const Hit hit = traceRay(scene, ray);
            if (hit.t < 0.0f) continue;
            const Surface surface = makeSurface(kFeatures, scene, ray, hit);
            const Material material = loadMaterial(scene, surface.material);
            albedo += texturedAlbedo(kFeatures, scene, material.albedo, material.texture, surface.position, surface.uv);
            normal += dot(ray.direction, surface.normal) < 0.0f ? surface.shading : -surface.shading;
            depth += hit.t;
            ++hits;
        }
        const float scale = 1.0f / static_cast<float>(task.count);
        for (std::uint32_t c = 0; c < 3; ++c) {
            const int i = static_cast<int>(c);
            if (task.albedo != nullptr) task.albedo[3 * x + c] = albedo[i] * scale;
            if (task.normal != nullptr) task.normal[3 * x + c] = normal[i] * scale;
        }
        if (task.depth != nullptr) task.depth[x] = hits > 0 ? depth / static_cast<float>(hits) : 0.0f;
    }
}

// What the kernels cover, from the leanest; the last covers everything.
constexpr std::uint32_t kBoxFeatures = kFeatureSpheres | kFeatureQuads | kFeatureLambertian | kFeatureMetal |
                                       kFeatureDielectric | kFeatureEmissive | kFeatureLights | kFeatureSphereLights |
                                       kFeatureQuadLights | kFeatureTargets;
constexpr std::uint32_t kSpheresFeatures = kFeatureSpheres | kFeatureLambertian | kFeatureMetal | kFeatureFuzz |
                                           kFeatureDielectric | kFeatureSky | kFeatureThinLens;
constexpr std::uint32_t kMeshFeatures = kBoxFeatures | kSpheresFeatures | kFeatureTriangles | kFeatureSmoothNormals |
                                        kFeatureTriangleLights | kFeatureManyLights | kFeatureProjected;

template <std::uint32_t kFeatures>
constexpr Kernel makeKernel(const char* name) {
    return {kFeatures, name, &renderTile<kFeatures>, &renderAovs};
}

constexpr Kernel kKernels[kKernelCount] = {
    makeKernel<kBoxFeatures>("box"),
    makeKernel<kBoxFeatures | kFeatureMixture | kFeatureProjected>("box+mixture+projected"),
    makeKernel<kSpheresFeatures>("spheres"),
    makeKernel<kMeshFeatures>("mesh"),
    makeKernel<kFeatureAll>("all"),
};

} // namespace
} // namespace rt::cpu
