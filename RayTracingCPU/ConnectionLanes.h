// Connections through spheres of glass for sixteen paths: what a path's sphere and light are is found slot by slot, the
// paths between their ends in the lanes of vectors. The values are those of one path alone (Connection.h), bit for bit.
// Included by one translation unit per instruction set; all it defines has internal linkage.
#pragma once
#include "RayTracingCPU/PathLanes.h"

RT_SHARED_BEGIN

template <>
struct FieldsOf<RefractionPair> : Fields<FieldList<&RefractionPair::inverseEta, &RefractionPair::nearX,
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
struct FieldsOf<SpherePath> : Fields<FieldList<&SpherePath::atX, &SpherePath::entry, &SpherePath::leave,
                                               &SpherePath::transmitted, &SpherePath::spread, &SpherePath::share>> {};

RT_SHARED_END

namespace rt::cpu {
namespace {

using namespace rt::shared;

struct ConnectionLanes {
    uint sphere[kLanes]; // of the paths that attempt a connection
    Vec3Lanes centers;   // of it
    FloatLanes radii;
    FloatLanes u; // draws one of the paths
    RecordLanes<LightEnd> ends;
    RecordLanes<ConnectionPair> pairs;
    Vec2Lanes least; // intervals, then angles
    RecordLanes<RefractionRoots> roots;
    Vec2Lanes angles;
    RecordLanes<SpherePath> paths[kRefractedPaths];
};

// totalWeight() of all paths.
RT_CALL void addWeights(const CpuScene& scene, const RenderParams& params, const PathLanes& lanes, FloatLanes& totals) {
    const Vec3Lanes& positions = lanesOf<&Vertex::origin>(lanes.vertices);
    const uint count = scene.globals.lightCount;
    totals = FloatLanes{};
    for (uint k = 0u; k < params.connectedSpheres; ++k) {
        const SmoothSphere& sphere = scene.smoothSpheres[k];
        Vec3Lanes along;
        Vec2Lanes reach;
        UintLanes isNear;
        for (uint i = 0u; i < kLanes; ++i) {
            const SphereView view = viewSphere(sphere, get(positions, i), lanes.time.at[i]);
            set(along, i, view.along);
            set(reach, i, view.reach);
            isNear.at[i] = view.isNear ? 1u : 0u;
        }
        uint near = 0u;
        for (uint i = 0u; i < kLanes; ++i) near |= isNear.at[i];
        if (near == 0u) continue;
        FloatLanes sums{};
        for (uint l = 0u; l < count; ++l) {
            const SphereReach light = scene.sphereReaches[k * count + l];
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

RT_FN void findRoots(ConnectionLanes& c) {
    for (uint i = 0u; i < kLanes; ++i) set(c.least, i, vec2(0.0f, 1.0f));
    for (uint k = 0u; k < kLeastSteps; ++k) {
        for (uint i = 0u; i < kLanes; ++i) {
            const RefractionPair p = get(lanesOf<&ConnectionPair::angles>(c.pairs), i);
            set(c.least, i, halvedLeast(p, get(c.least, i)));
        }
    }
    for (uint i = 0u; i < kLanes; ++i) {
        const RefractionPair p = get(lanesOf<&ConnectionPair::angles>(c.pairs), i);
        set(c.roots, i, refractionRoots(p, leastWithin(p, get(c.least, i))));
    }
}

// All paths between the ends of the connections `attempted`.
RT_CALL void findPaths(const PathLanes& lanes, uint attempted, ConnectionLanes& c) {
    findRoots(c);
    for (uint kind = 0u; kind < kRefractedPaths; ++kind) {
        uint exist = 0u;
        eachLane(attempted, [&](uint i) { exist |= hasPath(get(c.roots, i), kind) ? 1u : 0u; });
        if (exist == 0u) {
            lanesOf<&SpherePath::share>(c.paths[kind]) = FloatLanes{};
            continue;
        }
        findAngles(kind, c);
        for (uint i = 0u; i < kLanes; ++i) {
            const bool exists = hasPath(get(c.roots, i), kind);
            set(c.paths[kind], i,
                pathAt(get(c.pairs, i), kind, exists, get(c.angles, i), c.radii.at[i], get(c.centers, i),
                       get(c.ends, i), get(lanesOf<&Vertex::shading>(lanes.vertices), i)));
        }
    }
}

// connectLight() for the paths `lit`, whose time and throughput are in lanes: passages, and what goes into the chain of
// each of them. Returns those that have a passage.
template <uint kFeatures>
RT_CALL uint connectLights(const CpuScene& scene, const RenderParams& params, uint lit, const PathLanes& lanes,
                           FloatLanes& rates, Passage* passages) {
    FloatLanes totals;
    addWeights(scene, params, lanes, totals);
    uint attempted = 0u;
    ConnectionLanes c{};
    eachLane(lit, [&](uint i) {
        rates.at[i] = 0.0f;
        const float total = totals.at[i];
        if (!(total > 0.0f)) return;
        const Vertex v = vertexIn<kFeatures>(lanes, i);
        if (!connects(kFeatures, params, v)) return;
        const float chance = connectionChance(total, lanes.total.at[i], get(lanes.throughput, i) * v.bsdf.albedo);
        rates.at[i] = chance / total;
        const float u = lanesOf<&VertexSamples::roulette>(lanes.u).y.at[i];
        if (!(u < chance)) return;
        const float time = lanes.time.at[i];
        const ConnectionChoice choice = chooseConnection(scene, params, v.origin, time, u / chance * total);
        if (!(choice.weight > 0.0f)) return;
        const SmoothSphere& sphere = scene.smoothSpheres[choice.sphere];
        const SphereView view = viewSphere(sphere, v.origin, time);
        const LightEnd end = sampleEnd(kFeatures, scene, params, choice, view.center, time, rates.at[i],
                                       connectionSample(get(lanes.samplers, i), v));
        if (!(end.density > 0.0f)) return;
        c.sphere[i] = choice.sphere;
        c.radii.at[i] = sphere.radius;
        c.u.at[i] = choice.u;
        set(c.centers, i, view.center);
        set(c.ends, i, end);
        set(c.pairs, i, connectionPair(sphere, view, end.point));
        attempted |= 1u << i;
    });
    if (attempted == 0u) return 0u;
    findPaths(lanes, attempted, c);
    uint connected = 0u;
    eachLane(attempted, [&](uint i) {
        const SpherePath path = pickPath(get(c.paths[0], i), get(c.paths[1], i), get(c.paths[2], i), c.u.at[i]);
        if (!(path.share > 0.0f)) return;
        passages[i] = weighPassage(kFeatures, params, scene.smoothSpheres[c.sphere[i]], get(c.centers, i), path,
                                   get(c.ends, i), vertexIn<kFeatures>(lanes, i), get(lanes.throughput, i));
        if (passages[i].segments != 0u) connected |= 1u << i;
    });
    return connected;
}

} // namespace
} // namespace rt::cpu
