// Paths on the CPU: sixteen make a packet and go from vertex to vertex together, and as soon as one ends
// the next takes its slot. An iteration takes every path through the stages of PathStep.h, one stage after the other
// for all of them: what is arithmetic in the lanes of vectors, what is fetched or traced slot by slot. Included by one
// translation unit per instruction set; all it defines has internal linkage.
#pragma once
#include "RayTracingCPU/ConnectionLanes.h"
#include "RayTracingCPU/LightLanes.h"
#include "RayTracingCPU/TileSamples.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// A path under way.
struct PathSlot {
    PathState path;
    uint sample = kNone; // of TileSamples; kNone: there is no path
};

// Which of the slots an iteration has to do with, a bit a slot.
struct ActiveSlots {
    uint arrived = 0u;    // at a vertex
    uint lit = 0u;        // of these, where a light is chosen
    uint connected = 0u;  // of these, where a light is connected to through a sphere
    uint principled = 0u; // where the material is
};

// Where all vertices would scatter if they were Lambertian.
RT_CALL void sampleDiffuse(PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        const Vertex v = get(lanes.vertices, i);
        const BsdfSample b = sampleLambertian(v.bsdf.albedo, v.shading, get(lanes.u, i).bsdf);
        set(lanes.diffuse, i, b.wi);
        lanes.diffusePdf.at[i] = b.pdf;
    }
}

// Where the principled vertices would scatter: proposals one by one, evaluated in lanes.
template <uint kFeatures>
RT_CALL void proposeDirections(uint principled, PathLanes& lanes) {
    eachLane(principled, [&](uint i) {
        const Vertex v = vertexIn<kFeatures>(lanes, i);
        const vec3 wo = toLocal(makeFrame(v.shading), v.wo);
        set(lanes.proposals, i,
            wo.z > 0.0f ? proposePrincipled(kFeatures, v.bsdf, wo, get(lanes.u, i).bsdf) : absorbed());
    });
    for (uint i = 0u; i < kLanes; ++i) {
        const Vertex v = vertexIn<kFeatures>(lanes, i);
        const vec3 wo = toLocal(makeFrame(v.shading), v.wo);
        const vec3 wi = get(lanesOf<&BsdfSample::wi>(lanes.proposals), i);
        const vec4 f = evalPrincipledReflection(kFeatures, v.bsdf.lobes, wo, wi);
        set(lanes.proposedValues, i, vec3(f));
        lanes.proposedPdfs.at[i] = f.w;
    }
}

// samplePrincipled() of what proposeDirections() has begun.
template <uint kFeatures>
RT_FN BsdfSample finishProposal(const PathLanes& lanes, uint i, const Vertex& v) {
    const Frame frame = makeFrame(v.shading);
    BsdfSample b = get(lanes.proposals, i);
    weighProposal(b.transmitted == 0u ? vec4(get(lanes.proposedValues, i), lanes.proposedPdfs.at[i])
                                      : evalProposal(kFeatures, v.bsdf, toLocal(frame, v.wo), b),
                  b);
    b.wi = normalize(toWorld(frame, b.wi));
    return b;
}

template <uint kFeatures>
RT_FN BsdfSample sampleScattering(const PathLanes& lanes, uint i, const Vertex& v) {
    const bool inMedium = has(kFeatures, kFeatureVolumes) && v.inMedium != 0u;
    if (!inMedium && isPrincipled(kFeatures, v.bsdf)) return finishProposal<kFeatures>(lanes, i, v);
    if (inMedium || !isLambertian(kFeatures, v.bsdf)) return sampleScattering(kFeatures, v, get(lanes.u, i).bsdf);
    BsdfSample b = absorbed();
    b.wi = get(lanes.diffuse, i);
    b.weight = v.bsdf.albedo;
    b.pdf = lanes.diffusePdf.at[i];
    return b;
}

template <uint kFeatures>
class PathPacket {
  public:
    // radiances: of the tasks' samples, in the order of TileSamples.
    PathPacket(const KernelContext& context, std::span<const TileTask> tasks, const std::atomic<bool>* cancel,
               vec3* radiances, KernelCounters& counters)
        : scene_(*context.scene),
          params_(context.params),
          cancel_(cancel),
          samples_(context, tasks),
          radiances_(radiances),
          counters_(counters) {}

    // Traces the paths of all samples. False: cancelled.
    bool trace() {
        for (;;) {
            if (cancel_ != nullptr && cancel_->load(std::memory_order_relaxed)) return false;
            ActiveSlots active = arriveAll();
            if (active.arrived == 0u) return true;
            drawVertexSamples<kFeatures>(active.lit != 0u, lanes_);
            if (active.lit != 0u) sampleLights(active.lit);
            if (has(kFeatures, kFeatureConnections) && active.lit != 0u && params_.connectedSpheres != 0u)
                active.connected = connectLights(active.lit);
            if (active.principled != active.arrived) sampleDiffuse(lanes_);
            if (has(kFeatures, kFeaturePrincipled) && active.principled != 0u)
                proposeDirections<kFeatures>(active.principled, lanes_);
            eachLane(active.arrived, [&](uint i) { goOnFrom(i, active); });
        }
    }

  private:
    // Takes every path to its next vertex: one that ends on the way makes room for the next sample's.
    ActiveSlots arriveAll() {
        ActiveSlots active;
        for (uint i = 0u; i < kLanes; ++i) {
            PathSlot& slot = slots_[i];
            Vertex v;
            for (;;) {
                if (slot.sample == kNone && !begin(slot, i)) break;
                const Sampler smp = get(lanes_.samplers, i);
                if (arrive(kFeatures, scene_, params_, smp, get(lanes_.hits, i), slot.path, v)) break;
                end(slot);
            }
            if (slot.sample == kNone) continue;
            keepVertex<kFeatures>(lanes_, i, v);
            active.arrived |= 1u << i;
            active.lit |= uint(choosesLight(v)) << i;
            active.principled |= uint(isPrincipled(kFeatures, v.bsdf)) << i;
        }
        return active;
    }

    // False: there is no sample left.
    bool begin(PathSlot& slot, uint i) {
        Ray ray;
        slot.sample = samples_.template next<kFeatures>(lanes_, i, ray);
        if (slot.sample == kNone) return false;
        slot.path = startPath(ray);
        return true;
    }

    void end(PathSlot& slot) {
        radiances_[slot.sample] = slot.path.radiance;
        counters_.scattered += slot.path.vertex - 1u;
        slot.sample = kNone;
    }

    bool choosesLight(const Vertex& v) const {
        return usesNextEventEstimation(kFeatures, params_, scene_.globals, v) ||
               usesMixture(kFeatures, params_, scene_.globals, v);
    }

    // Chooses a light for the paths `lit`, and samples it unless that is left to the mixture.
    void sampleLights(uint lit) {
        chooseLights<kFeatures>(scene_, params_, lit, lanes_);
        eachLane(lit, [&](uint i) {
            PathState& path = slots_[i].path;
            path.last.total = lanes_.total.at[i];
            set(lanes_.throughput, i, path.throughput);
            lanes_.time.at[i] = path.ray.time;
        });
        if (samplesLights(kFeatures, params_)) sampleDirectLights<kFeatures>(scene_, params_, lit, lanes_);
    }

    // Connects the paths `lit`, and returns those that are connected: passages_.
    uint connectLights(uint lit) {
        FloatLanes rates;
        const uint connected = rt::cpu::connectLights<kFeatures>(scene_, params_, lit, lanes_, rates, passages_);
        eachLane(lit, [&](uint i) { slots_[i].path.chain.rate = rates.at[i]; });
        return connected;
    }

    // Adds the passage of slot i if its segments are free.
    void tracePassage(uint i) {
        Passage& passage = passages_[i];
        PathState& path = slots_[i].path;
        while (passage.segments != 0u) {
            ++counters_.shadow;
            float tMax;
            const Ray ray = passageRay(passage, path.ray.time, tMax);
            endSegment(kFeatures, scene_, !isOccluded(scene_, ray, tMax), ray, tMax, passage, path);
        }
    }

    // Scatters the path of slot i at its vertex and traces its next ray, together with the shadow ray if a light was
    // sampled.
    void goOnFrom(uint i, const ActiveSlots& active) {
        const bool isLit = (active.lit >> i & 1u) != 0u;
        PathSlot& slot = slots_[i];
        PathState& path = slot.path;
        const Vertex v = vertexIn<kFeatures>(lanes_, i);
        const VertexSamples u = get(lanes_.u, i);
        const bool isSampled = isLit && samplesLights(kFeatures, params_);
        const DirectLight direct = isSampled ? get(lanes_.direct, i) : noDirectLight();
        addUnshadowed(direct, path);
        if (has(kFeatures, kFeatureConnections) && (active.connected >> i & 1u) != 0u) tracePassage(i);
        BsdfSample b = sampleScattering<kFeatures>(lanes_, i, v);
        if (isLit && usesMixture(kFeatures, params_, scene_.globals, v)) {
            const LightChoice choice = get(lanes_.choices, i);
            b = sampleMixture(kFeatures, scene_, params_, choice, v, u, b, path.ray.time, path.last);
        }
        if (has(kFeatures, kFeatureConnections)) goOnChain(v, b, path);
        if (goOn(params_, v, b, u.roulette.x, path)) {
            set(lanes_.hits, i, traceOn(i, direct, path));
        } else {
            traceShadow(i, direct, path);
            end(slot);
        }
    }

    // Adds what the shadow ray of a path that has ended lets through.
    void traceShadow(uint i, const DirectLight& direct, PathState& path) {
        if (!(direct.distance > 0.0f)) return;
        ++counters_.shadow;
        const Ray ray = shadowRay(path, direct);
        bool isFree;
        if (has(kFeatures, kFeatureOpacity)) {
            const Sampler smp = get(lanes_.samplers, i);
            isFree = traceRay<kFeatures>(scene_, smp, 2u * path.vertex + 1u, ray, direct.distance).t < 0.0f;
        } else {
            isFree = !isOccluded(scene_, ray, direct.distance);
        }
        if (isFree) addDirectLight(kFeatures, scene_, direct, path);
    }

    // What the next ray hits; adds what the shadow ray, if there is one, lets through.
    Hit traceOn(uint i, const DirectLight& direct, PathState& path) {
        // What is transmitted starts on the other side of the surface than the shadow ray.
        const bool startsElsewhere = has(kFeatures, kFeaturePrincipled) && path.ray.origin != path.last.position;
        if (has(kFeatures, kFeatureOpacity) || startsElsewhere || !(direct.distance > 0.0f)) {
            traceShadow(i, direct, path);
            return traceRay<kFeatures>(scene_, get(lanes_.samplers, i), 2u * path.vertex, path.ray);
        }
        ++counters_.shadow;
        bool isOccluded;
        const Hit hit = scene_.tracer.both(scene_.accel, path.ray, direct.direction, direct.distance, isOccluded);
        if (!isOccluded) addDirectLight(kFeatures, scene_, direct, path);
        return hit;
    }

    const CpuScene& scene_;
    const RenderParams& params_;
    const std::atomic<bool>* cancel_;
    TileSamples samples_;
    vec3* radiances_;
    KernelCounters& counters_;
    PathSlot slots_[kLanes]{};
    PathLanes lanes_{};
    Passage passages_[kLanes]; // of the paths that are connected
};

} // namespace
} // namespace rt::cpu
