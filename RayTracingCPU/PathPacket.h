// Paths on the CPU: sixteen make a packet and go from vertex to vertex together, and as soon as one ends
// the next takes its slot. An iteration takes every path through the stages of PathStep.h, one stage after the other
// for all of them: what is arithmetic in the lanes of vectors, what is fetched or traced slot by slot. Included by one
// translation unit per instruction set; all it defines has internal linkage.
#pragma once
#include "RayTracingCPU/AimedLanes.h"
#include "RayTracingCPU/ConnectionLanes.h"
#include "RayTracingCPU/EdgeLanes.h"
#include "RayTracingCPU/LightLanes.h"
#include "RayTracingCPU/SharedPaths.h"
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
    uint principled = 0u; // where the material is
    uint layered = 0u;    // of these, where there is more than diffuse and specular reflection
    uint aimed = 0u;      // where scattering may be aimed at a sphere
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

// completeVertex() for the principled vertices: in lanes as if there were diffuse and specular reflection only, then
// one by one where there is more.
template <Features kFeatures>
RT_CALL void completeVertices(const CpuScene& scene, uint principled, uint layered, PathLanes& lanes) {
    FloatLanes cosines;
    Vec3Lanes albedos{};
    for (uint i = 0u; i < kLanes; ++i) {
        const Vertex v = get(lanes.vertices, i);
        cosines.at[i] = clamp(dot(v.wo, v.shading), 0.0f, 1.0f);
    }
    eachLane(principled, [&](uint i) {
        set(albedos, i,
            directionalAlbedo(scene, cosines.at[i], lanesOf<&PrincipledValues::roughness>(lanes.values).at[i]));
    });
    for (uint i = 0u; i < kLanes; ++i) {
        const Vertex v = get(lanes.vertices, i);
        PrincipledValues values = get(lanes.values, i);
        values.others = 0u;
        const float cosine = cosines.at[i];
        set(lanes.lobes, i,
            makeLobes(kFeatures, scene, values, v.bsdf.albedo, cosine, get(albedos, i), vec3(0.0f), cosine,
                      v.front != 0u));
    }
    eachLane(layered, [&](uint i) {
        Vertex v = get(lanes.vertices, i);
        v.values = get(lanes.values, i);
        if (has(kFeatures, kRareFeatures)) v.values.rare = get(lanes.rareValues, i);
        if (has(kFeatures, kFeatureCoatNormal)) v.bsdf.lobes.coatNormal = get(lanes.coatNormals, i);
        completeVertex(kFeatures, scene, v);
        set(lanes.lobes, i, v.bsdf.lobes);
        if (has(kFeatures, kRareFeatures)) set(lanes.rareLobes, i, v.bsdf.lobes.rare);
    });
}

// Proposals for all vertices as if there were diffuse and specular reflection only, in the frame of the normal.
template <Features kFeatures>
RT_CALL void proposeReflections(PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        const Vertex v = vertexIn<kFeatures>(lanes, i);
        const PrincipledLobes& lobes = v.bsdf.lobes;
        const vec3 wo = toLocal(makeFrame(v.shading), v.wo);
        vec2 u = get(lanes.u, i).bsdf;
        const bool isChosen = u.x < (wo.z > 0.0f ? lobes.diffuseShare + lobes.specularShare : 0.0f);
        u.x = isChosen ? u.x : -1.0f; // what is absorbed counts as diffuse, as it is no mirror
        BsdfSample s = proposeReflection(lobes, wo, u);
        s.wi = select(isChosen, s.wi, vec3(0.0f));
        set(lanes.principled, i, s);
    }
}

// Proposals of vertices with other lobes, one by one; what is transmitted, and by lobes that the loops do not know, is
// weighed at once.
template <Features kFeatures>
RT_CALL void proposeLayers(uint layered, PathLanes& lanes) {
    eachLane(layered, [&](uint i) {
        const Vertex v = vertexIn<kFeatures>(lanes, i);
        const vec3 wo = toLocal(makeFrame(v.shading), v.wo);
        BsdfSample s = absorbed();
        if (wo.z > 0.0f) s = proposePrincipled(kFeatures, v.bsdf, wo, get(lanes.u, i).bsdf);
        if (s.transmitted != 0u || (has(kFeatures, kRareFeatures) && hasLobe(v.bsdf.lobes.others, kLobesRare)))
            weighProposal(evalProposal(kFeatures, v.bsdf, wo, s), s);
        set(lanes.principled, i, s);
    });
}

// Weighs the proposals of lobes that are among kOthers, and takes all to the world.
template <Features kFeatures, uint kOthers>
RT_CALL void weighProposals(PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        Vertex v = vertexIn<kFeatures>(lanes, i);
        const uint weighed = has(kFeatures, kRareFeatures) ? v.bsdf.lobes.others & kLobesRare : 0u;
        v.bsdf.lobes.others = kOthers;
        const Frame frame = makeFrame(v.shading);
        BsdfSample s = get(lanes.principled, i);
        vec4 f = evalPrincipledReflection(kFeatures, v.bsdf.lobes, toLocal(frame, v.wo), s.wi);
        if (hasLobe(kOthers, kLobeGlass)) f.w = (s.transmitted | weighed) == 0u ? f.w : 0.0f;
        weighProposal(f, s);
        s.wi = normalize(toWorld(frame, s.wi));
        set(lanes.principled, i, s);
    }
}

// samplePrincipled() for all vertices, in lanes but for proposals of lobes that few materials have.
template <Features kFeatures>
RT_FN void samplePrincipled(uint layered, PathLanes& lanes) {
    proposeReflections<kFeatures>(lanes);
    if (layered == 0u) {
        weighProposals<kFeatures, 0u>(lanes);
    } else {
        proposeLayers<kFeatures>(layered, lanes);
        weighProposals<kFeatures, kLobesLayered>(lanes);
    }
}

template <Features kFeatures>
RT_FN BsdfSample sampleScattering(const PathLanes& lanes, uint i, const Vertex& v) {
    const bool inMedium = has(kFeatures, kFeatureVolumes) && v.inMedium != 0u;
    if (!inMedium && isPrincipled(kFeatures, v.bsdf)) return get(lanes.principled, i);
    if (inMedium || !isLambertian(kFeatures, v.bsdf)) return sampleScattering(kFeatures, v, get(lanes.u, i).bsdf);
    return diffuseSample(lanes, i);
}

template <Features kFeatures>
class PathPacket {
  public:
    // radiances: of the tasks' samples, in the order of TileSamples.
    PathPacket(const KernelContext& context, std::span<const TileTask> tasks, const std::atomic<bool>* cancel,
               vec3* radiances, KernelCounters& counters)
        : context_(context),
          scene_(*context.scene),
          params_(context.params),
          cancel_(cancel),
          tasks_(tasks),
          samples_(context, tasks),
          radiances_(radiances),
          counters_(counters),
          shared_(context),
          connections_(scene_, params_, counters),
          edgeRays_(context) {}

    // Traces the paths of all samples. False: cancelled.
    bool trace() {
        for (;;) {
            if (cancel_ != nullptr && cancel_->load(std::memory_order_relaxed)) return false;
            ActiveSlots active = shadeHits();
            if (active.arrived == 0u) break;
            drawVertexSamples<kFeatures>(active.lit != 0u, lanes_);
            if (active.lit != 0u) sampleLights(active.lit);
            if constexpr (kConnects) connectLights(active.lit);
            if (active.principled != active.arrived) sampleDiffuse(lanes_);
            if (aimsPaths(kFeatures, params_)) active.aimed = aimScatterings();
            if (has(kFeatures, kFeaturePrincipled) && active.principled != 0u)
                samplePrincipled<kFeatures>(active.layered, lanes_);
            // No lambda: compilers would call what is in it.
            for (uint rest = active.arrived; rest != 0u; rest &= rest - 1u)
                continuePath(accel::lowestBit(rest), active);
        }
        if constexpr (kConnects) addConnections();
        if constexpr (kReuses) shared_.finish(tasks_, radiances_, counters_);
        edgeRays_.finish(radiances_, counters_);
        return true;
    }

  private:
    static constexpr bool kConnects = (kFeatures & kMethodConnections) != kFeatureNone;
    static constexpr bool kReuses = (kFeatures & kMethodReuse) != kFeatureNone;

    // Takes every path to its next vertex: one that ends on the way makes room for the next sample's.
    ActiveSlots shadeHits() {
        ActiveSlots active;
        for (uint i = 0u; i < kLanes; ++i) {
            PathSlot& slot = slots_[i];
            Vertex v;
            for (;;) {
                if (slot.sample == kNone && !begin(slot, i)) break;
                const Sampler smp = get(lanes_.samplers, i);
                if (shadeNext(slot, smp, get(lanes_.hits, i), v)) break;
                end(slot);
            }
            if (slot.sample == kNone) continue;
            keepVertex<kFeatures>(lanes_, i, v);
            active.arrived |= 1u << i;
            active.lit |= uint(choosesLight(v, slot.path)) << i;
            const bool principled = isPrincipled(kFeatures, v.bsdf);
            active.principled |= uint(principled) << i;
            active.layered |= uint(principled && v.values.others != 0u) << i;
        }
        if (active.principled != 0u) completeVertices<kFeatures>(scene_, active.principled, active.layered, lanes_);
        return active;
    }

    // False: the path has ended.
    RT_METHOD_FN bool shadeNext(PathSlot& slot, const Sampler& smp, const Hit& hit, Vertex& v) {
        const uint before = slot.path.reuse;
        TechniqueStep step;
        if (!shadeHit(kFeatures, scene_, params_, smp, hit, slot.path, step, v)) return false;
        if constexpr (kReuses)
            shared_.arrived(slot.sample, before, slot.path, step.part.prefix, v, radiances_[slot.sample]);
        return true;
    }

    // False: there is no sample left.
    RT_METHOD_FN bool begin(PathSlot& slot, uint i) {
        Ray ray;
        uvec2 pixel;
        slot.sample = samples_.template next<kFeatures>(lanes_, i, ray, pixel);
        if (slot.sample == kNone) return false;
        slot.path = startPath(ray);
        const uint packed = context_.edgePart(pixel.y * params_.width + pixel.x);
        if (packed != 0u && edgeRays_.add(pixel, pixelPart(packed), get(lanes_.samplers, i), slot.sample))
            slot.path.emission = kEmissionApart;
        return true;
    }

    void end(PathSlot& slot) {
        if (isCutOff(params_, slot.path))
            counters_.cutOff += cutOffThroughput(slot.path, shared_.throughputBefore(slot.sample, slot.path));
        if constexpr (kReuses)
            shared_.ended(slot.sample, slot.path, radiances_[slot.sample]);
        else
            radiances_[slot.sample] = slot.path.radiance;
        counters_.scattered += min(slot.path.vertex, params_.maxDepth) - 1u;
        slot.sample = kNone;
    }

    RT_METHOD_FN bool choosesLight(const Vertex& v, const PathState& path) const {
        return samplesLight(kFeatures, params_, scene_.globals, v, path) ||
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

    // Aims what the first vertices of paths that are shared scatter; the paths of which a share is aimed.
    uint aimScatterings() {
        uint first = 0u;
        for (uint i = 0u; i < kLanes; ++i)
            first |= uint(slots_[i].sample != kNone && slots_[i].path.reuse == kReuseFirst) << i;
        if (first == 0u || !findAimedShares(scene_.globals.aimed, first, lanes_)) return 0u;
        aimScattering(scene_.globals.aimed, lanes_);
        return first;
    }

    // Attempts connections of the paths `lit`.
    void connectLights(uint lit) {
        if (lit == 0u || params_.connectedSpheres == 0u) return;
        FloatLanes rates;
        connections_.attempt(lit, lanes_, rates, [&](uint i) {
            const bool isShared = slots_[i].path.reuse == kReuseSuffix;
            return slots_[i].sample + (isShared ? kBatchSamples : 0u);
        });
        eachLane(lit, [&](uint i) { slots_[i].path.chain.rate = rates.at[i]; });
    }

    void addConnections() {
        if (params_.connectedSpheres == 0u) return;
        connections_.finish();
        for (uint i = 0u; i < samples_.count(); ++i) {
            radiances_[i] += connections_.radiance(i);
            if constexpr (kReuses) shared_.add(i, connections_.radiance(i + kBatchSamples));
        }
    }

    // Scatters the path of slot i at its vertex and traces its next ray, together with the shadow ray if a light was
    // sampled.
    RT_METHOD_FN void continuePath(uint i, const ActiveSlots& active) {
        const bool isLit = (active.lit >> i & 1u) != 0u;
        PathSlot& slot = slots_[i];
        PathState& path = slot.path;
        const Vertex v = vertexIn<kFeatures>(lanes_, i);
        const VertexSamples u = get(lanes_.u, i);
        const bool isSampled = isLit && samplesLights(kFeatures, params_);
        const DirectLight direct = isSampled ? get(lanes_.direct, i) : noDirectLight();
        addUnshadowed(direct, path);
        BsdfSample b = sampleScattering<kFeatures>(lanes_, i, v);
        if (isLit && usesMixture(kFeatures, params_, scene_.globals, v)) {
            const LightChoice choice = get(lanes_.choices, i);
            b = sampleMixture(kFeatures, scene_, params_, choice, v, u, b, path.ray.time, path.last);
        }
        if (aimsPaths(kFeatures, params_) && (active.aimed >> i & 1u) != 0u) {
            shared_.aimed(slot.sample, lanes_.aimedShare.at[i]);
            b = get(lanes_.aimed, i);
        }
        if (has(kFeatures, kMethodConnections)) continueChain(v, b, path);
        if (shared::continuePath(kFeatures, params_, v, b, u.roulette.x, path)) {
            set(lanes_.hits, i, traceOn(i, direct, path));
        } else {
            traceShadow(i, direct, path);
            end(slot);
        }
    }

    // Adds what the shadow ray of a path that has ended lets through.
    RT_METHOD_FN void traceShadow(uint i, const DirectLight& direct, PathState& path) {
        if (!(direct.distance > 0.0f)) return;
        ++counters_.shadow;
        if (arrives<kFeatures>(scene_, get(lanes_.samplers, i), path, direct))
            addDirectLight(kFeatures, scene_, direct, path);
    }

    // What the next ray hits; adds what the shadow ray, if there is one, lets through.
    RT_METHOD_FN Hit traceOn(uint i, const DirectLight& direct, PathState& path) {
        // What is transmitted starts on the other side of the surface than the shadow ray.
        const bool startsElsewhere = has(kFeatures, kFeaturePrincipled) && path.ray.origin != path.last.position;
        if (has(kFeatures, kFeatureOpacity) || startsElsewhere || !(direct.distance > 0.0f)) {
            traceShadow(i, direct, path);
            return traceRay(kFeatures, scene_, get(lanes_.samplers, i), 2u * path.vertex, path.ray);
        }
        ++counters_.shadow;
        bool isOccluded;
        const Hit hit = scene_.tracer.both(scene_.accel, path.ray, direct.direction, direct.distance, isOccluded);
        if (!isOccluded) addDirectLight(kFeatures, scene_, direct, path);
        return hit;
    }

    const KernelContext& context_;
    const CpuScene& scene_;
    const RenderParams& params_;
    const std::atomic<bool>* cancel_;
    std::span<const TileTask> tasks_;
    TileSamples samples_;
    vec3* radiances_;
    KernelCounters& counters_;
    PathSlot slots_[kLanes]{};
    PathLanes lanes_{};
    SharedPaths<kFeatures> shared_;
    Connections<kFeatures> connections_;
    EdgeRays<kFeatures> edgeRays_;
};

} // namespace
} // namespace rt::cpu
