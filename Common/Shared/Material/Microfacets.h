// GGX microfacets (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007) with
// Smith's height-correlated masking (Heitz, JCGT 3(2), 2014), isotropic or stretched along the axes of the frame.
// Directions are in the frame of the normal, +z; wo.z > 0.
#ifndef RT_SHARED_MICROFACETS_H
#define RT_SHARED_MICROFACETS_H
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

RT_FN float fifthPower(float x) {
    return square(square(x)) * x;
}

// Schlick's approximation, a weight for the reflectance at grazing incidence.
RT_FN float schlick(float cosine) {
    return fifthPower(1.0f - cosine);
}

const float kMinAlpha = 1.0e-3f; // below it a lobe is a mirror: floats no longer resolve its directions

// Density of microfacet normals h per steradian and projected area. 1 - h.z^2 would cancel for small alpha.
RT_FN float ggxDensity(vec3 h, float alpha) {
    float a2 = square(alpha);
    float d = a2 * square(h.z) + square(h.x) + square(h.y);
    return a2 / (kPi * square(d)); // h.z > 0
}

// Smith's Lambda + 1/2, times 2 |cosine|.
RT_FN float smithTerm(float cosine, float alpha) {
    return sqrt(square(cosine) + square(alpha) * max(1.0f - square(cosine), 0.0f));
}

// Masking and shadowing of both directions, over 4 |wo.z wi.z|.
RT_FN float smithVisibility(float cosO, float cosI, float alpha) {
    return 0.5f / max(cosI * smithTerm(cosO, alpha) + cosO * smithTerm(cosI, alpha), 1.0e-30f);
}

// Masking of one direction.
RT_FN float smithMasking(float cosine, float alpha) {
    return 2.0f * cosine / (cosine + smithTerm(cosine, alpha));
}

// A normal that is visible from wo, with density masking * ggxDensity(h) * wo.h / wo.z: the half vector of a direction
// that is uniform on a spherical cap (Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", CGF 42(8),
// 2023). `k` narrows the cap to directions that may be reflected upwards, 1: all of it; alpha is that along x and y.
RT_FN vec3 sampleGgxCap(vec3 wo, vec2 alpha, float k, vec2 u) {
    vec3 stretched = normalize(vec3(wo.x * alpha.x, wo.y * alpha.y, wo.z));
    float bottom = k * stretched.z;
    float z = 1.0f - u.x * (1.0f + bottom);
    float r = sqrt(clamp((1.0f - z) * (1.0f + z), 0.0f, 1.0f));
    vec2 sc = sinCos2Pi(u.y);
    vec3 h = vec3(r * sc.y, r * sc.x, z) + stretched;
    return normalize(vec3(h.x * alpha.x, h.y * alpha.y, max(h.z, 1.0e-6f)));
}

RT_FN vec3 sampleVisibleNormal(vec3 wo, float alpha, vec2 u) {
    return sampleGgxCap(wo, vec2(alpha), 1.0f, u);
}

RT_FN float visibleNormalPdf(vec3 wo, vec3 h, float alpha) {
    return smithMasking(wo.z, alpha) * ggxDensity(h, alpha) * max(dot(wo, h), 0.0f) / wo.z;
}

// ---- reflection ----------------------------------------------------------------------------------------------------
// Normals bounded to those whose reflection may lie above the surface: Tokuyoshi and Eto, "Bounded VNDF Sampling for
// Smith-GGX Reflections", SIGGRAPH Asia 2023 Technical Communications.

RT_FN float reflectionBound(vec3 wo, float alpha) {
    float s = 1.0f + sqrt(square(wo.x) + square(wo.y));
    float a2 = square(alpha);
    float s2 = square(s);
    return (1.0f - a2) * s2 / (s2 + a2 * square(wo.z));
}

// Normal of a reflection; see reflectionJacobian() for the density of the direction.
RT_FN vec3 sampleReflectionNormal(vec3 wo, float alpha, vec2 u) {
    return sampleGgxCap(wo, vec2(alpha), reflectionBound(wo, alpha), u);
}

// Times ggxDensity(h): the density per steradian of the direction into which h reflects wo.
RT_FN float reflectionJacobian(vec3 wo, float alpha) {
    float t = sqrt(square(alpha) * (square(wo.x) + square(wo.y)) + square(wo.z));
    return 0.5f / (reflectionBound(wo, alpha) * wo.z + t);
}

// ---- stretched facets ----------------------------------------------------------------------------------------------
// The same for facets whose width is alpha.x along x and alpha.y along y (Heitz 2014, section 5.4).

RT_FN float stretchedDensity(vec3 h, vec2 alpha) {
    float d = square(h.x / alpha.x) + square(h.y / alpha.y) + square(h.z);
    return 1.0f / (kPi * alpha.x * alpha.y * square(d));
}

// 2 |cosine| times Smith's Lambda + 1/2.
RT_FN float stretchedTerm(vec3 w, vec2 alpha) {
    return sqrt(square(alpha.x * w.x) + square(alpha.y * w.y) + square(w.z));
}

RT_FN float stretchedVisibility(vec3 wo, vec3 wi, vec2 alpha) {
    return 0.5f / max(wi.z * stretchedTerm(wo, alpha) + wo.z * stretchedTerm(wi, alpha), 1.0e-30f);
}

RT_FN vec3 sampleStretchedNormal(vec3 wo, vec2 alpha, vec2 u) {
    return sampleGgxCap(wo, alpha, reflectionBound(wo, min(alpha.x, alpha.y)), u);
}

RT_FN float stretchedJacobian(vec3 wo, vec2 alpha) {
    return 0.5f / (reflectionBound(wo, min(alpha.x, alpha.y)) * wo.z + stretchedTerm(wo, alpha));
}

RT_SHARED_END

#endif
