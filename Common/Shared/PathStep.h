// One vertex of a path: emission, next-event estimation, scattering, roulette. Both engines run this very code; the loop
// around it is theirs.
//
//        ray           pathVertex
//   o---------->x   emission weighed against the light sampling of the vertex before
//               |\__ one shadow ray to a chosen light          (mis)
//               v    next ray from the bsdf, or from a light   (mixture)
//
// The engine traces. For each step it finds the nearest hit of PathState::ray, calls pathVertex, and looks whether anything
// lies in the way of the shadow ray that the step may leave. The includer provides SceneRef, every load...() that the
// included headers name, loadMaterial and loadMedium.
#ifndef RT_SHARED_PATH_STEP_H
#define RT_SHARED_PATH_STEP_H
#include "Bsdf.h"
#include "Camera.h"
#include "LightDensity.h"
#include "LightSelection.h"
#include "Media.h"
#include "Random.h"
#include "Sky.h"
#include "Surface.h"

RT_SHARED_BEGIN

const uint kTexturedFeatures = kFeatureChecker | kFeatureNoise | kFeatureImages;

const float kLeastSurvival = 0.05f; // of the roulette: bounds what a path may weigh

// A place where light scatters: a surface point or a collision in a medium.
struct Vertex {
    uint index;    // position along the path, 0 is what the camera sees
    uint inMedium; // 1: isotropic scattering, the fields up to albedo are unused
    uint front;    // 1: wo is on the front side
    Material material;
    vec3 normal;  // geometric, facing wo; zero in a medium
    vec3 shading; // of the bsdf frame, facing wo; zero in a medium
    vec3 wo;
    vec3 albedo;
    vec3 position;
    vec3 error;  // of position, per axis
    vec3 origin; // where rays on wo's side start
    VertexNumbers numbers;
};

// The path of a sample, given randomPair(smp, kPairPixel).
RT_FN PathState startPath(uint features, RT_IN(RenderParams) params, RT_IN(Camera) camera, RT_IN(Sampler) smp,
                          uvec2 pixel, vec2 pixelNumbers) {
    vec2 lens = vec2(0.5f, 0.5f);
    if (has(features, kFeatureThinLens)) lens = randomPair(smp, kPairLens);
    float time = 0.0f;
    if (has(features, kFeatureMotion)) time = randomPair(smp, kPairTime).x;
    PathState s;
    s.ray = generateCameraRay(features, camera, pixel, uvec2(params.width, params.height), pixelNumbers, lens, time);
    s.throughput = vec3(1.0f, 1.0f, 1.0f);
    s.radiance = vec3(0.0f, 0.0f, 0.0f);
    s.pdf = 0.0f;
    s.vertex = 0u;
    s.last.position = s.ray.origin;
    s.last.normal = vec3(0.0f, 0.0f, 0.0f);
    s.last.total = 0.0f;
    s.last.policy = kSelectUniform;
    return s;
}

// ---- emission -----------------------------------------------------------------------------------------------------

RT_FN bool usesMis(RT_IN(RenderParams) params) {
    return params.lightSampling >= kSampleMis;
}

// Weight of emission that a bsdf-sampled ray met, against next-event estimation with density lightDensity.
RT_FN float emissionWeight(RT_IN(RenderParams) params, float pdf, float lightDensity) {
    if (!usesMis(params) || pdf == 0.0f) return 1.0f;
    return params.lightSampling == kSampleMisBalance ? balanceHeuristic(pdf, lightDensity)
                                                     : powerHeuristic(pdf, lightDensity);
}

RT_FN void addSky(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_INOUT(PathState) s) {
    if (!has(features, kFeatureSky)) return;
    float weight = 1.0f;
    if (has(features, kFeatureSkyImage)) {
        RT_IN(SceneGlobals) globals = loadGlobals(scene);
        if (globals.skyLight != kNone && usesMis(params) && s.pdf > 0.0f) {
            float probability = lightProbability(features, scene, globals.lightCount, globals.skyLight, s.last);
            weight = emissionWeight(params, s.pdf, probability * skyPdf(scene, s.ray.direction));
        }
    }
    s.radiance += s.throughput * skyRadiance(features, scene, s.ray.direction) * weight;
}

// Emitted radiance at a point of a surface with this material, both sides alike.
RT_FN vec3 emittedRadiance(uint features, SceneRef scene, RT_IN(Material) material, vec3 position, vec2 uv) {
    if (material.emissionTexture == kNone) return material.emission;
    return material.emission *
           evalTexture(features, scene, material.emissionTexture, position + loadGlobals(scene).origin, uv);
}

RT_FN void addEmission(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Surface) surface,
                       RT_IN(Material) material, float distance, RT_INOUT(PathState) s) {
    if (!has(features, kFeatureEmissive) || maxComponent(material.emission) == 0.0f) return;
    bool front = dot(s.ray.direction, surface.normal) < 0.0f;
    if (!front && material.emissionSides != kSidesBoth) return;
    vec3 emitted = emittedRadiance(features, scene, material, surface.position, surface.uv);
    float weight = 1.0f;
    if (has(features, kFeatureLights) && surface.light != kNone && usesMis(params) && s.pdf > 0.0f) {
        float probability = lightProbability(features, scene, loadGlobals(scene).lightCount, surface.light, s.last);
        float density = lightPdf(features, params, loadLight(scene, surface.light), s.last.position, s.last.normal,
                                 s.ray.time, s.ray.direction, distance, surface.normal);
        weight = emissionWeight(params, s.pdf, probability * density);
    }
    s.radiance += s.throughput * emitted * weight;
}

// ---- scattering at a vertex ---------------------------------------------------------------------------------------

// f |cos| in rgb, density over solid angle of the bsdf's own sampling in w. Directions that cross the geometric surface
// are black, whatever the interpolated normal says.
RT_FN vec4 evalScattering(uint features, RT_IN(Vertex) v, vec3 wi) {
    if (has(features, kFeatureVolumes) && v.inMedium != 0u) {
        return vec4(v.albedo * kPhasePdf, kPhasePdf);
    }
    if (!(dot(wi, v.normal) > 0.0f)) return vec4(0.0f, 0.0f, 0.0f, 0.0f);
    return evalBsdf(features, v.material, v.albedo, v.shading, v.wo, wi);
}

RT_FN bool isDeltaVertex(uint features, RT_IN(Vertex) v) {
    if (has(features, kFeatureVolumes) && v.inMedium != 0u) return false;
    return isDelta(features, v.material);
}

RT_FN BsdfSample sampleScattering(uint features, RT_IN(Vertex) v, vec2 u) {
    if (has(features, kFeatureVolumes) && v.inMedium != 0u) return samplePhase(v.albedo, u);
    return sampleBsdf(features, v.material, v.albedo, v.shading, v.front, v.wo, u, u.x);
}

// Fraction of light that media let through along the ray up to tMax.
RT_FN float rayTransmittance(uint features, SceneRef scene, RT_IN(Ray) ray, float tMax) {
    if (!has(features, kFeatureVolumes)) return 1.0f;
    float depth = 0.0f;
    uint count = loadGlobals(scene).mediumCount;
    for (uint i = 0u; i < count; i++) {
        RT_IN(Medium) medium = loadMedium(scene, i);
        depth += medium.extinction * lengthWithin(mediumInterval(medium, ray.origin, ray.direction), tMax);
    }
    return transmittance(depth);
}

RT_FN LightContext lightContext(RT_IN(RenderParams) params, RT_IN(Vertex) v) {
    LightContext context;
    context.position = v.origin;
    context.normal = v.shading;
    context.total = 0.0f;
    context.policy = params.lightSelection;
    return context;
}

// The numbers that choose the light: the first of the pair that also places the point, unless there are so many lights
// that the choice would use up its bits.
RT_FN vec2 selectionNumbers(uint features, RT_IN(SceneGlobals) globals, RT_IN(Sampler) smp, RT_IN(Vertex) v) {
    if (!usesLightTree(features, globals.lightCount)) return v.numbers.light;
    return smp.kind == kSamplerSobol ? v.numbers.select : randomPair(smp, vertexPair(v.index, kPairSelect));
}

RT_FN LightSample sampleChosenLight(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Light) light,
                                    RT_IN(Vertex) v, float time, vec2 u) {
    if (has(features, kFeatureSkyImage) && light.kind == kLightSky) return sampleSky(scene, u);
    LightSample sampled = sampleLight(features, params, light, v.origin, v.shading, time, u);
    if (has(features, kTexturedFeatures) && light.material != kNone) {
        if (light.kind == kLightSphere) sampled.uv = sphereUv(sampled.normal);
        if (has(features, kFeatureEllipsoidLights) && light.kind == kLightEllipsoid) {
            sampled.uv = sphereUv(normalize(normalReach(light.edgeU, light.edgeV, light.normal, sampled.normal)));
        }
        sampled.radiance =
            emittedRadiance(features, scene, loadMaterial(scene, light.material), sampled.point, sampled.uv);
    }
    return sampled;
}

// Shadow rays end by this fraction early: a parameter t is known to a few roundings of itself, which exceeds any bound made of
// the light's coordinates when the light is far from the shading point but not from the origin.
const float kShadowMargin = 32.0f * kEpsilon;

RT_FN DirectLight noDirectLight() {
    DirectLight direct;
    direct.radiance = vec3(0.0f, 0.0f, 0.0f);
    direct.direction = vec3(0.0f, 0.0f, 0.0f);
    direct.distance = 0.0f;
    return direct;
}

// Next-event estimation: one light, one shadow ray, weighed against the bsdf's density.
RT_FN DirectLight sampleDirectLight(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp,
                                    RT_IN(Vertex) v, RT_INOUT(PathState) s) {
    DirectLight direct = noDirectLight();
    RT_IN(SceneGlobals) globals = loadGlobals(scene);
    vec2 u = v.numbers.light;
    LightChoice choice =
        chooseLight(features, scene, globals.lightCount, selectionNumbers(features, globals, smp, v), s.last);
    if (choice.light == kNone) return direct;
    RT_IN(Light) light = loadLight(scene, choice.light);
    if (!usesLightTree(features, globals.lightCount)) u.x = choice.u;
    LightSample sampled = sampleChosenLight(features, scene, params, light, v, s.ray.time, u);
    if (!(sampled.pdf > 0.0f)) return direct;
    vec4 f = evalScattering(features, v, sampled.wi);
    vec3 contribution = s.throughput * vec3(f) * sampled.radiance;
    if (!(maxComponent(contribution) > 0.0f)) return direct;
    // The weight and the division by the light's own density are one division.
    float density = choice.probability * sampled.pdf;
    float scattering = params.lightSampling == kSampleMisBalance ? f.w : f.w * (f.w / density);
    direct.radiance = contribution * (1.0f / (density + scattering));
    direct.direction = sampled.wi;
    direct.distance = kInfinity;
    if (light.kind == kLightSky) return direct;
    // The segment ends at the light's own offset point, so that the emitter does not shadow itself and no primitive has
    // to be excluded.
    vec3 end = offsetOrigin(sampled.point, lightPointError(features, light), sampled.normal, -sampled.wi);
    vec3 segment = end - v.origin;
    float whole = length(segment);
    direct.direction = segment / whole;
    direct.distance = whole * (1.0f - kShadowMargin);
    if (!(dot(segment, sampled.wi) > 0.0f)) {
        // Closer than rounding can tell apart: nothing fits in between.
        s.radiance += direct.radiance;
        direct.distance = 0.0f;
    }
    return direct;
}

RT_FN Ray shadowRay(RT_IN(PathState) s, RT_IN(DirectLight) direct) {
    Ray ray;
    ray.origin = s.last.position;
    ray.direction = direct.direction;
    ray.time = s.ray.time;
    return ray;
}

// To be called where no surface is in the way of shadowRay(s, direct).
RT_FN void addDirectLight(uint features, SceneRef scene, RT_IN(DirectLight) direct, RT_INOUT(PathState) s) {
    s.radiance += direct.radiance * rayTransmittance(features, scene, shadowRay(s, direct), direct.distance);
}

// ---- Shirley's mixture --------------------------------------------------------------------------------------------

// Probability of choosing entry i of lights and targets: targets share count / total, each the same.
RT_FN float mixtureProbability(uint features, SceneRef scene, RT_IN(SceneGlobals) globals, uint i,
                               RT_IN(LightContext) context) {
    float all = float(globals.lightCount + globals.targetCount);
    if (i >= globals.lightCount) return 1.0f / all;
    return float(globals.lightCount) / all * lightProbability(features, scene, globals.lightCount, i, context);
}

// Density over solid angle with which light sampling as a whole, occluded or not, proposes wi.
RT_FN float mixtureLightPdf(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(SceneGlobals) globals,
                            float time, vec3 wi, RT_IN(LightContext) context) {
    float sum = 0.0f;
    uint count = globals.lightCount + globals.targetCount;
    for (uint i = 0u; i < count; i++) {
        RT_IN(Light) light = loadLight(scene, i);
        float density = 0.0f;
        if (has(features, kFeatureSkyImage) && light.kind == kLightSky) {
            density = skyPdf(scene, wi);
        } else {
            density = lightPdfAlong(features, params, light, context.position, context.normal, time, wi);
        }
        if (density > 0.0f) sum += density * mixtureProbability(features, scene, globals, i, context);
    }
    return sum;
}

// Chooses a light or a target and a direction to it; a pdf of 0 where there is none.
RT_FN LightSample sampleMixtureLight(uint features, SceneRef scene, RT_IN(RenderParams) params,
                                     RT_IN(SceneGlobals) globals, RT_IN(Sampler) smp, RT_IN(Vertex) v, float time,
                                     RT_INOUT(LightContext) context) {
    vec2 u = v.numbers.light;
    vec2 pick = selectionNumbers(features, globals, smp, v);
    float split = float(globals.targetCount) / float(globals.lightCount + globals.targetCount);
    // The context is completed even when a target is chosen: the density of the direction sums over all of them.
    vec2 rest = vec2(stretch(pick.x, split, 1.0f), pick.y);
    LightChoice choice = chooseLight(features, scene, globals.lightCount, rest, context);
    if (pick.x < split) {
        float position = pick.x / split * float(globals.targetCount);
        uint target = min(uint(position), globals.targetCount - 1u);
        choice.light = globals.lightCount + target;
        choice.u = clamp(position - float(target), 0.0f, 0.999999940395355f);
    }
    if (choice.light == kNone) return noLightSample();
    if (!usesLightTree(features, globals.lightCount)) u.x = choice.u;
    return sampleChosenLight(features, scene, params, loadLight(scene, choice.light), v, time, u);
}

// Replaces the bsdf's direction by that of the one-sample mixture: half from the lights, half from the bsdf.
RT_FN BsdfSample sampleMixture(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp,
                               RT_IN(Vertex) v, RT_IN(BsdfSample) b, float time, RT_INOUT(LightContext) context) {
    RT_IN(SceneGlobals) globals = loadGlobals(scene);
    if (globals.lightCount + globals.targetCount == 0u) return b;
    LightSample sampled = sampleMixtureLight(features, scene, params, globals, smp, v, time, context);
    // Where no light can contribute and there is no target, the lights' half of the mixture would be empty.
    bool lightless = context.policy == kSelectContribution && !(context.total > 0.0f);
    if (lightless && globals.targetCount == 0u) return b;
    BsdfSample mixed = b;
    mixed.weight = vec3(0.0f, 0.0f, 0.0f);
    if (v.numbers.choice.y < 0.5f) {
        if (!(sampled.pdf > 0.0f)) return mixed;
        mixed.wi = sampled.wi;
    }
    vec4 f = evalScattering(features, v, mixed.wi);
    float pdf = 0.5f * f.w + 0.5f * mixtureLightPdf(features, scene, params, globals, time, mixed.wi, context);
    mixed.pdf = pdf;
    if (pdf > 0.0f) mixed.weight = vec3(f) / pdf;
    return mixed;
}

// ---- a step -------------------------------------------------------------------------------------------------------

// Continues the path from v. False: it ends here. Either way `direct` may be left to be checked.
RT_FN bool scatter(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp, RT_IN(Vertex) v,
                   RT_INOUT(PathState) s, RT_INOUT(DirectLight) direct) {
    bool delta = isDeltaVertex(features, v);
    if (!has(features, kLightChosen)) s.last = lightContext(params, v);
    bool lights = has(features, kFeatureLights | kFeatureTargets) && !delta;
    if (lights && usesMis(params)) direct = sampleDirectLight(features, scene, params, smp, v, s);

    BsdfSample b = sampleScattering(features, v, v.numbers.bsdf);
    if (has(features, kFeatureMixture) && lights && params.lightSampling == kSampleMixture) {
        b = sampleMixture(features, scene, params, smp, v, b, s.ray.time, s.last);
    }
    s.throughput *= b.weight;
    float strongest = maxComponent(s.throughput);
    if (!(strongest > 0.0f)) return false;
    if (v.inMedium == 0u) {
        // A sample that leaks through the geometric surface is black.
        float side = dot(b.wi, v.normal);
        if (b.transmitted != 0u ? !(side < 0.0f) : !(side > 0.0f)) return false;
        s.ray.origin = b.transmitted != 0u ? offsetOrigin(v.position, v.error, v.normal, b.wi) : v.origin;
    } else {
        s.ray.origin = v.origin;
    }
    s.ray.direction = b.wi;
    s.pdf = b.delta != 0u ? 0.0f : b.pdf;
    if (params.russianRoulette != 0u && v.index > 0u) {
        float survival = clamp(float(params.russianRoulette) * strongest, kLeastSurvival, 1.0f);
        if (v.numbers.choice.x >= survival) return false;
        s.throughput /= survival;
    }
    return true;
}

// Nearest collision in any medium before tMax: each medium's free flight is exponential, and the least of independent
// exponentials is a flight through their summed extinction that ends in each with its share. medium is kNone if there
// is none.
RT_FN float sampleCollision(SceneRef scene, RT_IN(Ray) ray, float tMax, RT_IN(Sampler) smp, uint vertex,
                            RT_INOUT(uint) medium) {
    float nearest = tMax;
    medium = kNone;
    uint count = loadGlobals(scene).mediumCount;
    for (uint i = 0u; i < count; i++) {
        RT_IN(Medium) candidate = loadMedium(scene, i);
        vec2 span = mediumInterval(candidate, ray.origin, ray.direction);
        float entry = max(span.x, 0.0f);
        float leave = min(span.y, nearest);
        if (!(entry < leave)) continue;
        float u = randomFine(smp, vertexPair(vertex, kPairMedium) + (i << 16u));
        float t = entry + sampleFreeFlight(u, candidate.extinction);
        if (t < leave) {
            nearest = t;
            medium = i;
        }
    }
    return nearest;
}

RT_FN vec3 texturedAlbedo(uint features, SceneRef scene, vec3 constant, uint texture, vec3 position, vec2 uv) {
    if (!has(features, kTexturedFeatures) || texture == kNone) return constant;
    return evalTexture(features, scene, texture, position + loadGlobals(scene).origin, uv);
}

// The material of what has none.
RT_FN Material blackMaterial() {
    Material m;
    m.kind = kMaterialEmitter;
    m.albedo = vec3(0.0f, 0.0f, 0.0f);
    m.texture = kNone;
    m.fuzz = 0.0f;
    m.ior = 1.0f;
    m.emission = vec3(0.0f, 0.0f, 0.0f);
    m.emissionTexture = kNone;
    m.emissionSides = kSidesFront;
    return m;
}

RT_FN Vertex mediumVertex(uint features, SceneRef scene, RT_IN(PathState) s, float t, uint index) {
    RT_IN(Medium) medium = loadMedium(scene, index);
    Vertex v;
    v.index = s.vertex - 1u;
    v.inMedium = 1u;
    v.front = 1u;
    v.material = blackMaterial();
    v.normal = vec3(0.0f, 0.0f, 0.0f);
    v.shading = vec3(0.0f, 0.0f, 0.0f);
    v.wo = -s.ray.direction;
    v.position = s.ray.origin + s.ray.direction * t;
    v.error = vec3(0.0f, 0.0f, 0.0f);
    v.origin = v.position;
    v.albedo = texturedAlbedo(features, scene, medium.albedo, medium.texture, v.position, vec2(0.0f, 0.0f));
    return v;
}

RT_FN Vertex surfaceVertex(uint features, SceneRef scene, RT_IN(PathState) s, RT_IN(Surface) surface,
                           RT_IN(Material) material) {
    Vertex v;
    v.index = s.vertex - 1u;
    v.inMedium = 0u;
    v.wo = -s.ray.direction;
    v.front = dot(v.wo, surface.normal) > 0.0f ? 1u : 0u;
    v.material = material;
    v.normal = v.front != 0u ? surface.normal : -surface.normal;
    v.shading = v.front != 0u ? surface.shading : -surface.shading;
    if (!(dot(v.wo, v.shading) > 0.0f)) v.shading = v.normal;
    v.position = surface.position;
    v.error = surface.error;
    v.origin = offsetOrigin(surface.position, surface.error, v.normal, v.normal);
    v.albedo = texturedAlbedo(features, scene, material.albedo, material.texture, surface.position, surface.uv);
    return v;
}

// Added to `features` by those who complete the context and make the choice of a light before they call scatter() themselves.
const uint kLightAwaited = 2u * kLightChosen;

// Advances the path by one vertex, given what s.ray meets and vertexNumbers(smp, s.vertex). False: it has ended, and s.radiance
// is its estimate once `direct`, which the caller sets to noDirectLight(), has been added if it arrives. With kLightAwaited it
// only gets to the vertex, which is v.
RT_FN bool pathVertex(RT_LARGE_INOUT(Vertex, v) uint features, SceneRef scene, RT_IN(RenderParams) params,
                      RT_IN(Sampler) smp, RT_IN(VertexNumbers) numbers, RT_IN(Hit) hit, RT_INOUT(PathState) s,
                      RT_INOUT(DirectLight) direct) {
    uint medium = kNone;
    float t = hit.t < 0.0f ? kInfinity : hit.t;
    if (has(features, kFeatureVolumes)) t = sampleCollision(scene, s.ray, t, smp, s.vertex, medium);
    s.vertex++;
    RT_LARGE_VARIABLE(Vertex, v)
    if (has(features, kFeatureVolumes) && medium != kNone) {
        if (s.vertex >= params.maxDepth) return false;
        v = mediumVertex(features, scene, s, t, medium);
    } else {
        if (hit.t < 0.0f) {
            addSky(features, scene, params, s);
            return false;
        }
        Surface surface = makeSurface(features, scene, s.ray, hit);
        Material material = loadMaterial(scene, surface.material); // the vertex keeps parts of it, in registers
        addEmission(features, scene, params, surface, material, hit.t, s);
        if (s.vertex >= params.maxDepth || material.kind == kMaterialEmitter) return false;
        v = surfaceVertex(features, scene, s, surface, material);
    }
    v.numbers = numbers;
    if (has(features, kLightAwaited)) return true;
    return scatter(features, scene, params, smp, v, s, direct);
}

RT_SHARED_END

#endif
