// Camera rays split at edges of lights, sixteen at a time. Included by one translation unit per instruction set; all it
// defines has internal linkage.
#pragma once
#include "Common/Shared/Technique/EdgeRays.h"
#include "RayTracingCPU/SampleLanes.h"
#include "RayTracingCPU/ShadowRay.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// The edge rays of a kernel's samples.
template <Features kFeatures>
class EdgeRays {
  public:
    explicit EdgeRays(const KernelContext& context) : context_(context) {}

    // Adds the edge rays of a sample in this part of a pixel, and tells whether its own camera ray is there. Up to
    // fifteen rays wait until there are sixteen.
    bool add(const uvec2& pixel, const PixelPart& part, const Sampler& smp, uint sample) {
        entries_[count_] = {sample, vec3(0.0f)};
        for (uint i = 0u; i < context_.params.edgeRays; ++i) {
            set(samplers_, waiting_, edgeSampler(context_.params, smp, i));
            pixels_[waiting_] = pixel;
            parts_[waiting_] = part;
            entryOf_[waiting_] = count_;
            if (++waiting_ == kLanes) traceWaiting();
        }
        ++count_;
        return isInPart(part, cameraSamples(kFeatures, smp).pixel);
    }

    // Adds what they bring to the radiances of the samples.
    void finish(vec3* radiances, KernelCounters& counters) {
        if (waiting_ > 0u) traceWaiting();
        for (uint i = 0u; i < count_; ++i) radiances[entries_[i].sample] += entries_[i].radiance;
        counters.edge += std::uint64_t{count_} * context_.params.edgeRays;
        counters.scattered += scattered_;
        counters.shadow += shadow_;
    }

  private:
    struct Entry {
        uint sample;
        vec3 radiance;
    };

    void traceWaiting() {
        const RenderParams params = context_.params; // of this function, so that no lane could overlap them
        const Camera camera = context_.camera;
        for (uint i = waiting_; i < kLanes; ++i) set(samplers_, i, get(samplers_, 0u));
        RecordLanes<CameraSamples> u;
        drawCameraSamples(kFeatures, samplers_, u);
        for (uint i = 0u; i < waiting_; ++i) {
            CameraSamples inPart = get(u, i);
            const CameraRole role = roleInPart(params, parts_[i], true, inPart.pixel);
            const Ray ray = cameraRay(kFeatures, params, camera, pixels_[i], inPart);
            entries_[entryOf_[i]].radiance += trace(get(samplers_, i), startInRole(ray, role));
        }
        waiting_ = 0u;
    }

    // What the path of an edge ray brings.
    vec3 trace(const Sampler& smp, PathState path) {
        const CpuScene& scene = *context_.scene;
        const RenderParams& params = context_.params;
        for (;;) {
            const Hit hit = traceRay(kFeatures, scene, smp, 2u * path.vertex, path.ray);
            TechniqueStep unused;
            Vertex v;
            if (!shadeHit(kFeatures, scene, params, smp, hit, path, unused, v)) break;
            const VertexSamples u = vertexSamples(kFeatures, smp, v.index);
            const DirectLight direct =
                splitsGlossyHit(kFeatures, params, v) ? sampleReflected(v, u, path) : noDirectLight();
            addUnshadowed(direct, path);
            const BsdfSample b = sampleScattering(kFeatures, v, u.bsdf);
            const bool goesOn = continuePath(kFeatures, params, v, b, u.roulette.x, path);
            if (direct.distance > 0.0f) {
                ++shadow_;
                if (arrives<kFeatures>(scene, smp, path, direct)) addDirectLight(kFeatures, scene, direct, path);
            }
            if (!goesOn) break;
            ++scattered_;
        }
        return path.radiance;
    }

    // A sample of the light that a glossy mirror reflects.
    DirectLight sampleReflected(const Vertex& v, const VertexSamples& u, PathState& path) {
        const CpuScene& scene = *context_.scene;
        const RenderParams& params = context_.params;
        const vec2 selection = selectionSample(kFeatures, scene.globals, u);
        const LightChoice choice =
            chooseLight(kFeatures, scene, params.lightSelection, scene.globals.lightCount, selection, path.last);
        return sampleDirectLight(kFeatures, scene, params, choice, v, u, path);
    }

    const KernelContext& context_;
    uint count_ = 0u;   // samples
    uint waiting_ = 0u; // rays
    std::uint64_t scattered_ = 0u;
    std::uint64_t shadow_ = 0u;
    RecordLanes<Sampler> samplers_;
    uvec2 pixels_[kLanes];
    PixelPart parts_[kLanes];
    uint entryOf_[kLanes];
    Entry entries_[kBatchSamples];
};

} // namespace
} // namespace rt::cpu
