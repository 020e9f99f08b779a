// The loops around paths on the CPU: tiles, pixels, samples; and the kernels. Included by one translation unit per
// instruction set; all it defines has internal linkage.
#pragma once
#include "Common/Image/Film.h"
#include "Common/Shared/Path/SeenSurfaces.h"
#include "RayTracingCPU/PathPacket.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// ---- tiles ---------------------------------------------------------------------------------------------------------

// Takes the first of the radiances. A sample that is not a number is dropped and counted, and stays in the divisor.
void addRadiances(const TileTask& task, const vec3*& radiances, KernelCounters& counters) {
    for (std::uint32_t y = 0; y < task.height; ++y) {
        for (std::uint32_t x = 0; x < task.width; ++x) {
            const std::uint32_t pixel = 3 * (y * task.stride + x);
            float* sum = task.sum + pixel;
            vec3 total(sum[0], sum[1], sum[2]);
            vec3 squares(0.0f);
            const std::uint32_t count = task.samplesOf(x, y);
            for (std::uint32_t i = 0; i < count; ++i, ++radiances) {
                if (isFinite(*radiances)) {
                    total += *radiances;
                    squares += *radiances * *radiances;
                } else {
                    ++counters.nonfinite;
                }
            }
            for (int c = 0; c < 3; ++c) {
                sum[c] = total[c];
                if (task.squares != nullptr) task.squares[pixel + static_cast<std::uint32_t>(c)] += squares[c];
            }
            counters.camera += count;
        }
    }
}

template <Features kFeatures>
bool renderTiles(const KernelContext& context, std::span<const TileTask> tasks, const std::atomic<bool>* cancel,
                 KernelCounters& counters) {
    vec3 radiances[kBatchSamples];
    if (!PathPacket<kFeatures>(context, tasks, cancel, radiances, counters).trace()) return false;
    const vec3* next = radiances;
    for (const TileTask& task : tasks) addRadiances(task, next, counters);
    return true;
}

// Writes one of the row's planes, unless it is not wanted.
inline void keepFeature(float* plane, std::uint32_t x, vec3 value) {
    if (plane == nullptr) return;
    for (int c = 0; c < 3; ++c) plane[3 * x + static_cast<std::uint32_t>(c)] = value[c];
}
inline void keepFeatures(const SurfacePlanes& planes, std::uint32_t x, const SurfaceSums& sums, float scale) {
    keepFeature(planes.albedo, x, sums.albedo * scale);
    keepFeature(planes.normal, x, sums.normal * scale);
    if (planes.depth != nullptr) planes.depth[x] = meanDepth(sums);
}

// What one sample of a pixel sees, whose camera ray is given.
SeenSurfaces seenBy(const KernelContext& context, const AovTask& task, const Ray& ray, const Sampler& smp) {
    const Features features = task.features;
    const CpuScene& scene = *context.scene;
    const bool looksThrough = task.wide.isWanted() || task.emission != nullptr;
    SeenSurfaces seen = nothingSeen();
    PathState path = startPath(ray);
    float length = 0;
    while (seeSurface(features, scene, context.params, smp, traceRay(features, scene, smp, 2u * path.vertex, path.ray),
                      looksThrough, path, length, seen)) {
    }
    seen.emission += path.radiance;
    return seen;
}

// Calls see(x, what it sees) for samples.x to samples.y - 1 of the pixels columns.x to columns.y - 1 of the task's row,
// at most kSeenTogether of them.
template <class See>
void seeSamples(const KernelContext& context, const AovTask& task, uvec2 columns, uvec2 samples, const See& see) {
    const uint inPixel = samples.y - samples.x, count = (columns.y - columns.x) * inPixel;
    Sampler firsts[kSeenTogether];
    for (uint x = columns.x; x < columns.y; ++x)
        firsts[x - columns.x] =
            makeSampler(context.params, task.y * context.params.width + x, kFeatureReplicate, samples.x);
    RecordLanes<Sampler> samplers;
    RecordLanes<CameraSamples> u{};
    for (uint next = 0u; next < count; next += kLanes) {
        for (uint i = 0u; i < kLanes; ++i) {
            const uint sample = min(next + i, count - 1u);
            Sampler s = firsts[sample / inPixel];
            s.index += sample % inPixel;
            set(samplers, i, s);
        }
        drawCameraSamples(task.features, samplers, u);
        for (uint i = 0u; i < min(kLanes, count - next); ++i) {
            const uint x = columns.x + (next + i) / inPixel;
            const Ray ray = cameraRay(task.features, context.params, context.camera, uvec2(x, task.y), get(u, i));
            see(x, seenBy(context, task, ray, get(samplers, i)));
        }
    }
}

// Not worth a specialisation: one first hit a sample, or few more.
void renderAovs(const KernelContext& context, const AovTask& task) {
    const std::uint32_t width = context.params.width;
    const std::uint32_t first = task.isAdaptive ? std::min(kFirstSeenSamples, task.count) : task.count;
    for (std::uint32_t begin = 0; begin < width; begin += kSeenTogether) {
        const std::uint32_t end = std::min(begin + kSeenTogether, width);
        SeenSurfaces sums[kSeenTogether];
        SurfaceRange range = emptyRange();
        for (SeenSurfaces& sum : sums) sum = nothingSeen();
        const auto add = [&](std::uint32_t x, const SeenSurfaces& seen) { addSeen(seen, sums[x - begin]); };
        const auto addFirst = [&](std::uint32_t x, const SeenSurfaces& seen) {
            extendRange(seen.first, range);
            add(x, seen);
        };
        seeSamples(context, task, {begin, end}, {0u, first}, addFirst);
        const std::uint32_t count = isNarrow(range) ? first : task.count;
        if (count > first) seeSamples(context, task, {begin, end}, {first, count}, add);
        const float scale = 1.0f / static_cast<float>(count);
        for (std::uint32_t x = begin; x < end; ++x) {
            keepFeatures(task.first, x, sums[x - begin].first, scale);
            keepFeatures(task.wide, x, sums[x - begin].wide, scale);
            keepFeature(task.emission, x, sums[x - begin].emission * scale);
        }
    }
}

// What the kernels cover, from the leanest; the last covers everything, the one before all but what the books lack.
constexpr Features kBoxFeatures = kFeatureSpheres | kFeatureQuads | kFeatureLambertian | kFeatureMetal |
                                  kFeatureDielectric | kFeatureEmissive | kFeatureLights | kFeatureSphereLights |
                                  kFeatureQuadLights | kMethodReuse | kMethodAiming | kMethodEdgeRays;
constexpr Features kSpheresFeatures = kFeatureSpheres | kFeatureLambertian | kFeatureMetal | kFeatureFuzz |
                                      kFeatureDielectric | kFeatureSky | kFeatureThinLens;
constexpr Features kMeshFeatures = kBoxFeatures | kSpheresFeatures | kFeatureTriangles | kFeatureSmoothNormals |
                                   kFeatureTriangleLights | kFeatureManyLights | kMethodProjected;

constexpr Features kAssetFeatures = kMeshFeatures | kFeatureInstances | kFeaturePrincipled | kFeatureVertexAttributes |
                                    kFeatureImages | kFeatureSkyImage | kFeaturePunctualLights;
constexpr Features kBookFeatures =
    kFeatureAll & ~(kFeaturePrincipled | kFeatureVertexAttributes | kFeatureOpacity | kFeatureCoatNormal |
                    kRareFeatures | kFeaturePunctualLights | kRoundFeatures | kRoundLightFeatures);

template <Features kFeatures>
constexpr Kernel makeKernel(const char* name) {
    return {kFeatures, name, &renderTiles<kFeatures>, &renderAovs};
}

constexpr Kernel kKernels[kKernelCount] = {
    makeKernel<kBoxFeatures>("box"),
    makeKernel<kBoxFeatures | kMethodMixture | kMethodProjected>("box+mixture+projected"),
    makeKernel<kBoxFeatures | kMethodConnections>("box+connections"),
    makeKernel<kSpheresFeatures>("spheres"),
    makeKernel<kMeshFeatures>("mesh"),
    makeKernel<kAssetFeatures>("assets"),
    makeKernel<kBookFeatures>("books"),
    makeKernel<kFeatureAll>("all"),
};

} // namespace
} // namespace rt::cpu
