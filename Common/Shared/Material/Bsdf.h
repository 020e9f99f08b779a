// Scattering at surfaces and in media. Directions point away from the surface, `n` is the unit shading normal on the
// side of wo. Densities are per steradian; `weight` is value * |cosine| / density, so no division is left to the
// caller.
#ifndef RT_SHARED_BSDF_H
#define RT_SHARED_BSDF_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

struct BsdfSample {
    vec3 wi;
    vec3 weight;      // zero: absorbed
    float pdf;        // 0 for a delta lobe
    uint delta;       // 1: wi is the only direction of its lobe, next-event estimation cannot meet it
    uint transmitted; // 1: wi lies on the other side of the surface
};

RT_FN BsdfSample absorbed() {
    BsdfSample s;
    s.wi = vec3(0.0f);
    s.weight = vec3(0.0f);
    s.pdf = 0.0f;
    s.delta = 0u;
    s.transmitted = 0u;
    return s;
}

// Kinds that the scene lacks are false by `features` alone, which keeps them out of the code.
RT_FN bool isLambertian(uint features, RT_IN(Material) m) {
    return has(features, kFeatureLambertian) && m.kind == kMaterialLambertian;
}
RT_FN bool isMetal(uint features, RT_IN(Material) m) {
    return has(features, kFeatureMetal) && m.kind == kMaterialMetal;
}
RT_FN bool isFuzzy(uint features, RT_IN(Material) m) {
    return has(features, kFeatureFuzz) && m.fuzz > kMirrorFuzz;
}
RT_FN bool isDielectric(uint features, RT_IN(Material) m) {
    return has(features, kFeatureDielectric) && m.kind == kMaterialDielectric;
}

// Whether every lobe is a delta: no direction can be evaluated, lights need not be sampled.
RT_FN bool isDelta(uint features, RT_IN(Material) m) {
    return isDielectric(features, m) || (isMetal(features, m) && !isFuzzy(features, m));
}

// ---- metal with fuzz ------------------------------------------------------------------------------------------------

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

RT_FN vec3 mirrorDirection(vec3 wo, vec3 n) {
    return normalize(n * (2.0f * dot(n, wo)) - wo);
}

RT_FN BsdfSample sampleMetal(uint features, RT_IN(Material) m, vec3 albedo, vec3 n, vec3 wo, vec2 u) {
    BsdfSample s = absorbed();
    s.wi = mirrorDirection(wo, n);
    s.weight = albedo;
    s.delta = 1u;
    if (isFuzzy(features, m)) {
        vec3 w = s.wi + sampleSphere(u) * m.fuzz;
        float l2 = dot(w, w);
        w = w / sqrt(max(l2, 1.0e-20f));
        s.pdf = fuzzPdf(s.wi, m.fuzz, w);
        s.wi = w;
        s.delta = 0u;
        if (dot(n, w) <= 0.0f) s.weight = vec3(0.0f);
    }
    return s;
}

// ---- dielectric -----------------------------------------------------------------------------------------------------

// (reflectance, cosine of the refracted ray or 0 under total reflection) of unpolarised light, for the cosine c in
// [0,1] of the incident ray and eta = index on its side / index beyond.
RT_FN vec2 fresnel(float c, float eta) {
    // cos^2 of the refracted ray, in whichever form cancels less.
    float eta2 = eta * eta;
    float k = eta2 < 2.0f ? (1.0f - eta) * (1.0f + eta) + square(eta * c) : 1.0f - eta2 * ((1.0f - c) * (1.0f + c));
    if (k <= 0.0f) return vec2(1.0f, 0.0f);
    float t = sqrt(k);
    float perpendicular = (eta * c - t) / (eta * c + t);
    float parallel = (c - eta * t) / (c + eta * t);
    return vec2(min(0.5f * (square(perpendicular) + square(parallel)), 1.0f), t);
}

// Reflects with the probability that Fresnel's equations give, else refracts; radiance is not scaled by the indices, as
// long as camera and lights stand in the same medium.
RT_FN BsdfSample sampleDielectric(RT_IN(Material) m, vec3 tint, vec3 n, uint frontFace, vec3 wo, float uLobe) {
    BsdfSample s = absorbed();
    s.weight = tint;
    s.delta = 1u;
    float eta = frontFace != 0u ? 1.0f / m.ior : m.ior;
    float c = clamp(dot(n, wo), 0.0f, 1.0f);
    vec2 f = fresnel(c, eta);
    vec3 refracted = n * (eta * c - f.y) - wo * eta;
    // Rounding may leave a grazing refracted ray on this side: then it is reflected.
    if (uLobe >= f.x && dot(refracted, n) < 0.0f) {
        s.wi = normalize(refracted);
        s.transmitted = 1u;
    } else {
        s.wi = mirrorDirection(wo, n);
    }
    return s;
}

// ---- any material ---------------------------------------------------------------------------------------------------

RT_FN BsdfSample sampleLambertian(vec3 albedo, vec3 n, vec2 u) {
    vec3 local = sampleCosineHemisphere(u);
    BsdfSample s = absorbed();
    s.wi = toWorld(makeFrame(n), local);
    s.weight = albedo;
    s.pdf = local.z * kInvPi;
    return s;
}

// `albedo` is the material's, texture applied. `u` chooses the direction, `uLobe` between reflection and refraction.
// A material that does not scatter returns weight 0.
RT_FN BsdfSample sampleBsdf(uint features, RT_IN(Material) m, vec3 albedo, vec3 n, uint frontFace, vec3 wo, vec2 u,
                            float uLobe) {
    if (isLambertian(features, m)) return sampleLambertian(albedo, n, u);
    if (isMetal(features, m)) return sampleMetal(features, m, albedo, n, wo, u);
    if (isDielectric(features, m)) return sampleDielectric(m, albedo, n, frontFace, wo, uLobe);
    return absorbed();
}

// (value * |cosine| per channel, density with which sampleBsdf chooses wi); zero for delta lobes.
RT_FN vec4 evalBsdf(uint features, RT_IN(Material) m, vec3 albedo, vec3 n, vec3 wo, vec3 wi) {
    float cosine = dot(n, wi);
    if (isLambertian(features, m)) {
        float pdf = max(cosine, 0.0f) * kInvPi;
        return vec4(albedo * pdf, pdf);
    }
    if (isMetal(features, m) && isFuzzy(features, m)) {
        float pdf = fuzzPdf(mirrorDirection(wo, n), m.fuzz, wi);
        return vec4(albedo * (cosine > 0.0f ? pdf : 0.0f), pdf);
    }
    return vec4(0.0f);
}

// ---- media ----------------------------------------------------------------------------------------------------------

// Value and density of the isotropic phase function: 1 / (4 pi).
const float kPhasePdf = 0.0795774715f;

RT_FN BsdfSample samplePhase(vec3 albedo, vec2 u) {
    BsdfSample s = absorbed();
    s.wi = sampleSphere(u);
    s.weight = albedo;
    s.pdf = kPhasePdf;
    return s;
}

RT_SHARED_END

#endif
