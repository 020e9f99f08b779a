// Paths on the CPU: sixteen of a tile's make a packet and go from vertex to vertex together, and as soon as one ends
// the next takes its slot. An iteration takes every path through the stages of PathStep.h, one stage after the other
// for all of them: what is arithmetic in the lanes of vectors, what is fetched or traced slot by slot. Included by one
// translation unit per instruction set; all it defines has internal linkage.
#pragma once
#include "RayTracingCPU/LightLanes.h"
#include "RayTracingCPU/TileSamples.h"
#include "Common/Shared/Path/Connection.h"
extern long gSolved, gTraced, gArrived;

namespace rt::cpu {
namespace {

using namespace rt::shared;

// A path under way.
struct PathSlot {
    PathState path;
    uint sample = kNone; // of the tile; kNone: there is no path
};

// Which of the slots an iteration has to do with, a bit a slot.
struct ActiveSlots {
    uint arrived = 0u; // at a vertex
    uint lit = 0u;     // of these, where a light is chosen
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

// Where the principled ones of the vertices `arrived` would scatter: proposals one by one, evaluated in lanes.
template <uint kFeatures>
RT_CALL void proposeDirections(uint arrived, PathLanes& lanes) {
    eachLane(arrived, [&](uint i) {
        const Vertex v = vertexIn<kFeatures>(lanes, i);
        if (!isPrincipled(kFeatures, v.bsdf)) return;
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
    // radiances: of the tile's samples, in the order of TileSamples.
    PathPacket(const KernelContext& context, const TileTask& task, vec3* radiances, KernelCounters& counters)
        : scene_(*context.scene),
          params_(context.params),
          cancel_(task.cancel),
          samples_(context, task),
          radiances_(radiances),
          counters_(counters) {}

    // Traces the paths of all samples. False: cancelled.
    bool trace() {
        for (;;) {
            if (cancel_ != nullptr && cancel_->load(std::memory_order_relaxed)) return false;
            const ActiveSlots active = arriveAll();
            if (active.arrived == 0u) return true;
            drawVertexSamples<kFeatures>(active.lit != 0u, lanes_);
            if (active.lit != 0u) sampleLights(active.lit);
            if (gAimCount > 0 && active.lit != 0u) connect(active.lit);
            sampleDiffuse(lanes_);
            if (has(kFeatures, kFeaturePrincipled)) proposeDirections<kFeatures>(active.arrived, lanes_);
            eachLane(active.arrived, [&](uint i) { goOnFrom(i, (active.lit >> i & 1u) != 0u); });
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

    // Scatters the path of slot i at its vertex and traces its next ray, together with the shadow ray if a light was
    // sampled.
    void goOnFrom(uint i, bool isLit) {
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
        if (goOn(params_, v, b, u.roulette.x, path)) {
            set(lanes_.hits, i, traceOn(i, direct, path));
        } else {
            traceShadow(i, direct, path);
            end(slot);
        }
    }

    [[gnu::noinline]] void findReaches(int k, float time0, FloatLanes* totals, UintLanes& masks) {
        const uint count = scene_.globals.lightCount;
        Vec3Lanes along; FloatLanes cx, sx, total{}; UintLanes mask{};
        for (uint i = 0u; i < kLanes; ++i) {
            const vec3 origin = get(lanesOf<&Vertex::origin>(lanes_.vertices), i);
            const vec3 toC = gAim[k].center + gAim[k].motion * lanes_.time.at[i] - origin;
            const float inverse = 1.0f / std::sqrt(dot(toC, toC));
            set(along, i, toC * inverse);
            const float s = std::min(gAim[k].radius * inverse, 1.0f);
            const vec2 most = gMost[k][std::min(uint(s * 16.0f), 15u)]; cx.at[i] = most.x; sx.at[i] = most.y;
        }
        for (uint l = 0u; l < count; ++l) {
            const Reach reach = gReach[k][l];
            for (uint i = 0u; i < kLanes; ++i) {
                const bool may = mayReach(reach, get(along, i), vec2(cx.at[i], sx.at[i]));
                total.at[i] += may ? reach.power : 0.0f;
                mask.at[i] |= may ? 1u << l : 0u;
            }
        }
        *totals = total; masks = mask; (void)time0;
    }
    void connect(uint lit) {
        for (int k = 0; k < gAimCount; ++k) {
            FloatLanes totals; UintLanes masks;
            findReaches(k, 0, &totals, masks);
            eachLane(lit, [&](uint i) { if (masks.at[i] != 0u) connectOne(i, k, masks.at[i], totals.at[i]); });
        }
    }
    void connectOne(uint i, int k, uint mask, float total) {
        const Vertex v = vertexIn<kFeatures>(lanes_, i);
        if (isPrincipled(kFeatures, v.bsdf) || isMetal(kFeatures, v.bsdf)) return;
        PathState& path = slots_[i].path;
        const Sampler smp = get(lanes_.samplers, i);
        const SmoothSphere& sphere = gAim[k];
        const vec3 center = sphere.center + sphere.motion * path.ray.time;
        if (v.inMedium == 0u && dot(center - v.origin, v.shading) <= -sphere.radius) return;
        const vec2 start = sample2D(smp, vertexDimension(v.index, 5u + 8u * 512u * uint(k)));
        const vec2 second = sample2D(smp, vertexDimension(v.index, 6u + 8u * 512u * uint(k)));
        for (int j = 0; j < int(gPre); ++j) {
            ++gSolved;
            const auto wrap = [](float x) { return x - std::floor(x); };
            const vec2 u1(wrap(start.x + 0.7548777f * float(j)), wrap(start.y + 0.5698403f * float(j)));
            float target = wrap(second.y + 0.6180340f * float(j)) * total;
            uint l = 0u; float power = 0.0f;
            for (uint m = 0u; m < scene_.globals.lightCount; ++m) if ((mask >> m & 1u) != 0u) { l = m; power = gReach[k][m].power; target -= power; if (target < 0.0f) break; }
            const Light& light = scene_.lights[l];
            float q = 1.0f;
            if (gTau > 0.0f) { q = std::min(1.0f, maxComponent(path.throughput * v.bsdf.albedo) * maxComponent(light.emission) / gTau); const float r = second.x * 64.0f; if (r - std::floor(r) >= q) continue; }
            ++gArrived;
            LightSample y = sampleLight(kFeatures, params_, light, center, vec3(0.0f), path.ray.time, u1);
            if (!(y.pdf > 0.0f)) continue;
            applyEmissionTexture(kFeatures, scene_, light, y);
            const float pA = gPre * power / total * y.pdf * std::abs(dot(y.normal, y.wi)) / square(y.distance);
            const ConnectionPair pair = connectionPair(sphere, center, v.origin, y.point);
            if (!isConnectable(pair.angles)) continue;
            const RefractionRoots n = refractionRoots(pair.angles, leastTurn(pair.angles));
            for (uint kind = 0u; kind < 3u; ++kind) if (hasPath(n, kind)) connectAlong(i, v, path, sphere, center, pair, kind, y, pA, q, second.x);
        }
    }
    void connectAlong(uint i, const Vertex& v, PathState& path, const SmoothSphere& sphere, vec3 center, const ConnectionPair& pair, uint kind, const LightSample& y, float pA, float q0, float u2) {
        (void)i;
        const Refraction r = refractedPath(pair.angles, kind);
        const vec3 e = pair.aside * (kind == kOppositePath ? -1.0f : 1.0f);
        const vec3 u = pair.along;
        const vec3 wx = u * r.atX.x + e * r.atX.y;
        const vec2 a1 = turnedBack(r.incident, r.atX);
        const vec2 a2 = turnedBack(vec2(-a1.x, -a1.y), turnedBy(r.refracted, r.refracted));
        const vec3 n1 = e * a1.y - u * a1.x;
        const vec3 n2 = e * a2.y - u * a2.x;
        const vec3 p1 = center + n1 * sphere.radius, p2 = center + n2 * sphere.radius;
        const vec3 wy = normalize(y.point - p2);
        if (dot(wy, n2) <= 0.0f || dot(wx, n1) >= 0.0f) return;
        const float cosY = -dot(y.normal, wy);
        if (!(cosY > 0.0f)) return;
        const vec4 f = evalScattering(kFeatures, v, wx);
        if (!(f.w > 0.0f)) return;
        const float trans = transmittedTwice(pair.angles, r);
        const float dens = refractionDensity(pair.angles, r) / square(sphere.radius) * cosY;
        const float pc = pA / dens;
        const float w = connectionWeight(pc, f.w * trans);
        vec3 c = path.throughput * vec3(f) * sphere.tint * sphere.tint * y.radiance * (trans * w / pc / q0);
        const float m = maxComponent(c);
        if (!(m > 0.0f)) return;
        if (m < 0.02f) { const float q = m / 0.02f; if (u2 >= q) return; c = c / q; }
        ++gTraced;
        const float eps = 1e-4f * sphere.radius;
        const auto blocked = [&](vec3 a, vec3 b) { Ray ray; vec3 d = b - a; float l = length(d); ray.origin = a; ray.direction = d / l; ray.time = path.ray.time; return isOccluded(scene_, ray, l * (1 - 1e-5f)); };
        if (blocked(p2 + n2 * eps, offsetOrigin(y.point, y.error, y.normal, -wy))) return;
        if (blocked(v.origin, p1 + n1 * eps)) return;
        if (blocked(p1 - n1 * eps, p2 - n2 * eps)) return;
        path.radiance += c;
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
};

} // namespace
} // namespace rt::cpu
