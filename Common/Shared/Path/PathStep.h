// One vertex of a path: emission, next-event estimation, scattering, roulette. Both engines run this very code; the loop
// around it is theirs.
//
//        ray           pathVertex
//   o---------->x   emission weighed against the light sampling of the vertex before
//               |\__ one shadow ray to a chosen light          (mis)
//               v    next ray from the bsdf, or from a light   (mixture)
//
// The engine traces. For each step it finds the nearest hit of PathState::ray, calls pathVertex, and looks whether anything
// lies in the way of the shadow ray that the step may leave.
#ifndef RT_SHARED_PATH_STEP_H
#define RT_SHARED_PATH_STEP_H
#include "Common/Shared/Camera.h"
#include "Common/Shared/Path/Mixture.h"

RT_SHARED_BEGIN

const float kLeastSurvival = 0.05f; // of the roulette: bounds what a path may weigh

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

// Whether lights are sampled from v.
RT_FN bool isLitByLights(uint features, RT_IN(Vertex) v) {
    return has(features, kFeatureLights | kFeatureTargets) && !isDeltaVertex(features, v);
}

// Continues the path from v into the direction b. False: it ends here.
RT_FN bool follow(RT_IN(RenderParams) params, RT_IN(Vertex) v, RT_IN(BsdfSample) b, RT_INOUT(PathState) s) {
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

// Next-event estimation at v, and the continuation of the path. False: it ends here. Either way `direct` may be left to be
// checked.
RT_FN bool scatter(uint features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp, RT_IN(Vertex) v,
                   RT_INOUT(PathState) s, RT_INOUT(DirectLight) direct) {
    bool lights = isLitByLights(features, v);
    if (lights && usesMis(params)) {
        RT_IN(SceneGlobals) globals = loadGlobals(scene);
        vec2 u = selectionNumbers(features, globals, smp, v);
        LightChoice choice = chooseLight(features, scene, globals.lightCount, u, s.last);
        direct = sampleDirectLight(features, scene, params, choice, v, s);
        addUnshadowed(direct, s);
    }
    BsdfSample b = sampleScattering(features, v, v.numbers.bsdf);
    if (has(features, kFeatureMixture) && lights && params.lightSampling == kSampleMixture) {
        b = sampleMixture(features, scene, params, smp, v, b, s.ray.time, s.last);
    }
    return follow(params, v, b, s);
}

// Added to `features` by those who go on from the vertex themselves.
const uint kVertexOnly = 1u << kFeatureBits;

// Advances the path by one vertex, given what s.ray meets and vertexNumbers(smp, s.vertex). False: it has ended, and s.radiance
// is its estimate once `direct`, which the caller sets to noDirectLight(), has been added if it arrives. With kVertexOnly it
// only gets to the vertex, which is v, and does not read the numbers.
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
        placeInMedium(features, scene, s, t, medium, v);
    } else {
        if (hit.t < 0.0f) {
            addSky(features, scene, params, s);
            return false;
        }
        Surface surface = makeSurface(features, scene, s.ray, hit);
        Material material = loadMaterial(scene, surface.material); // the vertex keeps parts of it, in registers
        addEmission(features, scene, params, surface, material, hit.t, s);
        if (s.vertex >= params.maxDepth || material.kind == kMaterialEmitter) return false;
        placeOnSurface(features, scene, s, surface, material, v);
    }
    s.last = lightContext(params, v);
    if (has(features, kVertexOnly)) return true;
    v.numbers = numbers;
    return scatter(features, scene, params, smp, v, s, direct);
}

RT_SHARED_END

#endif
