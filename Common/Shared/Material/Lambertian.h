// Diffuse: the same radiance into all directions.
#ifndef RT_SHARED_LAMBERTIAN_H
#define RT_SHARED_LAMBERTIAN_H
#include "Common/Shared/Material/BsdfSample.h"

RT_SHARED_BEGIN

RT_FN bool isDeltaLambertian(Features, RT_IN(Bsdf)) {
    return false;
}

RT_FN BsdfSample sampleLambertian(vec3 albedo, vec3 n, vec2 u) {
    vec3 local = sampleCosineHemisphere(u);
    BsdfSample s = absorbed();
    s.wi = toWorld(makeFrame(n), local);
    s.weight = albedo;
    s.pdf = local.z * kInvPi;
    return s;
}

RT_FN BsdfSample sampleLambertian(Features, RT_IN(Bsdf) m, vec3 n, uint, vec3, vec2 u, float) {
    return sampleLambertian(m.albedo, n, u);
}

RT_FN vec4 evalLambertian(Features, RT_IN(Bsdf) m, vec3 n, vec3, vec3 wi) {
    float pdf = max(dot(n, wi), 0.0f) * kInvPi;
    return vec4(m.albedo * pdf, pdf);
}

RT_SHARED_END

#endif
