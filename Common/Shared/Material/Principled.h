// One layered surface with the parameters of glTF 2.0: a metal, or a dielectric coat over a diffuse base or around
// glass; over them sheen and a clear coat. Here are the lobes that the layers come down to for one outgoing direction,
// which PrincipledSurface.h finds.
#ifndef RT_SHARED_PRINCIPLED_H
#define RT_SHARED_PRINCIPLED_H
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Material/Dielectric.h"
#include "Common/Shared/Material/Microfacets.h"
#include "Common/Shared/Material/ThinFilm.h"

RT_SHARED_BEGIN

RT_FN bool isDeltaPrincipled(Features, RT_IN(Bsdf)) {
    return false; // few are, and the choice among their lobes tells
}

const float kMinRoughness = 0.0316227766f; // square root of kMinAlpha
const float kMinSheenRoughness = 0.07f;    // below it sheen would be a spark at grazing angles
const float kCoatReflectance = 0.04f;      // of a clear coat at normal incidence
const uint kGlassKey = 0x85ebca6bu;        // of the hash that chooses what rough glass does, any number

RT_FN bool isMirror(float alpha) {
    return alpha < kMinAlpha;
}

// Below this difference of 1 to a ratio of indices glass does not bend what it transmits: refracted directions would
// lie so near each other, however rough it is, that floats could not tell by which facet one came.
const float kMinBend = 2.0e-4f;

RT_FN bool isStraight(RT_IN(PrincipledLobes) lobes) {
    return lobes.thin == 0u && abs(lobes.eta - 1.0f) < kMinBend;
}

// Fibres (Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", 2017; visibility of Neubelt and Pettineo),
// for the exponent 1 / roughness^2. Smooth ones, seen at grazing angles, would send out more than arrives: makeLobes()
// bounds them.
RT_FN float sheenValue(float exponent, vec3 wo, vec3 wi, vec3 h) {
    float density =
        (2.0f + exponent) * 0.5f * kInvPi * exponential(0.5f * exponent * log1p(-min(square(h.z), 0.999999f)));
    return density / (4.0f * (wo.z + wi.z - wo.z * wi.z));
}

RT_FN vec3 toLocal(RT_IN(Frame) f, vec3 w) {
    return vec3(dot(f.tangent, w), dot(f.bitangent, w), dot(f.normal, w));
}

// From the frame of the normal to that of the clear coat's.
RT_FN vec3 toCoat(Features features, RT_IN(PrincipledLobes) lobes, vec3 w) {
    if (!has(features, kFeatureCoatNormal)) return w;
    return toLocal(makeFrame(lobes.coatNormal), w);
}

RT_FN vec3 fromCoat(Features features, RT_IN(PrincipledLobes) lobes, vec3 w) {
    if (!has(features, kFeatureCoatNormal)) return w;
    return toWorld(makeFrame(lobes.coatNormal), w);
}

// From the frame of the normal to that whose x is the direction along which facets are rougher, and back.
RT_FN vec3 toStretch(vec2 stretch, vec3 w) {
    return vec3(w.x * stretch.x + w.y * stretch.y, w.y * stretch.x - w.x * stretch.y, w.z);
}

RT_FN vec3 fromStretch(vec2 stretch, vec3 w) {
    return vec3(w.x * stretch.x - w.y * stretch.y, w.x * stretch.y + w.y * stretch.x, w.z);
}

RT_FN bool isStretched(Features features, RT_IN(PrincipledLobes) lobes) {
    return has(features, kFeatureAnisotropy) && hasLobe(lobes.others, kLobeStretched);
}

RT_FN bool isFilmed(Features features, RT_IN(PrincipledLobes) lobes) {
    return has(features, kFeatureIridescence) && hasLobe(lobes.others, kLobeFilm);
}

// What glass reflects under a film, where it would reflect so much without: all under total reflection.
RT_FN vec3 filmedReflectance(RT_IN(PrincipledLobes) lobes, float bare) {
    if (!(bare < 1.0f)) return vec3(1.0f);
    return lobes.rare.filmScale * bare + lobes.rare.filmOffset;
}

// The probability with which glass reflects what it scatters at a facet that would reflect so much without a film.
RT_FN float reflectionOdds(Features features, RT_IN(PrincipledLobes) lobes, float bare) {
    if (!isFilmed(features, lobes)) return bare;
    vec3 r = filmedReflectance(lobes, bare);
    return (r.x + r.y + r.z) * (1.0f / 3.0f);
}

// The lobes on wo's side of the surface, each above its own normal: f cos in rgb, density in w. Without a branch but
// for lobes.others, for loops over samples.
RT_FN vec4 evalPrincipledReflection(Features features, RT_IN(PrincipledLobes) lobes, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    float c = clamp(dot(wo, h), 0.0f, 1.0f);
    float grazing = schlick(c);
    float cosine = wi.z * kInvPi;
    bool isAbove = min(wo.z, wi.z) > 0.0f;

    float alpha = max(lobes.alpha, kMinAlpha);
    float density = isMirror(lobes.alpha) ? 0.0f : ggxDensity(h, alpha);
    float facets = density * smithVisibility(wo.z, wi.z, alpha) * wi.z;
    float specular = facets;
    float specularPdf = lobes.specularShare * density * reflectionJacobian(wo, alpha);
    if (isStretched(features, lobes)) {
        vec2 widths = lobes.rare.stretchedAlpha;
        vec3 o = toStretch(lobes.rare.stretch, wo);
        float stretched = stretchedDensity(toStretch(lobes.rare.stretch, h), widths);
        specular = stretched * stretchedVisibility(o, toStretch(lobes.rare.stretch, wi), widths) * wi.z;
        specularPdf = lobes.specularShare * stretched * stretchedJacobian(o, widths);
    }
    vec3 value = lobes.diffuse * cosine + mix(lobes.f0, lobes.f90, grazing) * specular;
    float pdf = lobes.diffuseShare * cosine + specularPdf;
    if (hasLobe(lobes.others, kLobeSheen)) value += lobes.sheen * (sheenValue(lobes.sheenExponent, wo, wi, h) * wi.z);
    if (!hasLobe(lobes.others, kLobeCoat | kLobeGlass)) {
        return vec4(select(isAbove, value, vec3(0.0f)), isAbove ? pdf : 0.0f);
    }

    float uncoloured = 0.0f;
    float glassPdf = 0.0f;
    if (hasLobe(lobes.others, kLobeGlass)) {
        float bare = fresnel(c, lobes.eta).x;
        float reflected = reflectionOdds(features, lobes, bare);
        if (isFilmed(features, lobes)) {
            value += filmedReflectance(lobes, bare) * (lobes.glass * facets);
        } else {
            uncoloured = lobes.glass * reflected * facets;
        }
        // The normals of glass are all that are visible.
        glassPdf = lobes.glassShare * reflected * density * smithMasking(wo.z, alpha) / (4.0f * wo.z);
    }
    float coat = 0.0f;
    float coatPdf = 0.0f;
    bool isCoatAbove = isAbove;
    if (hasLobe(lobes.others, kLobeCoat)) {
        vec3 coatWo = toCoat(features, lobes, wo);
        vec3 coatWi = toCoat(features, lobes, wi);
        float coatAlpha = max(lobes.coatAlpha, kMinAlpha);
        float coatDensity = isMirror(lobes.coatAlpha) ? 0.0f : ggxDensity(toCoat(features, lobes, h), coatAlpha);
        float coatFacets = coatDensity * smithVisibility(coatWo.z, coatWi.z, coatAlpha) * coatWi.z;
        coat = lobes.coat * mix(kCoatReflectance, 1.0f, grazing) * coatFacets;
        coatPdf = lobes.coatShare * coatDensity * reflectionJacobian(coatWo, coatAlpha);
        isCoatAbove = min(coatWo.z, coatWi.z) > 0.0f;
    }
    if (!has(features, kFeatureCoatNormal)) {
        value += vec3(uncoloured + coat);
        return vec4(select(isAbove, value, vec3(0.0f)), isAbove ? pdf + coatPdf + glassPdf : 0.0f);
    }
    value = select(isAbove, value, vec3(0.0f)) + vec3((isAbove ? uncoloured : 0.0f) + (isCoatAbove ? coat : 0.0f));
    return vec4(value, (isAbove ? pdf : 0.0f) + (isCoatAbove ? coatPdf : 0.0f) + (isAbove ? glassPdf : 0.0f));
}

// Through rough glass (Walter et al. 2007, section 4), or through a sheet of it, which mirrors what it would reflect to
// the other side. Radiance is not scaled by the indices, as in Dielectric.h.
RT_FN vec4 evalPrincipledTransmission(Features features, RT_IN(Bsdf) m, vec3 wo, vec3 wi) {
    RT_IN(PrincipledLobes) lobes = m.lobes;
    if (!(lobes.glass > 0.0f) || isMirror(lobes.alpha) || isStraight(lobes)) return vec4(0.0f);
    vec3 mirrored = vec3(wi.x, wi.y, -wi.z);
    vec3 h = lobes.thin != 0u ? wo + mirrored : wo * lobes.eta + wi;
    h = normalize(h) * (h.z < 0.0f ? -1.0f : 1.0f);
    float co = dot(wo, h);
    float ci = dot(lobes.thin != 0u ? mirrored : -wi, h);
    if (!(co > 0.0f && ci > 0.0f)) return vec4(0.0f);
    // d h / d wi: of reflection, and of refraction.
    float jacobian = lobes.thin != 0u ? 0.25f / co : ci / max(square(lobes.eta * co - ci), 1.0e-20f);
    float bare = fresnel(min(co, 1.0f), lobes.eta).x;
    float transmitted = 1.0f - reflectionOdds(features, lobes, bare);
    float facets = ggxDensity(h, lobes.alpha) * smithVisibility(wo.z, mirrored.z, lobes.alpha) * mirrored.z;
    vec3 value = m.albedo * (lobes.glass * transmitted * facets * 4.0f * co * jacobian);
    if (isFilmed(features, lobes)) {
        value =
            m.albedo * (vec3(1.0f) - filmedReflectance(lobes, bare)) * (lobes.glass * facets * 4.0f * co * jacobian);
    }
    return vec4(value, lobes.glassShare * transmitted * visibleNormalPdf(wo, h, lobes.alpha) * jacobian);
}

// Of reflection only: transmission is a matter of sampling.
RT_FN vec4 evalPrincipled(Features features, RT_IN(Bsdf) m, vec3 n, vec3 wo, vec3 wi) {
    Frame frame = makeFrame(n);
    return evalPrincipledReflection(features, m.lobes, toLocal(frame, wo), toLocal(frame, wi));
}

// The mirror direction of a lobe that was chosen with probability `share`, of reflectance `f`.
RT_FN BsdfSample mirrorSample(vec3 wi, vec3 f, float share) {
    BsdfSample s = absorbed();
    s.wi = wi;
    s.weight = f / share;
    s.delta = 1u;
    return s;
}

// The proposal, see proposePrincipled(), of those u that choose diffuse or specular reflection. Without a branch, for
// loops over samples.
RT_FN BsdfSample proposeReflection(RT_IN(PrincipledLobes) lobes, vec3 wo, vec2 u) {
    float beyondDiffuse = lobes.diffuseShare + lobes.specularShare;
    bool isDiffuse = u.x < lobes.diffuseShare;
    bool isMirrored = isMirror(isDiffuse ? 1.0f : lobes.alpha); // GCC makes no vectors of && here
    vec3 diffuse = sampleCosineHemisphere(vec2(remapSample(u.x, 0.0f, lobes.diffuseShare), u.y));
    vec3 h = sampleReflectionNormal(wo, lobes.alpha, vec2(remapSample(u.x, lobes.diffuseShare, beyondDiffuse), u.y));
    vec3 glossy = h * (2.0f * dot(wo, h)) - wo;
    vec3 mirror = mix(lobes.f0, lobes.f90, schlick(wo.z)) / lobes.specularShare;
    BsdfSample s = absorbed();
    s.wi = select(isDiffuse, diffuse, select(isMirrored, vec3(-wo.x, -wo.y, wo.z), glossy));
    s.weight = select(isMirrored, mirror, vec3(0.0f));
    s.delta = isMirrored ? 1u : 0u;
    return s;
}

// The same of facets that are rougher along one direction.
RT_FN BsdfSample proposeStretched(RT_IN(PrincipledLobes) lobes, vec3 wo, vec2 u) {
    BsdfSample s = absorbed();
    if (u.x < lobes.diffuseShare) {
        s.wi = sampleCosineHemisphere(vec2(remapSample(u.x, 0.0f, lobes.diffuseShare), u.y));
        return s;
    }
    float pick = remapSample(u.x, lobes.diffuseShare, lobes.diffuseShare + lobes.specularShare);
    vec3 o = toStretch(lobes.rare.stretch, wo);
    vec3 h = sampleStretchedNormal(o, lobes.rare.stretchedAlpha, vec2(pick, u.y));
    s.wi = fromStretch(lobes.rare.stretch, h * (2.0f * dot(o, h)) - o);
    return s;
}

// One sample of one lobe, in the frame of the normal; but for mirrors it has yet to be weighed. wo.z > 0.
RT_FN BsdfSample proposePrincipled(Features features, RT_IN(Bsdf) m, vec3 wo, vec2 u) {
    RT_IN(PrincipledLobes) lobes = m.lobes;
    float beyondDiffuse = lobes.diffuseShare + lobes.specularShare;
    float beyondSpecular = beyondDiffuse + lobes.coatShare;
    vec3 wi;
    uint transmitted = 0u;
    if (u.x < beyondDiffuse) {
        if (isStretched(features, lobes)) return proposeStretched(lobes, wo, u);
        return proposeReflection(lobes, wo, u);
    } else if (u.x < beyondSpecular) {
        vec3 coatWo = toCoat(features, lobes, wo);
        if (isMirror(lobes.coatAlpha)) {
            float f = lobes.coat * mix(kCoatReflectance, 1.0f, schlick(coatWo.z));
            vec3 reflected = fromCoat(features, lobes, vec3(-coatWo.x, -coatWo.y, coatWo.z));
            return mirrorSample(reflected, vec3(f), lobes.coatShare);
        }
        vec2 v = vec2(remapSample(u.x, beyondDiffuse, beyondSpecular), u.y);
        vec3 h = sampleReflectionNormal(coatWo, lobes.coatAlpha, v);
        wi = fromCoat(features, lobes, h * (2.0f * dot(coatWo, h)) - coatWo);
    } else if (lobes.glassShare > 0.0f) {
        float pick = remapSample(u.x, beyondSpecular, 1.0f);
        // Of rough glass both numbers choose the normal. A hash of them chooses between reflection and refraction:
        // their last digits would not, as the number that chose a lobe of a small share has few left.
        float choice = pick;
        if (!isMirror(lobes.alpha)) {
            choice = toUniform(hash3(uvec3(floatBitsToUint(u.x), floatBitsToUint(u.y), kGlassKey)).x);
        }
        vec3 h = vec3(0.0f, 0.0f, 1.0f);
        if (!isMirror(lobes.alpha)) h = sampleVisibleNormal(wo, lobes.alpha, vec2(pick, u.y));
        float c = clamp(dot(wo, h), 0.0f, 1.0f);
        vec2 f = fresnel(c, lobes.eta);
        float odds = reflectionOdds(features, lobes, f.x);
        if (choice < odds) {
            wi = h * (2.0f * c) - wo;
        } else {
            transmitted = 1u;
            wi = lobes.thin != 0u ? h * (2.0f * c) - wo : h * (lobes.eta * c - f.y) - wo * lobes.eta;
            if (lobes.thin != 0u) wi.z = -wi.z;
        }
        bool goesStraight = transmitted != 0u && isStraight(lobes);
        if (goesStraight) wi = -wo;
        if (goesStraight || isMirror(lobes.alpha)) {
            BsdfSample s = mirrorSample(wi, vec3(lobes.glass), lobes.glassShare);
            s.transmitted = transmitted;
            if (transmitted != 0u) s.weight *= m.albedo;
            if (isFilmed(features, lobes)) {
                vec3 r = filmedReflectance(lobes, f.x);
                s.weight *= transmitted != 0u ? (vec3(1.0f) - r) / (1.0f - odds) : r / odds;
            }
            return s;
        }
    } else {
        return absorbed();
    }
    BsdfSample s = absorbed();
    s.wi = wi;
    s.transmitted = transmitted;
    return s;
}

// f cos and density of a proposal: of the lobes that send light to its side.
RT_FN vec4 evalProposal(Features features, RT_IN(Bsdf) m, vec3 wo, RT_IN(BsdfSample) s) {
    if (s.transmitted == 0u) return evalPrincipledReflection(features, m.lobes, wo, s.wi);
    return s.wi.z < 0.0f ? evalPrincipledTransmission(features, m, wo, s.wi) : vec4(0.0f);
}

// Weighs a proposal by the density of all lobes; f is evalProposal() of it. Without a branch, for loops over samples.
RT_FN void weighProposal(vec4 f, RT_INOUT(BsdfSample) s) {
    float density = s.delta == 0u ? f.w : 0.0f;
    bool isWeighed = density > 0.0f;
    s.pdf = isWeighed ? density : s.pdf;
    s.weight = select(isWeighed, vec3(f) / density, s.weight);
}

RT_FN BsdfSample samplePrincipled(Features features, RT_IN(Bsdf) m, vec3 n, uint, vec3 wo, vec2 u, float) {
    Frame frame = makeFrame(n);
    vec3 local = toLocal(frame, wo);
    if (!(local.z > 0.0f)) return absorbed();
    BsdfSample s = proposePrincipled(features, m, local, u);
    weighProposal(evalProposal(features, m, local, s), s);
    s.wi = normalize(toWorld(frame, s.wi));
    return s;
}

RT_SHARED_END

#endif
