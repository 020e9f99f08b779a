// A path, vertex by vertex. Each vertex goes through these stages:
//
//   arrive                 collision in a medium, emission weighed against the light sampling of the vertex before,
//                          surface, what of the path is shared
//   choose a light         mis, mixture: chooseLight() by lightSelectionSample()
//   sample and weigh it    mis: sampleDirectLight(), which leaves a shadow ray
//   connect                mis, with smooth spheres: connectLight(), which leaves two or three segments
//   scatter                the bsdf's sample, or in its place the mixture's, or one that is aimed at glass
//   go on                  throughput, next ray, roulette
//
//        ray            vertex
//   o---------->x   arrive
//               |\__ shadow ray to the chosen light      (mis)
//               v    next ray, by the bsdf or to a light (mixture)
//
// The engines trace: the nearest hit of PathState::ray before a vertex is arrived at, and whether anything lies in the
// way of the shadow ray that it leaves, and then of the segments of its connection. stepPath() strings the stages
// together for one path; the CPU does so for a packet of paths.
#ifndef RT_SHARED_PATH_STEP_H
#define RT_SHARED_PATH_STEP_H
#include "Common/Shared/Camera.h"
#include "Common/Shared/Path/AimedScattering.h"
#include "Common/Shared/Path/ConnectionChain.h"
#include "Common/Shared/Path/Mixture.h"
#include "Common/Shared/Path/PathReuse.h"

RT_SHARED_BEGIN

const float kMinSurvival = 0.05f; // of the roulette: bounds what a path may weigh

// The ray of a sample from the camera.
RT_FN Ray cameraRay(Features features, RT_IN(RenderParams) params, RT_IN(Camera) camera, uvec2 pixel,
                    RT_IN(CameraSamples) u) {
    return generateCameraRay(features, camera, pixel, uvec2(params.width, params.height), u.pixel, u.lens, u.time.x);
}

// The path that begins with a camera ray.
RT_FN PathState startPath(RT_IN(Ray) ray) {
    PathState s;
    s.ray = ray;
    s.throughput = vec3(1.0f, 1.0f, 1.0f);
    s.radiance = vec3(0.0f, 0.0f, 0.0f);
    s.pdf = 0.0f;
    s.vertex = 0u;
    s.last.position = ray.origin;
    s.last.normal = vec3(0.0f, 0.0f, 0.0f);
    s.last.total = 0.0f;
    s.last.policy = kSelectUniform;
    s.chain.from = vec3(0.0f, 0.0f, 0.0f);
    s.chain.pdf = 0.0f;
    s.chain.rate = 0.0f;
    s.chain.sphere = kNone;
    s.chain.met = kNone;
    s.chain.state = kChainNone;
    s.reuse = kReuseBefore;
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
        float u = sampleFine(smp, vertexDimension(vertex, kDimensionMedium) + (i << 16u));
        float t = entry + sampleFreeFlight(u, candidate.extinction);
        if (t < leave) {
            nearest = t;
            medium = i;
        }
    }
    return nearest;
}

// What a principled material absorbs of a path that meets it from inside, by Beer's law.
RT_FN void absorbInside(SceneRef scene, RT_IN(Surface) surface, float distance, RT_INOUT(PathState) s) {
    if (dot(s.ray.direction, surface.normal) < 0.0f) return;
    vec3 depth = loadPrincipled(scene, surface.material).absorption * distance;
    s.throughput *= vec3(exponential(-depth.x), exponential(-depth.y), exponential(-depth.z));
}

// With kMethodConnections: follows the path's chain to what it has hit, and returns the weight of emission there.
RT_FN float weighChain(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Hit) hit,
                       RT_IN(Surface) surface, RT_INOUT(PathState) s) {
#ifdef RT_HEAVY_FEATURES
    if (has(features, kMethodConnections)) {
        arriveChain(scene, params, hit, s);
        if (s.chain.state >= kChainBeyond && surface.light != kNone) {
            return connectionWeight(features, scene, params, s, surface.light, surface.position, surface.normal);
        }
    }
#endif
    return 1.0f;
}

// With kMethodConnections: the weight of the sky that the path has left for.
RT_FN float weighSkyChain(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(PathState) s) {
#ifdef RT_HEAVY_FEATURES
    if (has(features, kMethodConnections) && has(features, kFeatureSkyImage) && s.chain.state >= kChainBeyond) {
        uint sky = loadGlobals(scene).skyLight;
        if (sky != kNone) return connectionWeight(features, scene, params, s, sky, vec3(0.0f), vec3(0.0f));
    }
#endif
    return 1.0f;
}

// Whether edge rays that arrive at v take a sample of the light that it reflects.
RT_FN bool splitsGlossyHit(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v) {
    return has(features, kFeatureLights) && usesMis(params) && v.inMedium == 0u && isMetal(features, v.bsdf) &&
           isBlurredMirror(features, v.bsdf);
}

// Whether that light is left to edge rays by the path, which has arrived at v.
RT_FN bool leavesGlossyHit(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v, RT_IN(PathState) s) {
    return has(features, kFeatureLights) && s.pdf == kCountedApart && splitsGlossyHit(features, params, v);
}

// Arrives at the next vertex of the path, v, given what s.ray hits; it has yet to be completed. `prefix`: see
// followReuse(). False: the path has ended.
RT_FN bool arrive(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp, RT_IN(Hit) hit,
                  RT_INOUT(PathState) s, RT_INOUT(vec3) prefix, RT_OUT(Vertex) v) {
    uint medium = kNone;
    float t = hit.t < 0.0f ? kInfinity : hit.t;
    if (has(features, kFeatureVolumes)) t = sampleCollision(scene, s.ray, t, smp, s.vertex, medium);
    s.vertex++;
    if (has(features, kFeatureVolumes) && medium != kNone) {
        if (s.vertex >= params.maxDepth) s.pdf = kCutOff;
        if (s.vertex >= params.maxDepth || isEdgeRay(features, s)) return false;
        placeInMedium(features, scene, s, t, medium, v);
    } else {
        if (hit.t < 0.0f) {
            addSky(features, scene, params, weighSkyChain(features, scene, params, s), s);
            return false;
        }
        Surface surface = makeSurface(features, scene, s.ray, hit);
        Material material = loadMaterial(scene, surface.material); // the vertex keeps parts of it, in registers
        if (isPrincipled(features, material)) absorbInside(scene, surface, hit.t, s);
        float chainWeight = weighChain(features, scene, params, hit, surface, s);
        addEmission(features, scene, params, surface, material, hit.t, chainWeight, s);
        if (material.kind == kMaterialEmitter) return false;
        if (s.vertex >= params.maxDepth) {
            s.pdf = kCutOff;
            return false;
        }
        placeOnSurface(features, scene, s, surface, material, v);
        if (isEdgeRay(features, s) && !isDelta(features, v.bsdf) && !splitsGlossyHit(features, params, v)) return false;
        if (reusesPaths(features, params)) followReuse(features, surface, v, s, prefix);
    }
    s.last = lightContext(params, v);
    return true;
}

// Goes on from v into the direction that b sampled; `survival` decides the roulette. False: the path ends here.
RT_FN bool goOn(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v, RT_IN(BsdfSample) b, float survival,
                RT_INOUT(PathState) s) {
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
    // Light beyond the surface is not sampled from v, so what transmitted rays meet counts in full.
    // What edge rays count, they count behind mirrors and glass, too, and behind the first mirror that is blurred.
    bool leaves = leavesGlossyHit(features, params, v, s);
    bool isSplit = splitsGlossyHit(features, params, v) && isEdgeRay(features, s);
    bool staysApart = has(features, kFeatureLights) && s.pdf < 0.0f && v.inMedium == 0u && isDelta(features, v.bsdf);
    if (isBehindGlossyHit(features, s)) staysApart = false;
    if (!staysApart) s.pdf = b.delta != 0u || b.transmitted != 0u ? 0.0f : b.pdf;
    if (leaves) s.pdf = kBlurCountedApart;
    if (isSplit) s.vertex = params.maxDepth - 1u; // it ends at the next one
    // What is shared was drawn with the density of scattering, and no other.
    bool mayEnd = v.index > 0u && !(reusesPaths(features, params) && s.reuse == kReuseFirst);
    // What is aimed at glass weighs little, but the light is just behind it.
    if (aimsPaths(features, params) && s.reuse == kReuseEnded && b.delta != 0u) mayEnd = false;
    if (isSplit) mayEnd = false;
    if (params.russianRoulette != 0u && mayEnd) {
        float survivors = float(params.russianRoulette) * strongest;
        if (isEdgeRay(features, s)) survivors *= float(params.edgeRays);
        if (reusesPaths(features, params) && s.reuse == kReuseSuffix) survivors *= kReuseSurvival;
        float probability = clamp(survivors, kMinSurvival, 1.0f);
        if (survival >= probability) return false;
        s.throughput /= probability;
    }
    return true;
}

// All stages of one vertex of a path, given what s.ray hits. False: it has ended, and s.radiance is its estimate once
// `passage` and `direct`, which the caller sets to noConnection() and noDirectLight(), have been added if they arrive.
RT_FN bool stepPath(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp, RT_IN(Hit) hit,
                    RT_INOUT(PathState) s, RT_INOUT(SharedPart) part, RT_INOUT(DirectLight) direct,
                    RT_INOUT(SpecularConnection) connection) {
    Vertex v;
    if (!arrive(features, scene, params, smp, hit, s, part.prefix, v)) return false;
    completeVertex(features, scene, v);
    VertexSamples u = vertexSamples(features, smp, v.index);
    RT_IN(SceneGlobals) globals = loadGlobals(scene);
    bool nextEvent = usesNextEventEstimation(features, params, globals, v) && !leavesGlossyHit(features, params, v, s);
    bool mixture = usesMixture(features, params, globals, v);
    LightChoice choice = noLightChoice();
    if (nextEvent || mixture) {
        vec2 selection = lightSelectionSample(features, params, globals, u);
        choice = chooseLight(features, scene, globals.lightCount, selection, s.last);
    }
    if (nextEvent) {
        direct = sampleDirectLight(features, scene, params, choice, v, u, s);
        addUnshadowed(direct, s);
    }
#ifdef RT_HEAVY_FEATURES
    if (has(features, kMethodConnections) && nextEvent)
        connection = connectLight(features, scene, params, smp, v, u, s);
#endif
    BsdfSample b = sampleScattering(features, v, u.bsdf);
    if (mixture) b = sampleMixture(features, scene, params, choice, v, u, b, s.ray.time, s.last);
    if (aimsPaths(features, params) && s.reuse == kReuseFirst) {
        part.throughput = s.throughput * b.weight;
        part.aimed = aimedShare(globals.aimed, v.origin, s.last.total);
        if (part.aimed > 0.0f) b = aimScattering(globals.aimed, v, u.bsdf, u.roulette.y, part.aimed, b);
    }
#ifdef RT_HEAVY_FEATURES
    if (has(features, kMethodConnections)) goOnChain(v, b, s);
#endif
    return goOn(features, params, v, b, u.roulette.x, s);
}

RT_SHARED_END

#endif
