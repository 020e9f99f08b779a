// Connections by way of smooth spheres, sixteen at a time: what a path's sphere and light are is found slot by slot,
// the paths between their ends in the lanes of vectors. The values are those of one path alone (Connection.h), bit for
// bit.
// Included by one translation unit per instruction set; all it defines has internal linkage.
#pragma once
#include "RayTracingCPU/PathLanes.h"

RT_SHARED_BEGIN

template <>
struct FieldsOf<RefractionPair>
    : Fields<FieldList<&RefractionPair::inverseEta, &RefractionPair::crossings, &RefractionPair::nearX,
                       &RefractionPair::nearY, &RefractionPair::bend>> {};

template <>
struct FieldsOf<RefractionRoots> : Fields<FieldList<&RefractionRoots::count, &RefractionRoots::opposite,
                                                    &RefractionRoots::beyond, &RefractionRoots::before>> {};

template <>
struct FieldsOf<ConnectionPair>
    : Fields<
          FieldList<&ConnectionPair::angles, &ConnectionPair::along, &ConnectionPair::aside, &ConnectionPair::axis>> {};

template <>
struct FieldsOf<LightEnd> : Fields<FieldList<&LightEnd::point, &LightEnd::error, &LightEnd::normal, &LightEnd::radiance,
                                             &LightEnd::density, &LightEnd::twoSided>> {};

template <>
struct FieldsOf<SpherePath>
    : Fields<FieldList<&SpherePath::atX, &SpherePath::entry, &SpherePath::bounce, &SpherePath::leave,
                       &SpherePath::fraction, &SpherePath::spread, &SpherePath::share>> {};

RT_SHARED_END

namespace rt::cpu {
namespace {

using namespace rt::shared;

// Connections that paths attempt. Few do at a time: they wait until every lane has one.
struct ConnectionLanes {
    uint count;         // of lanes in use
    uint entry[kLanes]; // what it brings is summed in, as the caller counts them
    uint sphere[kLanes];
    Vertex vertex[kLanes];
    vec3 throughput[kLanes];
    float time[kLanes];
    Vec3Lanes normals; // of the vertices
    Vec3Lanes centers; // of the spheres
    FloatLanes radii;
    FloatLanes u; // draws one of the paths
    RecordLanes<LightEnd> ends;
    RecordLanes<ConnectionPair> pairs;
    Vec2Lanes minimum; // intervals, then angles
    RecordLanes<RefractionRoots> roots;
    Vec2Lanes angles;
    RecordLanes<SpherePath> paths[kRefractedPaths];
};

// totalWeight() of all paths.
RT_CALL void addWeights(const CpuScene& scene, const RenderParams& params, const PathLanes& lanes, FloatLanes& totals) {
    const Vec3Lanes& positions = lanesOf<&Vertex::origin>(lanes.vertices);
    totals = FloatLanes{};
    for (uint k = 0u; k < params.connectedSpheres; ++k) {
        const SpecularCaster& sphere = scene.specularCasters[k];
        Vec3Lanes along;
        FloatLanes near;
        Vec2Lanes reach;
        UintLanes isNear;
        for (uint i = 0u; i < kLanes; ++i) {
            const SphereView view = seeSphere(sphere, get(positions, i), lanes.time.at[i]);
            set(along, i, view.along);
            near.at[i] = view.near;
            isNear.at[i] = view.isNear ? 1u : 0u;
        }
        uint any = 0u;
        for (uint i = 0u; i < kLanes; ++i) any |= isNear.at[i];
        if (any == 0u) continue;
        for (uint i = 0u; i < kLanes; ++i) set(reach, i, reachAt(sphere, near.at[i]));
        FloatLanes sums{};
        for (uint l = 0u; l < sphere.lightCount; ++l) {
            const CasterLight light = scene.casterLights[sphere.firstLight + l];
            for (uint i = 0u; i < kLanes; ++i) {
                SphereView view{};
                view.along = get(along, i);
                view.reach = get(reach, i);
                view.isNear = isNear.at[i] != 0u;
                sums.at[i] += reachWeight(light, view);
            }
        }
        for (uint i = 0u; i < kLanes; ++i) totals.at[i] += sums.at[i];
    }
}

// The angle of every path's one of this kind, as if there were one.
RT_FN void findAngles(uint kind, ConnectionLanes& c) {
    for (uint i = 0u; i < kLanes; ++i) set(c.angles, i, firstAngle(kind));
    for (uint k = 0u; k < kRootSteps; ++k) {
        for (uint i = 0u; i < kLanes; ++i) {
            const RefractionPair p = get(lanesOf<&ConnectionPair::angles>(c.pairs), i);
            set(c.angles, i, nextAngle(p, kind, get(c.angles, i)));
        }
    }
}

// Nothing has to be halved where all turns rise throughout, as those to distant points do.
RT_FN void findRoots(ConnectionLanes& c) {
    uint falling = 0u;
    for (uint i = 0u; i < kLanes; ++i) {
        set(c.minimum, i, vec2(0.0f, 1.0f));
        falling |= risesThroughout(get(lanesOf<&ConnectionPair::angles>(c.pairs), i)) ? 0u : 1u;
    }
    for (uint k = 0u; k < kMinSteps && falling != 0u; ++k) {
        for (uint i = 0u; i < kLanes; ++i) {
            const RefractionPair p = get(lanesOf<&ConnectionPair::angles>(c.pairs), i);
            set(c.minimum, i, halvedMin(p, get(c.minimum, i)));
        }
    }
    for (uint i = 0u; i < kLanes; ++i) {
        const RefractionPair p = get(lanesOf<&ConnectionPair::angles>(c.pairs), i);
        set(c.roots, i, refractionRoots(p, minWithin(p, get(c.minimum, i))));
    }
}

// All paths between the ends of the connections.
RT_CALL void findPaths(ConnectionLanes& c) {
    findRoots(c);
    for (uint kind = 0u; kind < kRefractedPaths; ++kind) {
        uint exist = 0u;
        for (uint i = 0u; i < c.count; ++i) exist |= hasPath(get(c.roots, i), kind) ? 1u : 0u;
        if (exist == 0u) {
            lanesOf<&SpherePath::share>(c.paths[kind]) = FloatLanes{};
            continue;
        }
        findAngles(kind, c);
        for (uint i = 0u; i < kLanes; ++i) {
            const bool exists = hasPath(get(c.roots, i), kind);
            set(c.paths[kind], i,
                pathAt(get(c.pairs, i), kind, exists, get(c.angles, i), c.radii.at[i], get(c.centers, i),
                       get(c.ends, i), get(c.normals, i)));
        }
    }
}

// Probabilities of connections from all vertices, and their rates. Returns the paths that attempt one.
template <Features kFeatures>
RT_CALL uint drawAttempts(const CpuScene& scene, const RenderParams& params, const PathLanes& lanes, FloatLanes& totals,
                          FloatLanes& chances, FloatLanes& rates) {
    addWeights(scene, params, lanes, totals);
    const float typical = scene.globals.maxCasterIrradiance;
    UintLanes attempts;
    for (uint i = 0u; i < kLanes; ++i) {
        const Vertex v = get(lanes.vertices, i);
        const float total = totals.at[i];
        const bool isPossible = total > 0.0f && connects(kFeatures, v);
        const vec3 throughput = get(lanes.throughput, i) * v.bsdf.albedo;
        chances.at[i] = isPossible ? connectionChance(total, lanes.total.at[i], typical, throughput) : 0.0f;
        rates.at[i] = isPossible ? chances.at[i] / total : 0.0f;
        attempts.at[i] = get(lanes.u, i).roulette.y < chances.at[i] ? 1u : 0u;
    }
    uint attempted = 0u;
    for (uint i = 0u; i < kLanes; ++i) attempted |= attempts.at[i] << i;
    return attempted;
}

// Adds a connection of the path in lane i to those that wait, up to the light's end. False: there is nothing to connect
// to after all.
template <Features kFeatures>
RT_CALL bool addConnection(const CpuScene& scene, const RenderParams& params, const PathLanes& lanes, uint i,
                           float target, float rate, ConnectionLanes& c) {
    const Vertex v = vertexIn<kFeatures>(lanes, i);
    const float time = lanes.time.at[i];
    const ConnectionChoice choice = chooseConnection(scene, params, v.origin, time, target);
    if (!(choice.weight > 0.0f)) return false;
    const SpecularCaster& sphere = scene.specularCasters[choice.sphere];
    if (!isInTime(params, sphere, v)) return false;
    const SphereView view = viewSphere(sphere, v.origin, time);
    const LightEnd end = sampleEnd(kFeatures, scene, params, choice, view.center, time, rate,
                                   connectionSample(get(lanes.samplers, i), v));
    if (!(end.density > 0.0f)) return false;
    const uint n = c.count++;
    c.sphere[n] = choice.sphere;
    c.vertex[n] = v;
    c.throughput[n] = get(lanes.throughput, i);
    c.time[n] = time;
    c.radii.at[n] = sphere.radius;
    c.u.at[n] = choice.u;
    set(c.normals, n, v.shading);
    set(c.centers, n, view.center);
    set(c.ends, n, end);
    set(c.pairs, n, connectionPair(sphere, view, end.point));
    return true;
}

// Of kernels without connections.
template <Features kFeatures, bool kConnects = (kFeatures & kMethodConnections) != kFeatureNone>
class Connections {
  public:
    Connections(const CpuScene&, const RenderParams&, KernelCounters&) {}
};

// Entries of a packet's samples, then of what these share of their paths.
constexpr uint kConnectionEntries = 2u * kBatchSamples;

// The connections of the samples of a packet. What they bring to an entry is summed apart from its path, in the order
// of its vertices: the sum does not depend on how long a connection waits for others.
template <Features kFeatures>
class Connections<kFeatures, true> {
  public:
    Connections(const CpuScene& scene, const RenderParams& params, KernelCounters& counters)
        : scene_(scene), params_(params), counters_(counters) {}

    // connectLight() for the paths `lit`, whose time and throughput are in lanes, up to the light's end. `rates` is
    // what goes into their chains; entryOf(i) the entry, < kConnectionEntries, of a path's light.
    template <class EntryOf>
    void attempt(uint lit, const PathLanes& lanes, FloatLanes& rates, const EntryOf& entryOf) {
        FloatLanes totals, chances;
        const uint attempted = drawAttempts<kFeatures>(scene_, params_, lanes, totals, chances, rates);
        eachLane(lit & attempted, [&](uint i) {
            const float target = lanesOf<&VertexSamples::roulette>(lanes.u).y.at[i] / chances.at[i] * totals.at[i];
            if (!addConnection<kFeatures>(scene_, params_, lanes, i, target, rates.at[i], c_)) return;
            c_.entry[c_.count - 1u] = entryOf(i);
            if (c_.count == kLanes) finish();
        });
    }

    // All that still wait.
    void finish() {
        if (c_.count == 0u) return;
        findPaths(c_);
        for (uint i = 0u; i < c_.count; ++i) {
            const SpherePath path = pickPath(get(c_.paths[0], i), get(c_.paths[1], i), get(c_.paths[2], i), c_.u.at[i]);
            if (path.share > 0.0f) trace(i, path);
        }
        c_.count = 0u;
    }

    // What connections bring to an entry.
    vec3 radiance(uint entry) const { return radiances_[entry]; }

  private:
    // Adds what comes along the path if its segments are free.
    void trace(uint i, const SpherePath& path) {
        SpecularConnection connection =
            weighConnection(kFeatures, params_, scene_.specularCasters[c_.sphere[i]], get(c_.centers, i), path,
                            get(c_.ends, i), c_.vertex[i], c_.throughput[i]);
        while (connection.segments != 0u) {
            ++counters_.shadow;
            float tMax;
            const Ray ray = connectionRay(connection, c_.time[i], tMax);
            endSegment(kFeatures, scene_, !isOccluded(scene_, ray, tMax), ray, tMax, connection,
                       radiances_[c_.entry[i]]);
        }
    }

    const CpuScene& scene_;
    const RenderParams& params_;
    KernelCounters& counters_;
    ConnectionLanes c_{};
    vec3 radiances_[kConnectionEntries]{};
};

} // namespace
} // namespace rt::cpu
