// Light sampling for sixteen paths: the choice of a light, samples of quads and spheres, and their weights. The values
// are those of one path alone (DirectLight.h), bit for bit. Included by one translation unit per instruction set; all
// it defines has internal linkage.
#pragma once
#include "Common/Accel/Simd/Simd.h"
#include "RayTracingCPU/PathLanes.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// ---- choosing a light ----------------------------------------------------------------------------------------------

// runningSums() of a group of rows, a row for each light; `total` becomes the last.
RT_CALL void addRows(const FloatLanes* rows, FloatLanes* sums, FloatLanes& total) {
    for (uint i = 0u; i < kLanes; ++i) {
        GroupWeights group;
        for (uint k = 0u; k < kSumGroup; ++k) group.at[k] = rows[k].at[i];
        group = runningSums(group, total.at[i]);
        for (uint k = 0u; k < kSumGroup; ++k) sums[k].at[i] = group.at[k];
        total.at[i] = group.at[kSumGroup - 1u];
    }
}

// chooseByContribution() of shared::, light by light for all paths.
RT_CALL void chooseByContribution(const CpuScene& scene, PathLanes& lanes) {
    const uint count = scene.globals.lightCount;
    const Vec3Lanes& positions = lanesOf<&Vertex::origin>(lanes.vertices);
    const Vec3Lanes& normals = lanesOf<&Vertex::shading>(lanes.vertices);
    FloatLanes weights[kContributionLights]; // a row for each light
    FloatLanes sums[kContributionLights];
    FloatLanes total{};
    for (uint first = 0u; first < count; first += kSumGroup) {
        for (uint k = first; k < first + kSumGroup; ++k) {
            if (k < count) {
                const LightBound bound = scene.lightBounds[k];
                for (uint i = 0u; i < kLanes; ++i) {
                    weights[k].at[i] = lightContribution(bound, get(positions, i), get(normals, i));
                }
            } else {
                weights[k] = FloatLanes{};
            }
        }
        addRows(weights + first, sums + first, total);
    }
    FloatLanes targets;
    for (uint i = 0u; i < kLanes; ++i) targets.at[i] = lanes.selection.x.at[i] * total.at[i];
    FloatLanes picked; // the first light whose sum is beyond the target
    for (uint i = 0u; i < kLanes; i += 8u) {
        const accel::Float8 target = accel::load(targets.at + i);
        accel::Float8 light = accel::broadcast(float(count - 1u));
        for (uint k = count - 1u; k-- > 0u;) {
            light = accel::select(target < accel::load(sums[k].at + i), accel::broadcast(float(k)), light);
        }
        accel::store(picked.at + i, light);
    }
    const float* weight = weights[0].at;
    const float* sum = sums[0].at;
    for (uint i = 0u; i < kLanes; ++i) {
        LightPick pick;
        pick.light = uint(picked.at[i]);
        pick.weight = weight[pick.light * kLanes + i];
        pick.beyond = sum[pick.light * kLanes + i] - targets.at[i];
        pick.total = total.at[i];
        set(lanes.choices, i, choiceOf(pick));
        lanes.total.at[i] = pick.total;
    }
}

// chooseFromTree() of shared::, level by level: while one path waits for a node from memory, the others descend.
RT_CALL void chooseFromTree(const CpuScene& scene, uint lit, PathLanes& lanes) {
    const Vec3Lanes& positions = lanesOf<&Vertex::origin>(lanes.vertices);
    const Vec3Lanes& normals = lanesOf<&Vertex::shading>(lanes.vertices);
    TreeDescent descents[kLanes];
    eachLane(lit, [&](uint i) { descents[i] = beginDescent(get(lanes.selection, i)); });
    for (uint descending = lit; descending != 0u;) {
        eachLane(descending, [&](uint i) {
            TreeDescent& d = descents[i];
            descend(scene, get(positions, i), get(normals, i), d);
            if (d.child != kNone) prefetchLights(scene, d.child);
            if (!isAtNode(d)) descending &= ~(1u << i);
        });
    }
    eachLane(lit, [&](uint i) {
        const TreeChoice drawn = endDescent(descents[i]);
        set(lanes.choices, i, choiceOf(drawn));
        lanes.total.at[i] = drawn.total;
    });
}

// By power, or uniformly.
RT_CALL void chooseOneByOne(const CpuScene& scene, uint policy, uint lit, PathLanes& lanes) {
    const uint count = scene.globals.lightCount;
    eachLane(lit, [&](uint i) {
        const float u = lanes.selection.x.at[i];
        set(lanes.choices, i, policy == kSelectPower ? chooseByPower(scene, count, u) : chooseUniformly(count, u));
        lanes.total.at[i] = 0.0f;
    });
}

// chooseLight() for the paths `lit`: lanes.choices, lanes.total.
template <Features kFeatures>
RT_FN void chooseLights(const CpuScene& scene, const RenderParams& params, uint lit, PathLanes& lanes) {
    const uint count = scene.globals.lightCount;
    for (uint i = 0u; i < kLanes; ++i) {
        set(lanes.selection, i, lightSelectionSample(kFeatures, params, scene.globals, get(lanes.u, i)));
    }
    if (count == 0u) {
        eachLane(lit, [&](uint i) {
            set(lanes.choices, i, noLightChoice());
            lanes.total.at[i] = 0.0f;
        });
    } else if (params.lightSelection != kSelectContribution) {
        chooseOneByOne(scene, params.lightSelection, lit, lanes);
    } else if (usesLightTree(kFeatures, count)) {
        chooseFromTree(scene, lit, lanes);
    } else {
        chooseByContribution(scene, lanes);
    }
}

// ---- sampling it ---------------------------------------------------------------------------------------------------

// Samples of quads under the automatic method, unless they are near.
RT_CALL void sampleQuads(PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        Light light = get(lanes.lights, i);
        const uint isQuad = light.kind == kLightQuad ? 1u : 0u;
        light.kind = kLightQuad;
        const Vertex v = get(lanes.vertices, i);
        const QuadView view = viewQuad(kFeatureNone, kShapeAuto, light, v.origin, v.shading);
        LightSample s = sampleQuadApart(view, light, v.origin, get(lanes.position, i));
        s = completeSample(kFeatureNone, light, v.shading, s);
        s.pdf = isLit(light, v.origin) ? s.pdf : 0.0f;
        set(lanes.lightSamples, i, s);
        lanes.isSampled.at[i] = view.strategy != kStrategySolidAngle ? isQuad : 0u;
    }
}

// But for uv, which of a sphere follows from the normal.
RT_FN LightSample selectSample(bool first, LightSample a, LightSample b) {
    b.wi = select(first, a.wi, b.wi);
    b.distance = first ? a.distance : b.distance;
    b.pdf = first ? a.pdf : b.pdf;
    b.radiance = select(first, a.radiance, b.radiance);
    b.point = select(first, a.point, b.point);
    b.error = select(first, a.error, b.error);
    b.normal = select(first, a.normal, b.normal);
    return b;
}

// Samples of spheres under the automatic method, from outside, but for near spheres.
template <Features kFeatures>
RT_CALL void sampleSpheres(PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        Light light = get(lanes.lights, i);
        const bool isSphere = light.kind == kLightSphere;
        light.kind = kLightSphere;
        const Vertex v = get(lanes.vertices, i);
        const vec2 u = get(lanes.position, i);
        const vec3 center = sphereLightCenter(kFeatures, light, lanes.time.at[i]);
        const uint strategy = sphereLightStrategy(kFeatureNone, kShapeAuto, light, center - v.origin, v.shading);
        LightSample s = sampleSphereCone(light, strategy == kStrategyVisibleCap, center, v.origin, v.shading, u);
        s = completeSample(kFeatureNone, light, v.shading, s);
        set(lanes.lightSamples, i, selectSample(isSphere, s, get(lanes.lightSamples, i)));
        const uint outside = strategy != kStrategyInside ? (isNearSphereLight(light) ? 0u : 1u) : 0u;
        const uint before = lanes.isSampled.at[i];
        lanes.isSampled.at[i] = isSphere ? outside : before;
    }
}

// ---- weighing it ---------------------------------------------------------------------------------------------------

constexpr Features kOtherSurfaces = kSurfaceFeatures & ~kFeaturePrincipled;

// kOthers: lobes of principled materials that are not left out.
template <Features kFeatures, uint kOthers>
RT_CALL void weighSamples(const RenderParams& params, RecordLanes<DirectLight>& direct, const PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        const float probability = lanesOf<&LightChoice::probability>(lanes.choices).at[i];
        const LightSample sampled = get(lanes.lightSamples, i);
        Vertex v = vertexIn<kFeatures>(lanes, i);
        v.bsdf.lobes.others = kOthers;
        const bool isPunctualSample = isPunctual(kFeatures, get(lanes.lights, i));
        set(direct, i,
            weighSample(kFeatures, params, probability, isPunctualSample, sampled, v, get(lanes.throughput, i)));
    }
}

// Those of principled vertices with lobes that the loops do not know, one by one.
template <Features kFeatures>
RT_CALL void weighRareSamples(const RenderParams& params, uint principled, RecordLanes<DirectLight>& direct,
                              const PathLanes& lanes) {
    eachLane(principled, [&](uint i) {
        if (!hasLobe(lanesOf<&PrincipledLobes::others>(lanes.lobes).at[i], kLobesRare)) return;
        const Vertex v = vertexIn<kFeatures>(lanes, i);
        const float probability = lanesOf<&LightChoice::probability>(lanes.choices).at[i];
        const bool isPunctualSample = isPunctual(kFeatures, get(lanes.lights, i));
        set(direct, i,
            weighSample(kFeatures, params, probability, isPunctualSample, get(lanes.lightSamples, i), v,
                        get(lanes.throughput, i)));
    });
}

// Principled materials apart from the others, and those of few lobes apart from those of all: each of the loops has one
// formula to evaluate, and runs where some path needs it.
template <Features kFeatures>
RT_FN void weighSamples(const RenderParams& params, uint lit, PathLanes& lanes) {
    uint principled = 0u;
    uint others = 0u;
    if (has(kFeatures, kFeaturePrincipled)) {
        const UintLanes& kinds = lanesOf<&Bsdf::kind>(lanesOf<&Vertex::bsdf>(lanes.vertices));
        eachLane(lit, [&](uint i) {
            if (kinds.at[i] != kMaterialPrincipled) return;
            principled |= 1u << i;
            others |= lanesOf<&PrincipledLobes::others>(lanes.lobes).at[i];
        });
    }
    if (principled != lit) weighSamples<kFeatures & ~kFeaturePrincipled, 0u>(params, lanes.direct, lanes);
    if (!has(kFeatures, kFeaturePrincipled) || principled == 0u) return;
    constexpr Features kPrincipled = (kFeatures & ~kOtherSurfaces) | kFeaturePrincipled;
    RecordLanes<DirectLight> direct;
    if (others == 0u) {
        weighSamples<kPrincipled, 0u>(params, direct, lanes);
    } else {
        weighSamples<kPrincipled, kLobesLayered>(params, direct, lanes);
    }
    if (has(kFeatures, kRareFeatures) && hasLobe(others, kLobesRare))
        weighRareSamples<kPrincipled>(params, principled, direct, lanes);
    eachLane(principled, [&](uint i) { set(lanes.direct, i, get(direct, i)); });
}

// sampleDirectLight() for the paths `lit`: lanes.direct.
template <Features kFeatures>
RT_CALL void sampleDirectLights(const CpuScene& scene, const RenderParams& params, uint lit, PathLanes& lanes) {
    const UintLanes& chosen = lanesOf<&LightChoice::light>(lanes.choices);
    for (uint i = 0u; i < kLanes; ++i) {
        set(lanes.position, i, positionSample(kFeatures, scene.globals, get(lanes.choices, i), get(lanes.u, i)));
    }
    eachLane(lit, [&](uint i) {
        lanes.isSampled.at[i] = 0u;
        if (chosen.at[i] != kNone) set(lanes.lights, i, scene.lights[chosen.at[i]]);
    });
    if (has(kFeatures, kFeatureQuadLights) && params.quadLight == kShapeAuto) sampleQuads(lanes);
    if (has(kFeatures, kFeatureSphereLights) && params.sphereLight == kShapeAuto) {
        sampleSpheres<kFeatures & kFeatureMovingSpheres>(lanes);
    }
    eachLane(lit, [&](uint i) {
        if (chosen.at[i] == kNone) {
            lanesOf<&LightSample::pdf>(lanes.lightSamples).at[i] = 0.0f;
            return;
        }
        const Light& light = scene.lights[chosen.at[i]];
        if (lanes.isSampled.at[i] == 0u) {
            const Vertex v = get(lanes.vertices, i);
            const vec2 u = get(lanes.position, i);
            set(lanes.lightSamples, i, sampleChosenLight(kFeatures, scene, params, light, v, lanes.time.at[i], u));
        } else if (variesOver(kFeatures, light)) {
            LightSample sampled = get(lanes.lightSamples, i);
            applyMaterial(kFeatures, scene, light, sampled);
            set(lanesOf<&LightSample::radiance>(lanes.lightSamples), i, sampled.radiance);
        }
    });
    weighSamples<kFeatures>(params, lit, lanes);
}

} // namespace
} // namespace rt::cpu
