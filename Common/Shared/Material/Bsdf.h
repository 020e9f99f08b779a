// Scattering at surfaces of any material, and in media: BsdfSample.h says what directions and densities mean.
#ifndef RT_SHARED_BSDF_H
#define RT_SHARED_BSDF_H
#include "Common/Shared/Material/Materials.h"

RT_SHARED_BEGIN

// What surfaces of m scatter by where its colour is `albedo`, but for the lobes of a principled material.
RT_FN Bsdf makeBsdf(RT_IN(Material) m, vec3 albedo) {
    Bsdf b;
    b.kind = m.kind;
    b.albedo = albedo;
    for (uint i = 0u; i < kMaterialParameters; i++) b.parameter[i] = m.parameter[i];
    b.lobes = noLobes();
    return b;
}

// isLambertian(features, m), and so on. Kinds that the scene lacks are false by `features` alone, which keeps them out
// of the code.
#define RT_IS_KIND(Name, kind_, name, help, scatters, parameters) \
    RT_FN bool is##Name(Features features, RT_IN(Bsdf) m) {       \
        return has(features, kFeature##Name) && m.kind == kind_;  \
    }
#define RT_NOTHING(Name, kind_, name, help, parameters)
RT_MATERIALS(RT_IS_KIND, RT_NOTHING)

// Whether every lobe is a delta: no direction can be evaluated, lights need not be sampled.
RT_FN bool isDelta(Features features, RT_IN(Bsdf) m) {
#define RT_OR_IS_DELTA(Name, kind_, name, help, scatters, parameters) \
    || (is##Name(features, m) && isDelta##Name(features, m))
    return false RT_MATERIALS(RT_OR_IS_DELTA, RT_NOTHING);
}

// How m scatters, see Materials.h: false of media and of what only emits.
#define RT_OR_SCATTERS(Name, scatters, limit) || (scatters <= limit && is##Name(features, m))
#define RT_OR_EVEN(Name, kind_, name, help, scatters, parameters) RT_OR_SCATTERS(Name, scatters, kScattersEvenly)
RT_FN bool scattersEvenly(Features features, RT_IN(Bsdf) m) {
    return false RT_MATERIALS(RT_OR_EVEN, RT_NOTHING);
}
#define RT_OR_DIFFUSE(Name, kind_, name, help, scatters, parameters) RT_OR_SCATTERS(Name, scatters, kScattersDiffusely)
RT_FN bool scattersDiffusely(Features features, RT_IN(Bsdf) m) {
    return false RT_MATERIALS(RT_OR_DIFFUSE, RT_NOTHING);
}
#define RT_OR_LAYERS(Name, kind_, name, help, scatters, parameters) RT_OR_SCATTERS(Name, scatters, kScattersInLayers)
RT_FN bool hasDiffuseLobe(Features features, RT_IN(Bsdf) m) {
    return false RT_MATERIALS(RT_OR_LAYERS, RT_NOTHING);
}

// Whether m sends light on into a range of directions, where sampling lights is of use.
RT_FN bool scattersWidely(RT_IN(Bsdf) m) {
    return m.kind != kMaterialEmitter && !isDelta(kFeatureAll, m);
}

// `u` chooses the direction, `uLobe` between reflection and refraction.
// A material that does not scatter returns weight 0.
RT_FN BsdfSample sampleBsdf(Features features, RT_IN(Bsdf) m, vec3 n, uint frontFace, vec3 wo, vec2 u, float uLobe) {
#define RT_SAMPLE(Name, kind_, name, help, scatters, parameters) \
    if (is##Name(features, m)) return sample##Name(features, m, n, frontFace, wo, u, uLobe);
    RT_MATERIALS(RT_SAMPLE, RT_NOTHING)
    return absorbed();
}

// (value * |cosine| per channel, density with which sampleBsdf chooses wi); zero for delta lobes.
RT_FN vec4 evalBsdf(Features features, RT_IN(Bsdf) m, vec3 n, vec3 wo, vec3 wi) {
#define RT_EVALUATE(Name, kind_, name, help, scatters, parameters) \
    if (is##Name(features, m) && !isDelta##Name(features, m)) {    \
        return eval##Name(features, m, n, wo, wi);                 \
    }
    RT_MATERIALS(RT_EVALUATE, RT_NOTHING)
    return vec4(0.0f);
}

#undef RT_IS_KIND
#undef RT_OR_IS_DELTA
#undef RT_OR_SCATTERS
#undef RT_OR_EVEN
#undef RT_OR_DIFFUSE
#undef RT_OR_LAYERS
#undef RT_SAMPLE
#undef RT_EVALUATE
#undef RT_NOTHING

// ---- media ---------------------------------------------------------------------------------------------------------

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
