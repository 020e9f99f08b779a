// What bsdfs are given and what sampling them returns. Directions point away from the surface, `n` is the unit shading
// normal on the side of wo. Densities are per steradian; `weight` is value * |cosine| / density, so no division is left
// to the caller.
#ifndef RT_SHARED_BSDF_SAMPLE_H
#define RT_SHARED_BSDF_SAMPLE_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

// The lobes that few principled materials have beside diffuse and specular reflection, a bit each; and what their
// specular reflection may be.
const uint kLobeSheen = 1u << 0u;
const uint kLobeCoat = 1u << 1u;
const uint kLobeGlass = 1u << 2u;
const uint kLobeStretched = 1u << 3u; // by facets that are rougher along one direction: kFeatureAnisotropy
const uint kLobeFilm = 1u << 4u;      // through a thin film: kFeatureIridescence; of lobes, those of glass
const uint kLobeBeyond = 1u << 5u;    // diffuse transmission: kFeatureDiffuseTransmission; of values only
const uint kLobesLayered = kLobeSheen | kLobeCoat | kLobeGlass; // what loops over samples know
const uint kLobesRare = kLobeStretched | kLobeFilm;             // and what they do not

RT_FN bool hasLobe(uint lobes, uint wanted) {
    return (lobes & wanted) != 0u;
}

// What few materials have of them.
struct RareLobes {
    vec2 stretch;        // unit, in the frame of the normal: along which specular facets are rougher
    vec2 stretchedAlpha; // the widths of their distribution along it and across
    vec3 filmScale;      // what glass reflects under a film: this part of what it would reflect without
    vec3 filmOffset;     // and this
};

// Of a principled material, for one wo: what each lobe is multiplied by, and the probability with which it is sampled.
struct PrincipledLobes {
    uint others;         // kLobe...: those that may be there. What is not is zero, and left out of all formulas
    vec3 diffuse;        // albedo
    vec3 f0;             // of reflection by rough facets at normal incidence
    vec3 f90;            // and at grazing incidence
    vec3 sheen;          // sampled together with diffuse
    float sheenExponent; // 1 / roughness^2
    float alpha;         // width of the facets' distribution, also of glass
    float glass;         // reflection and transmission by a dielectric without a base; transmission is tinted by albedo
    float eta;           // its index on wo's side over that beyond
    uint thin;           // 1: it does not bend
    float coat;
    float coatAlpha;
    vec3 coatNormal;    // in the frame of the normal, of which it differs with kFeatureCoatNormal only
    float diffuseShare; // the probabilities: they sum to 1, or all are 0
    float specularShare;
    float coatShare;
    float glassShare;
    RareLobes rare; // kLobesRare
};

// Values that few materials have.
struct RareValues {
    float anisotropy;    // strength
    vec2 stretch;        // as of RareLobes
    float film;          // share of the surface under a film
    float filmThickness; // nm
    float filmIor;
    float beyond; // share of the diffuse base that transmits, in this colour
    vec3 beyondColor;
    uint isBeyond; // 1: the path goes on beyond the surface, where that is all that scatters
};

// What the lobes follow from: the numbers of a principled material at a point, its textures evaluated.
struct PrincipledValues {
    uint others; // kLobe...: as of the lobes
    float metallic;
    float roughness;
    float specular;
    float transmission;
    float clearcoat;
    float clearcoatRoughness;
    float sheenRoughness;
    vec3 specularColor;
    vec3 sheenColor;
    float ior;
    uint thin;
    uint glass; // as of Principled
    RareValues rare;
};

// A material at a point, its textures evaluated.
struct Bsdf {
    uint kind; // kMaterial...
    vec3 albedo;
    float parameter[kMaterialParameters];
    PrincipledLobes lobes; // of principled materials only
};

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

RT_FN PrincipledLobes noLobes() {
    PrincipledLobes lobes;
    lobes.others = 0u;
    lobes.diffuse = vec3(0.0f);
    lobes.f0 = vec3(0.0f);
    lobes.f90 = vec3(0.0f);
    lobes.sheen = vec3(0.0f);
    lobes.sheenExponent = 1.0f;
    lobes.alpha = 0.0f;
    lobes.glass = 0.0f;
    lobes.eta = 1.0f;
    lobes.thin = 0u;
    lobes.coat = 0.0f;
    lobes.coatAlpha = 0.0f;
    lobes.coatNormal = vec3(0.0f, 0.0f, 1.0f);
    lobes.diffuseShare = 0.0f;
    lobes.specularShare = 0.0f;
    lobes.coatShare = 0.0f;
    lobes.glassShare = 0.0f;
    lobes.rare.stretch = vec2(1.0f, 0.0f);
    lobes.rare.stretchedAlpha = vec2(0.0f, 0.0f);
    lobes.rare.filmScale = vec3(1.0f);
    lobes.rare.filmOffset = vec3(0.0f);
    return lobes;
}

RT_FN vec3 mirrorDirection(vec3 wo, vec3 n) {
    return normalize(n * (2.0f * dot(n, wo)) - wo);
}

RT_SHARED_END

#endif
