// Next-event estimation: a light that is chosen and sampled from a vertex, and the shadow ray that finds whether it
// arrives.
#ifndef RT_SHARED_DIRECT_LIGHT_H
#define RT_SHARED_DIRECT_LIGHT_H
#include "Common/Shared/Light/PunctualLight.h"
#include "Common/Shared/Medium/Media.h"
#include "Common/Shared/Path/Emission.h"
#include "Common/Shared/Path/PathSamples.h"
#include "Common/Shared/Path/Vertex.h"

RT_SHARED_BEGIN

// Fraction of light that media let through along the ray up to tMax.
RT_FN float rayTransmittance(Features features, SceneRef scene, RT_IN(Ray) ray, float tMax) {
    if (!has(features, kFeatureVolumes)) return 1.0f;
    float depth = 0.0f;
    uint count = loadGlobals(scene).mediumCount;
    for (uint i = 0u; i < count; i++) {
        RT_IN(Medium) medium = loadMedium(scene, i);
        depth += medium.extinction * lengthWithin(mediumInterval(medium, ray.origin, ray.direction), tMax);
    }
    return transmittance(depth);
}

// Whether lights are sampled beside scattering: all of them, or only the punctual ones, which scattering never finds.
RT_FN bool samplesLights(Features features, RT_IN(RenderParams) params) {
    return usesMis(params) || has(features, kFeaturePunctualLights);
}

// Whether a light is chosen and sampled at v, whose light is added if it arrives.
RT_FN bool usesNextEventEstimation(Features features, RT_IN(RenderParams) params, RT_IN(SceneGlobals) globals,
                                   RT_IN(Vertex) v) {
    return has(features, kFeatureLights) && samplesLights(features, params) && globals.lightCount > 0u &&
           !isDeltaVertex(features, v);
}

// The sample that chooses the light: the one whose second coordinate also places the point on it, unless there are so
// many lights that the choice would use up its bits.
RT_FN vec2 selectionSample(Features features, RT_IN(SceneGlobals) globals, RT_IN(VertexSamples) u) {
    return usesLightTree(features, globals.lightCount) ? u.selection : u.light;
}

// The sample that places the point on the light: in its first coordinate what the choice from a short table left of it.
RT_FN vec2 positionSample(Features features, RT_IN(SceneGlobals) globals, RT_IN(LightChoice) choice,
                          RT_IN(VertexSamples) u) {
    return usesLightTree(features, globals.lightCount) ? u.light : vec2(choice.u, u.light.y);
}

// Whether the radiance of a light's sample is not that of all its points.
RT_FN bool variesOver(Features features, RT_IN(Light) light) {
    return has(features, kTexturedFeatures | kFeatureOpacity) && light.material != kNone;
}

// Replaces the radiance of a light's sample by that of its point: what the material emits there, by texture, times its
// opacity, which is the share of the rays there that meet the light.
RT_FN void applyMaterial(Features features, SceneRef scene, RT_IN(Light) light, RT_INOUT(LightSample) sampled) {
    if (!variesOver(features, light)) return;
    if (light.kind == kLightSphere) sampled.uv = sphereUv(sampled.normal);
    if (has(features, kFeatureEllipsoidLights) && light.kind == kLightEllipsoid) {
        sampled.uv = sphereUv(normalize(normalReach(light.edgeU, light.edgeV, light.normal, sampled.normal)));
    }
    Surface s; // as far as emission and opacity look at it
    s.position = sampled.point;
    s.uv = sampled.uv;
    s.uv2 = sampled.uv;
    s.color = vec4(1.0f, 1.0f, 1.0f, 1.0f);
    s.material = light.material;
    if (has(features, kFeatureTriangleLights) && light.kind == kLightTriangle) {
        uvec3 index = loadTriangle(scene, light.triangle);
        RT_IN(Mesh) mesh = loadMesh(scene, loadTriangleMesh(scene, light.triangle));
        if (mesh.firstUv != kNone) s.uv = meshUv(scene, mesh, mesh.firstUv, index, sampled.uv);
        s.uv2 = mesh.firstUv2 != kNone ? meshUv(scene, mesh, mesh.firstUv2, index, sampled.uv) : s.uv;
        if (has(features, kFeatureOpacity) && mesh.firstColor != kNone) {
            s.color = meshColor(scene, mesh, index, sampled.uv);
        }
    }
    Material material = loadMaterial(scene, light.material);
    sampled.radiance = surfaceEmission(features, scene, material, s);
    if (has(features, kFeatureOpacity) && isPrincipled(features, material)) {
        sampled.radiance *= surfaceOpacity(features, scene, loadPrincipled(scene, light.material), s);
    }
}

RT_FN LightSample sampleChosenLight(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Light) light,
                                    RT_IN(Vertex) v, float time, vec2 u) {
    if (has(features, kFeatureSkyImage) && light.kind == kLightSky) return sampleSky(scene, u);
    if (isPunctual(features, light)) return samplePunctualLight(light, v.origin, v.shading);
    LightSample sampled = sampleLight(features, params, light, v.origin, v.shading, time, u);
    applyMaterial(features, scene, light, sampled);
    return sampled;
}

// Shadow rays end by this fraction early: a parameter t is known to a few roundings of itself, which exceeds any bound
// made of the light's coordinates when the light is far from the shading point but not from the origin.
const float kShadowMargin = 32.0f * kEpsilon;

RT_FN DirectLight noDirectLight() {
    DirectLight direct;
    direct.radiance = vec3(0.0f, 0.0f, 0.0f);
    direct.direction = vec3(0.0f, 0.0f, 0.0f);
    direct.distance = 0.0f;
    return direct;
}

// The contribution of a light that was chosen with `probability` and sampled, to a path of this throughput that
// scatters at v, weighed against the bsdf's density. A punctual light's sample has nothing to be weighed against; where
// the estimator is not mis that of any other is left to scattering. Without a branch, for loops over samples.
RT_FN DirectLight weighSample(Features features, RT_IN(RenderParams) params, float probability, bool isPunctualSample,
                              RT_IN(LightSample) sampled, RT_IN(Vertex) v, vec3 throughput) {
    vec4 f = evalScattering(features, v, sampled.wi);
    vec3 unweighted = throughput * vec3(f) * sampled.radiance;
    bool isWanted = !has(features, kFeaturePunctualLights) || isPunctualSample || usesMis(params);
    float contribution = isWanted && sampled.pdf > 0.0f ? maxComponent(unweighted) : 0.0f;
    // The weight and the division by the light's own density are one division.
    float density = probability * sampled.pdf;
    float scattering = params.lightSampling == kSampleMisBalance ? f.w : f.w * (f.w / density);
    if (has(features, kFeaturePunctualLights)) scattering = isPunctualSample ? 0.0f : scattering;
    // The segment ends at the light's own offset point, so that the emitter does not shadow itself and no primitive has
    // to be excluded.
    vec3 end = offsetOrigin(sampled.point, sampled.error, sampled.normal, -sampled.wi);
    vec3 segment = end - v.origin;
    float segmentLength = length(segment);
    // Closer than rounding can tell apart nothing fits in between.
    float distance = dot(segment, sampled.wi) > 0.0f ? segmentLength * (1.0f - kShadowMargin) : 0.0f;
    bool isDistant = has(features, kFeatureSkyImage | kFeaturePunctualLights) && sampled.distance == kInfinity;
    DirectLight direct;
    direct.radiance = select(contribution > 0.0f, unweighted * (1.0f / (density + scattering)), vec3(0.0f));
    direct.direction = select(isDistant, sampled.wi, segment / segmentLength);
    distance = isDistant ? kInfinity : distance;
    direct.distance = contribution > 0.0f ? distance : 0.0f;
    return direct;
}

// Next-event estimation at v with the light that was chosen: one sample, one shadow ray.
RT_FN DirectLight sampleDirectLight(Features features, SceneRef scene, RT_IN(RenderParams) params,
                                    RT_IN(LightChoice) choice, RT_IN(Vertex) v, RT_IN(VertexSamples) u,
                                    RT_IN(PathState) s) {
    if (choice.light == kNone) return noDirectLight();
    RT_IN(Light) light = loadLight(scene, choice.light);
    vec2 position = positionSample(features, loadGlobals(scene), choice, u);
    LightSample sampled = sampleChosenLight(features, scene, params, light, v, s.ray.time, position);
    return weighSample(features, params, choice.probability, isPunctual(features, light), sampled, v, s.throughput);
}

// Adds what needs no shadow ray.
RT_FN void addUnshadowed(RT_IN(DirectLight) direct, RT_INOUT(PathState) s) {
    if (direct.distance == 0.0f) s.radiance += direct.radiance;
}

RT_FN Ray shadowRay(RT_IN(PathState) s, RT_IN(DirectLight) direct) {
    Ray ray;
    ray.origin = s.last.position;
    ray.direction = direct.direction;
    ray.time = s.ray.time;
    return ray;
}

// To be called where no surface is in the way of shadowRay(s, direct).
RT_FN void addDirectLight(Features features, SceneRef scene, RT_IN(DirectLight) direct, RT_INOUT(PathState) s) {
    s.radiance += direct.radiance * rayTransmittance(features, scene, shadowRay(s, direct), direct.distance);
}

RT_SHARED_END

#endif
