// The path tracer: a path, vertex by vertex. Each vertex goes through these stages:
//
//   shadeHit             collision in a medium, emission weighed against the light sampling of the vertex before, surface,
//                        its colour channel where glass disperses, its side where light is transmitted diffusely
//   choose a light       mis, mixture: chooseLight() by lightSelectionSample()
//   sample and weigh it  mis: sampleDirectLight(), which leaves a shadow ray
//   scatter              the bsdf's sample, or in its place the mixture's
//   continuePath         throughput, next ray, Russian roulette
//
//        ray            vertex
//   o---------->x   shadeHit
//               |\__ shadow ray to the chosen light      (mis)
//               v    next ray, by the bsdf or to a light (mixture)
//
// The engines trace: the nearest hit of PathState::ray before its vertex is shaded, and whether anything lies in the way
// of the shadow ray that it leaves. stepPath() strings the stages together for one path; the CPU runs them for a packet
// of paths. What goes beyond this path takes part through the hooks of Techniques.h.
#ifndef RT_SHARED_PATH_STEP_H
#define RT_SHARED_PATH_STEP_H
#include "Common/Shared/Camera.h"
#include "Common/Shared/Path/Mixture.h"
#include "Common/Shared/Path/VertexChoice.h"
#include "Common/Shared/Technique/Techniques.h"

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
    beginTechniques(s);
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

// Whether max depth ends the path, which would go on here.
RT_FN bool endsAtMaxDepth(RT_IN(RenderParams) params, RT_INOUT(PathState) s) {
    if (s.vertex < params.maxDepth) return false;
    s.vertex = params.maxDepth + 1u;
    return true;
}

// Whether it has ended the path.
RT_FN bool isCutOff(RT_IN(RenderParams) params, RT_IN(PathState) s) {
    return s.vertex > params.maxDepth;
}

// What a path that has been cut off would have gone on with, the mean of the channels; times what came `before` where
// throughput has begun anew.
RT_FN float cutOffThroughput(RT_IN(PathState) s, vec3 before) {
    vec3 throughput = s.throughput * before;
    return (throughput.x + throughput.y + throughput.z) * (1.0f / 3.0f);
}

// Shades what s.ray hits: adds the light that it finds there and makes the path's next vertex, v, which has yet to be
// completed. False: the path has ended.
RT_FN bool shadeHit(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp, RT_IN(Hit) hit,
                    RT_INOUT(PathState) s, RT_INOUT(TechniqueStep) step, RT_OUT(Vertex) v) {
    uint medium = kNone;
    float t = hit.t < 0.0f ? kInfinity : hit.t;
    if (has(features, kFeatureVolumes)) t = sampleCollision(scene, s.ray, t, smp, s.vertex, medium);
    s.vertex++;
    if (has(features, kFeatureVolumes) && medium != kNone) {
        if (endsAtMaxDepth(params, s) || !goOnInMedium(features, s)) return false;
        placeInMedium(features, scene, s, t, medium, v);
    } else {
        if (hit.t < 0.0f) {
            addSky(features, scene, params, techniqueSkyShare(features, scene, params, s), s);
            return false;
        }
        Surface surface = makeSurface(features, scene, s.ray, hit);
        Material material = loadMaterial(scene, surface.material); // the vertex keeps parts of it, in registers
        if (isPrincipled(features, material)) absorbInside(scene, surface, hit.t, s);
        float share = techniqueEmissionShare(features, scene, params, hit, surface, s);
        addEmission(features, scene, params, surface, material, hit.t, share, s);
        if (material.kind == kMaterialEmitter || endsAtMaxDepth(params, s)) return false;
        placeOnSurface(features, scene, s, surface, material, v);
        chooseChannel(features, scene, smp, surface.material, s, v);
        chooseSide(features, smp, s, v);
        if (!goOnAtSurface(features, params, surface, v, s, step)) return false;
    }
    s.last = lightContext(v);
    return true;
}

// Whether a light is chosen and sampled at v, whose light is added if it arrives.
RT_FN bool samplesLight(Features features, RT_IN(RenderParams) params, RT_IN(SceneGlobals) globals, RT_IN(Vertex) v,
                        RT_IN(PathState) s) {
    return usesNextEventEstimation(features, params, globals, v) && !leavesLight(features, params, v, s);
}

// Throughput and ray of the path that leaves v in the direction that b sampled. False: nothing goes there.
RT_FN bool leaveVertex(RT_IN(Vertex) v, RT_IN(BsdfSample) b, RT_INOUT(PathState) s) {
    s.throughput *= b.weight;
    if (!(maxComponent(s.throughput) > 0.0f)) return false;
    s.ray.origin = v.origin;
    if (v.inMedium == 0u) {
        // A sample that leaks through the geometric surface is black.
        float side = dot(b.wi, v.normal);
        if (b.transmitted != 0u ? !(side < 0.0f) : !(side > 0.0f)) return false;
        if (b.transmitted != 0u) s.ray.origin = offsetOrigin(v.position, v.error, v.normal, b.wi);
    }
    s.ray.direction = b.wi;
    return true;
}

// Continues the path from v into the direction that b sampled; `survival` decides the roulette. False: it ends here.
RT_FN bool continuePath(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v, RT_IN(BsdfSample) b,
                        float survival, RT_INOUT(PathState) s) {
    if (!leaveVertex(v, b, s)) return false;
    // Light beyond the surface is not sampled from v, so what transmitted rays meet counts in full.
    s.pdf = b.delta != 0u || b.transmitted != 0u ? 0.0f : b.pdf;
    Roulette roulette = techniqueRoulette(features, params, v, b, s);
    if (params.russianRoulette == 0u || v.index == 0u || !roulette.mayEnd) return true;
    float survivors = float(params.russianRoulette) * maxComponent(s.throughput) * roulette.odds;
    float probability = clamp(survivors, kMinSurvival, 1.0f);
    if (survival >= probability) return false;
    s.throughput /= probability;
    return true;
}

// All stages of one vertex of a path, given what s.ray hits. False: it has ended, and s.radiance is its estimate once
// `direct`, which the caller sets to noDirectLight(), has been added if it arrives.
RT_FN bool stepPath(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp, RT_IN(Hit) hit,
                    RT_INOUT(PathState) s, RT_INOUT(DirectLight) direct, RT_INOUT(TechniqueStep) step) {
    Vertex v;
    step.part = nothingShared(); // no engine carries it along from the step before
    if (!shadeHit(features, scene, params, smp, hit, s, step, v)) return false;
    completeVertex(features, scene, v);
    VertexSamples u = vertexSamples(features, smp, v.index);
    RT_IN(SceneGlobals) globals = loadGlobals(scene);

    bool nextEvent = samplesLight(features, params, globals, v, s);
    bool mixture = usesMixture(features, params, globals, v);
    LightChoice choice = noLightChoice();
    if (nextEvent || mixture) {
        vec2 selection = lightSelectionSample(features, params, globals, u);
        choice = chooseLight(features, scene, params.lightSelection, globals.lightCount, selection, s.last);
    }
    if (nextEvent) {
        direct = sampleDirectLight(features, scene, params, choice, v, u, s);
        addUnshadowed(direct, s);
        techniquesAtLight(features, scene, params, smp, v, u, s, step);
    }

    BsdfSample b = sampleScattering(features, v, u.bsdf);
    if (mixture) b = sampleMixture(features, scene, params, choice, v, u, b, s.ray.time, s.last);
    techniquesAtScattering(features, scene, params, v, u, b, s, step);
    return continuePath(features, params, v, b, u.roulette.x, s);
}

RT_SHARED_END

#endif
