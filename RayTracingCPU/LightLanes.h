// Next-event estimation for all lanes: the choice by contribution from a short table, samples of quads and spheres, and their weights.
// The numbers are those of one path alone, bit for bit.
#pragma once
#include "RayTracingCPU/Lanes.h"
#include "RayTracingCPU/SceneAccess.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// The sums of eight rows and `total`, in the order of accel::runningSums(); `total` becomes the last.
RT_CALL void addRows(const FloatLanes* rows, FloatLanes* sums, FloatLanes& total) {
    for (uint i = 0u; i < kLanes; ++i) {
        float r[8];
        for (uint k = 0u; k < 8u; k += 4u) {
            const float a1 = rows[k + 1].at[i];
            const float a2 = rows[k + 2].at[i];
            r[k] = rows[k].at[i];
            r[k + 1] = a1 + r[k];
            r[k + 2] = (a2 + a1) + r[k];
            r[k + 3] = (rows[k + 3].at[i] + a2) + r[k + 1];
        }
        const float before = total.at[i];
        for (uint k = 0u; k < 4u; ++k) {
            sums[k].at[i] = r[k] + before;
            sums[k + 4].at[i] = (r[k + 4] + r[3]) + before;
        }
        total.at[i] = sums[7].at[i];
    }
}

// chooseByContribution(), by the first of the numbers for lights.
RT_CALL void chooseByContribution(const CpuScene& scene, PathLanes& lanes) {
    const uint count = scene.globals.lightCount;
    const Vec3Lanes& positions = lanes.vertices.origin;
    const Vec3Lanes& normals = lanes.vertices.shading;
    FloatLanes weights[kContributionLights]; // a row for each light
    FloatLanes sums[kContributionLights];
    FloatLanes total{};
    for (uint first = 0u; first < count; first += 8u) {
        for (uint k = first; k < first + 8u; ++k) {
            if (k < count) {
                const LightBound bound = lightBoundAt(*scene.lightBoundsSoa, k);
                for (uint i = 0u; i < kLanes; ++i) {
                    weights[k].at[i] = lightContribution(bound, get(positions, i), get(normals, i));
                }
            } else {
                weights[k] = FloatLanes{};
            }
        }
        addRows(weights + first, sums + first, total);
    }
    FloatLanes places;
    for (uint i = 0u; i < kLanes; ++i) places.at[i] = lanes.vertices.light.x.at[i] * total.at[i];
    FloatLanes picked; // the first light whose sum is beyond the place
    for (uint i = 0u; i < kLanes; i += 8u) {
        const accel::Float8 place = accel::load(places.at + i);
        accel::Float8 light = accel::broadcast(float(count - 1u));
        for (uint k = count - 1u; k-- > 0u;) {
            light = accel::select(place < accel::load(sums[k].at + i), accel::broadcast(float(k)), light);
        }
        accel::store(picked.at + i, light);
    }
    const float* weight = weights[0].at;
    const float* sum = sums[0].at;
    for (uint i = 0u; i < kLanes; ++i) {
        LightPick pick;
        pick.light = uint(picked.at[i]);
        pick.weight = weight[pick.light * kLanes + i];
        pick.beyond = sum[pick.light * kLanes + i] - places.at[i];
        pick.total = total.at[i];
        set(lanes.choices, i, choiceOf(pick), pick.total);
    }
}

RT_FN vec2 sampleNumbers(const PathLanes& lanes, uint i) {
    return vec2(lanes.choices.u.at[i], lanes.vertices.light.y.at[i]);
}

// Samples of quads under the automatic method, unless they are near.
RT_CALL void sampleQuads(PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        const Light light = getAs(kLightQuad, lanes.lights, i);
        const vec3 position = get(lanes.vertices.origin, i);
        const vec3 normal = get(lanes.vertices.shading, i);
        const QuadView view = viewQuad(0u, kShapeAuto, light, position, normal);
        LightSample s = sampleQuadApart(view, light, position, sampleNumbers(lanes, i));
        s = completeSample(0u, light, normal, s);
        s.pdf = isLit(light, position) ? s.pdf : 0.0f;
        set(lanes.samples, i, s);
        const uint apart = view.strategy != kStrategySolidAngle ? 1u : 0u;
        lanes.sampled.at[i] = lanes.lights.kind.at[i] == kLightQuad ? apart : 0u;
    }
}

// But for uv, which of a sphere follows from the normal.
RT_FN LightSample eitherSample(bool first, LightSample a, LightSample b) {
    b.wi = either(first, a.wi, b.wi);
    b.distance = first ? a.distance : b.distance;
    b.pdf = first ? a.pdf : b.pdf;
    b.radiance = either(first, a.radiance, b.radiance);
    b.point = either(first, a.point, b.point);
    b.error = either(first, a.error, b.error);
    b.normal = either(first, a.normal, b.normal);
    return b;
}

// Samples of spheres under the automatic method, from outside.
template <uint kFeatures>
RT_CALL void sampleSpheres(PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        const Light light = getAs(kLightSphere, lanes.lights, i);
        const vec3 position = get(lanes.vertices.origin, i);
        const vec3 normal = get(lanes.vertices.shading, i);
        const vec2 u = sampleNumbers(lanes, i);
        const vec3 center = sphereLightCenter(kFeatures, light, lanes.time.at[i]);
        const uint strategy = sphereLightStrategy(0u, kShapeAuto, light, center - position, normal);
        const SphereCone cone = makeSphereCone(center - position, light.radius);
        const bool isCap = strategy == kStrategyVisibleCap;
        const ConeSample inCap = sampleVisibleCap(cone, light.radius, normal, u);
        ConeSample c = sampleSphereCone(cone, light.radius, u);
        c.direction = either(isCap, inCap.direction, c.direction);
        c.distance = isCap ? inCap.distance : c.distance;
        c.normal = either(isCap, inCap.normal, c.normal);
        const float pdf = isCap ? wholeCapPdf(cone, normal, c.direction) : sphereConePdf(cone);
        LightSample s = sampleOfCone(cone, c, pdf, center, light.radius, position);
        s = completeSample(0u, light, normal, s);
        const bool isSphere = lanes.lights.kind.at[i] == kLightSphere;
        set(lanes.samples, i, eitherSample(isSphere, s, get(lanes.samples, i)));
        const uint outside = strategy != kStrategyInside ? 1u : 0u;
        const uint before = lanes.sampled.at[i];
        lanes.sampled.at[i] = isSphere ? outside : before;
    }
}

template <uint kFeatures>
RT_CALL void weighSamples(const RenderParams& params, PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        const DirectLight direct = weighSample(kFeatures, params, lanes.choices.probability.at[i],
                                               get(lanes.samples, i), get(lanes.vertices, i), get(lanes.throughput, i));
        set(lanes.direct, i, direct);
    }
}

} // namespace
} // namespace rt::cpu
