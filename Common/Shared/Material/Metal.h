// A mirror whose reflections are blurred by fuzz, as in the books: a point of the unit sphere, scaled by fuzz, is
// added.
#ifndef RT_SHARED_METAL_H
#define RT_SHARED_METAL_H
#include "Common/Shared/Material/BsdfSample.h"

RT_SHARED_BEGIN

const uint kMetalFuzz = 0u;        // of Bsdf::parameter: [0,1]
const float kMirrorFuzz = 1.0e-3f; // below it a metal is a perfect mirror
const float kBlurredFuzz = 0.1f;   // up to it a metal shows lights as blurred images

// kFeatureFuzz says that some metal of the scene is.
RT_FN bool isFuzzy(Features features, RT_IN(Bsdf) m) {
    return has(features, kFeatureFuzz) && m.parameter[kMetalFuzz] > kMirrorFuzz;
}

RT_FN bool isBlurredMirror(Features features, RT_IN(Bsdf) m) {
    return isFuzzy(features, m) && m.parameter[kMetalFuzz] <= kBlurredFuzz;
}

RT_FN bool isDeltaMetal(Features features, RT_IN(Bsdf) m) {
    return !isFuzzy(features, m);
}

// Density of w = normalize(r + fuzz s), s uniform on the unit sphere, r unit, 0 < fuzz <= 1. Along w lie up to two
// points of that sphere, at distances t = cos +- root, where cos = w.r and root^2 = fuzz^2 - sin^2:
//     p = (t+^2 + t-^2) / (4 pi fuzz root) = (cos^2 + root^2) / (2 pi fuzz root).
// At the rim root is 0 and p infinite (integrably). There (root / fuzz)^2 is kept above the resolution of a float
// direction, and the lobe reaches as far beyond the rim, which leaves its integral 1.
RT_FN float fuzzPdf(vec3 r, float fuzz, vec3 w) {
    float cosine = dot(r, w);
    vec3 chord = w - r;
    float q = dot(chord, chord);                            // 2 (1 - cos), accurate for small angles
    float x = 1.0f - q * (1.0f - 0.25f * q) / square(fuzz); // (root / fuzz)^2
    float blur = 4.0e-7f / fuzz;
    float root = fuzz * sqrt(max(x, blur));
    return x > -blur && cosine > 0.0f ? (square(cosine) + square(root)) / (2.0f * kPi * fuzz * root) : 0.0f;
}

RT_FN BsdfSample sampleMetal(Features features, RT_IN(Bsdf) m, vec3 n, uint, vec3 wo, vec2 u, float) {
    BsdfSample s = absorbed();
    s.wi = mirrorDirection(wo, n);
    s.weight = m.albedo;
    s.delta = 1u;
    if (isFuzzy(features, m)) {
        vec3 w = s.wi + sampleSphere(u) * m.parameter[kMetalFuzz];
        float l2 = dot(w, w);
        w = w / sqrt(max(l2, 1.0e-20f));
        s.pdf = fuzzPdf(s.wi, m.parameter[kMetalFuzz], w);
        s.wi = w;
        s.delta = 0u;
        if (dot(n, w) <= 0.0f) s.weight = vec3(0.0f);
    }
    return s;
}

RT_FN vec4 evalMetal(Features, RT_IN(Bsdf) m, vec3 n, vec3 wo, vec3 wi) {
    float pdf = fuzzPdf(mirrorDirection(wo, n), m.parameter[kMetalFuzz], wi);
    return vec4(m.albedo * (dot(n, wi) > 0.0f ? pdf : 0.0f), pdf);
}

RT_SHARED_END

#endif
