// Clear glass: reflects and refracts.
#ifndef RT_SHARED_DIELECTRIC_H
#define RT_SHARED_DIELECTRIC_H
#include "Common/Shared/Material/BsdfSample.h"

RT_SHARED_BEGIN

const uint kDielectricIor = 0u; // of Bsdf::parameter: index of refraction inside over outside, > 0

RT_FN bool isDeltaDielectric(Features, RT_IN(Bsdf)) {
    return true;
}

// (reflectance, cosine of the refracted ray or 0 under total reflection) of unpolarised light, for the cosine c in
// [0,1] of the incident ray and eta = index on its side / index beyond.
RT_FN vec2 fresnel(float c, float eta) {
    // cos^2 of the refracted ray, in whichever form cancels less.
    float eta2 = eta * eta;
    float k = eta2 < 2.0f ? (1.0f - eta) * (1.0f + eta) + square(eta * c) : 1.0f - eta2 * ((1.0f - c) * (1.0f + c));
    float t = sqrt(max(k, 0.0f));
    float perpendicular = (eta * c - t) / (eta * c + t);
    float parallel = (c - eta * t) / (c + eta * t);
    float reflectance = min(0.5f * (square(perpendicular) + square(parallel)), 1.0f);
    return vec2(k > 0.0f ? reflectance : 1.0f, t);
}

// Reflects with the probability that Fresnel's equations give, else refracts; radiance is not scaled by the indices, as
// long as camera and lights stand in the same medium.
RT_FN BsdfSample sampleDielectric(Features, RT_IN(Bsdf) m, vec3 n, uint frontFace, vec3 wo, vec2, float uLobe) {
    BsdfSample s = absorbed();
    s.weight = m.albedo;
    s.delta = 1u;
    float eta = frontFace != 0u ? 1.0f / m.parameter[kDielectricIor] : m.parameter[kDielectricIor];
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

RT_FN vec4 evalDielectric(Features, RT_IN(Bsdf), vec3, vec3, vec3) {
    return vec4(0.0f);
}

RT_SHARED_END

#endif
