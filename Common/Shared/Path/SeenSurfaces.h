// What the camera sees of a scene's surfaces, which tells pixels apart without the noise of their light: of the first
// one that a sample meets, and of the first that scatters widely. To that one a path goes on through mirrors and clear
// glass, where the same random number as in a render chooses between reflection and refraction, so that means over
// samples are those of what a render averages. Media are looked through.
#ifndef RT_SHARED_SEEN_SURFACES_H
#define RT_SHARED_SEEN_SURFACES_H
#include "Common/Shared/Path/PathStep.h"

RT_SHARED_BEGIN

// Samples of features are a scrambling of their own, which no replicate of a film has: what the denoiser fits radiance
// by must not know its noise.
const uint kFeatureReplicate = 0xffffffffu;

const uint kMaxSeenDepth = 16u; // vertices of a path that looks through mirrors and glass

// Sums over samples of a pixel.
struct SurfaceSums {
    vec3 albedo;
    vec3 normal; // shading, facing the ray
    float depth; // length of the path from the camera
    uint hits;   // samples that have met such a surface
};

struct SeenSurfaces {
    SurfaceSums first;
    SurfaceSums wide; // the albedo is times the throughput
    vec3 emission;    // met on the way there, the sky's too
};

RT_FN SurfaceSums noSurfaces() {
    SurfaceSums sums;
    sums.albedo = vec3(0.0f, 0.0f, 0.0f);
    sums.normal = vec3(0.0f, 0.0f, 0.0f);
    sums.depth = 0.0f;
    sums.hits = 0u;
    return sums;
}

RT_FN SeenSurfaces nothingSeen() {
    SeenSurfaces seen;
    seen.first = noSurfaces();
    seen.wide = noSurfaces();
    seen.emission = vec3(0.0f, 0.0f, 0.0f);
    return seen;
}

RT_FN void addSurface(vec3 albedo, vec3 normal, float depth, RT_INOUT(SurfaceSums) sums) {
    sums.albedo += albedo;
    sums.normal += normal;
    sums.depth += depth;
    sums.hits++;
}

// The mean depth, of the samples that have met a surface; 0 if none has.
RT_FN float meanDepth(RT_IN(SurfaceSums) sums) {
    return sums.hits > 0u ? sums.depth / float(sums.hits) : 0.0f;
}

// Adds the surface that the path's ray has hit; `before`: the length of the path up to there, which grows. True: it
// goes on from a mirror or clear glass. Without `looksThrough` it ends at the first surface, and nothing but that is
// added.
RT_FN bool seeSurface(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp, RT_IN(Hit) hit,
                      bool looksThrough, RT_INOUT(PathState) s, RT_INOUT(float) before, RT_INOUT(SeenSurfaces) seen) {
    if (hit.t < 0.0f) {
        if (looksThrough) addSky(features, scene, params, 1.0f, s);
        return false;
    }
    Surface surface = makeSurface(features, scene, s.ray, hit);
    Material material = loadMaterial(scene, surface.material);
    vec3 albedo = surfaceAlbedo(features, scene, material, surface);
    vec3 normal = dot(s.ray.direction, surface.normal) < 0.0f ? surface.shading : -surface.shading;
    before += hit.t;
    if (s.vertex == 0u) addSurface(albedo, normal, before, seen.first);
    if (!looksThrough) return false;
    if (isPrincipled(features, material)) absorbInside(scene, surface, hit.t, s);
    addEmission(features, scene, params, surface, material, hit.t, 1.0f, s);
    s.vertex++;
    Vertex v;
    placeOnSurface(features, scene, s, surface, material, v);
    completeVertex(features, scene, v);
    bool ends = scattersWidely(v.bsdf) || material.kind == kMaterialEmitter;
    if (ends || s.vertex == min(params.maxDepth, kMaxSeenDepth)) {
        addSurface(s.throughput * albedo, normal, before, seen.wide);
        return false;
    }
    BsdfSample b = sampleScattering(features, v, vertexSample(features, smp, v.index, kDimensionBsdf));
    s.pdf = 0.0f; // what is met next counts in full
    return leaveVertex(v, b, s);
}

RT_SHARED_END

#endif
