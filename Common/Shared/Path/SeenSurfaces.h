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

RT_FN void addSurfaces(RT_IN(SurfaceSums) more, RT_INOUT(SurfaceSums) sums) {
    sums.albedo += more.albedo;
    sums.normal += more.normal;
    sums.depth += more.depth;
    sums.hits += more.hits;
}

RT_FN void addSeen(RT_IN(SeenSurfaces) more, RT_INOUT(SeenSurfaces) seen) {
    addSurfaces(more.first, seen.first);
    addSurfaces(more.wide, seen.wide);
    seen.emission += more.emission;
}

// The mean depth, of the samples that have met a surface; 0 if none has.
RT_FN float meanDepth(RT_IN(SurfaceSums) sums) {
    return sums.hits > 0u ? sums.depth / float(sums.hits) : 0.0f;
}

// Most pixels see one surface and no edge of it or of its texture: few samples tell their features. The first ones are
// taken of some pixels beside one another in a row, so that an edge, or a texture finer than a pixel, is hardly missed
// by all of them; the others where these differ. kSeenTogether: the pixels.
const uint kFirstSeenSamples = 4u; // of each

// Between what the first surfaces of some samples lie.
struct SurfaceRange {
    vec3 minAlbedo, maxAlbedo;
    vec3 minNormal, maxNormal;
    float minDepth, maxDepth;
    uint samples, hits;
};

RT_FN SurfaceRange emptyRange() {
    SurfaceRange range;
    range.minAlbedo = range.minNormal = vec3(kInfinity, kInfinity, kInfinity);
    range.maxAlbedo = range.maxNormal = -range.minAlbedo;
    range.minDepth = kInfinity;
    range.maxDepth = -kInfinity;
    range.samples = range.hits = 0u;
    return range;
}

// By what one sample has seen first.
RT_FN void extendRange(RT_IN(SurfaceSums) seen, RT_INOUT(SurfaceRange) range) {
    range.samples++;
    if (seen.hits == 0u) return;
    range.hits++;
    range.minAlbedo = min(range.minAlbedo, seen.albedo);
    range.maxAlbedo = max(range.maxAlbedo, seen.albedo);
    range.minNormal = min(range.minNormal, seen.normal);
    range.maxNormal = max(range.maxNormal, seen.normal);
    range.minDepth = min(range.minDepth, seen.depth);
    range.maxDepth = max(range.maxDepth, seen.depth);
}

// Whether the means of these samples hardly depend on their number.
RT_FN bool isNarrow(RT_IN(SurfaceRange) range) {
    const float kAlbedo = 0.01f; // what the denoiser takes for nothing is a tenth of a step of 1 (DenoiseFit.h)
    const float kNormal = 0.2f;
    const float kDepth = 0.1f; // relative
    if (range.hits == 0u) return true;
    return range.hits == range.samples && maxComponent(range.maxAlbedo - range.minAlbedo) <= kAlbedo &&
           maxComponent(range.maxNormal - range.minNormal) <= kNormal &&
           range.maxDepth - range.minDepth <= kDepth * range.maxDepth;
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
