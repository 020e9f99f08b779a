// From the values of a principled material to the lobes of Principled.h: what the layers leave to those below them, and
// the choice among lobes.
#ifndef RT_SHARED_PRINCIPLED_SURFACE_H
#define RT_SHARED_PRINCIPLED_SURFACE_H
#include "Common/Shared/Material/Bsdf.h"
#include "Common/Shared/Material/PrincipledValues.h"

RT_SHARED_BEGIN

RT_FN bool isPrincipled(Features features, RT_IN(Material) m) {
    return has(features, kFeaturePrincipled) && m.kind == kMaterialPrincipled;
}

// What single reflection at rough facets loses is put back in proportion: Turquin, "Practical Multiple Scattering
// Compensation for Microfacet Models", 2019. `whole` is the albedo of facets that reflect everything.
RT_FN vec3 compensation(vec3 f0, float whole) {
    return vec3(1.0f) + f0 * (1.0f / max(whole, 1.0e-3f) - 1.0f);
}

// ---- thin films ----------------------------------------------------------------------------------------------------

// Reflectances at normal and at grazing incidence of a dielectric and of metal, as a film leaves them; and what it
// makes of the reflectance R of glass: glassScale R + glassOffset.
struct Film {
    vec3 f0;
    vec3 f90;
    vec3 metalF0;
    vec3 metalF90;
    vec3 glassScale;
    vec3 glassOffset;
};

// Without one.
RT_FN Film noFilm(vec3 f0, float f90, vec3 metalF0) {
    Film film;
    film.f0 = f0;
    film.f90 = vec3(f90);
    film.metalF0 = metalF0;
    film.metalF90 = vec3(1.0f);
    film.glassScale = vec3(1.0f);
    film.glassOffset = vec3(0.0f);
    return film;
}

// The reflectance at normal incidence of which Schlick's approximation makes r where its weight is `grazing`; negative
// where that of normal incidence 0 is more already.
RT_FN vec3 beforeSchlick(vec3 r, float grazing) {
    return (r - vec3(grazing)) * (1.0f / max(1.0f - grazing, 1.0e-4f));
}

// The reflectance at grazing incidence that belongs to a beforeSchlick(): 1, or, where that is negative, what 0 would
// have to be there.
RT_FN vec3 beforeGrazing(vec3 normal, vec3 r, float grazing) {
    vec3 least = r * (1.0f / max(grazing, 1.0e-30f));
    return vec3(normal.x < 0.0f ? least.x : 1.0f, normal.y < 0.0f ? least.y : 1.0f, normal.z < 0.0f ? least.z : 1.0f);
}

// Of what glass reflects bare, the part that remains where a film changes it to `filmed`; or, where the film reflects
// more, the part of what is transmitted.
RT_FN float glassScale(float filmed, float bare) {
    if (filmed > bare) return (1.0f - filmed) / max(1.0f - bare, 1.0e-6f);
    return bare > 0.0f && bare < 1.0f ? filmed / bare : 1.0f;
}

// The film of these values over the reflectances `bare`. Its colour is that of the direction wo, of this cosine, for
// all facets: what tables know about Schlick's approximation then bounds what is sent out. A smooth surface has no
// other. Glass from inside reflects as from outside, along the refracted ray; eta is as of PrincipledLobes.
RT_FN Film filmOf(RT_IN(PrincipledValues) values, RT_IN(Film) bare, float cosine, float eta, bool inside) {
    vec2 glass = fresnel(cosine, eta);
    float outside = inside ? glass.y : cosine;
    float ior = values.rare.filmIor;
    float thickness = values.rare.filmThickness;
    vec3 dielectric = filmReflectance(outside, ior, thickness, bare.f0);
    vec3 metal = filmReflectance(outside, ior, thickness, bare.metalF0);
    vec3 clear = filmReflectance(outside, ior, thickness, vec3(square((values.ior - 1.0f) / (values.ior + 1.0f))));
    float grazing = schlick(cosine);
    float share = values.rare.film;
    Film film;
    vec3 f0 = beforeSchlick(dielectric, grazing);
    film.f0 = mix(bare.f0, max(f0, vec3(0.0f)), share);
    film.f90 = mix(bare.f90, beforeGrazing(f0, dielectric, grazing), share);
    vec3 metalF0 = beforeSchlick(metal, grazing);
    film.metalF0 = mix(bare.metalF0, max(metalF0, vec3(0.0f)), share);
    film.metalF90 = mix(bare.metalF90, beforeGrazing(metalF0, metal, grazing), share);
    vec3 filmed = mix(vec3(glass.x), clear, share);
    film.glassScale = vec3(glassScale(filmed.x, glass.x), glassScale(filmed.y, glass.x), glassScale(filmed.z, glass.x));
    film.glassOffset =
        vec3(filmed.x > glass.x ? 1.0f - film.glassScale.x : 0.0f, filmed.y > glass.x ? 1.0f - film.glassScale.y : 0.0f,
             filmed.z > glass.x ? 1.0f - film.glassScale.z : 0.0f);
    return film;
}

// What filmed solid glass reflects and transmits in all, at most: `reflection` is the albedo of facets that reflect
// all, `whole` that of the glass without a film, `bare` what it reflects of the direction wo. Where the film reflects
// more, so much of it reflects all. Where it reflects less, what bare facets reflect is transmitted, and less of it is
// lost; they reflect twice what a flat surface does, at most.
RT_FN float filmedAlbedo(RT_IN(Film) film, float reflection, float whole, float bare) {
    vec3 part = film.glassScale + film.glassOffset;
    float transmitted = 1.0f - min(part.x, min(part.y, part.z));
    float most = max(whole, reflection);
    float gained = min((2.0f * bare + 0.02f) * (1.0f - reflection), 1.0f - most);
    return most + transmitted * max(gained, 0.0f);
}

// ---- lobes ---------------------------------------------------------------------------------------------------------

// What few lobes need.
RT_FN RareLobes rareLobes(Features features, RT_IN(PrincipledValues) values, RT_IN(PrincipledLobes) lobes,
                          RT_IN(Film) film) {
    RareLobes rare;
    rare.filmScale = film.glassScale;
    rare.filmOffset = film.glassOffset;
    rare.stretch = vec2(1.0f, 0.0f);
    rare.stretchedAlpha = vec2(lobes.alpha);
    if (isStretched(features, lobes)) {
        rare.stretch = values.rare.stretch;
        float along = stretchedWidth(values.roughness, values.rare.anisotropy);
        rare.stretchedAlpha = vec2(along, max(lobes.alpha, kMinAlpha));
    }
    return rare;
}

// Of lobes none but the diffuse one, of this albedo.
RT_FN PrincipledLobes onlyDiffuse(RT_IN(PrincipledLobes) all, vec3 albedo) {
    PrincipledLobes lobes = all;
    lobes.others = 0u;
    lobes.diffuse = albedo;
    lobes.f0 = vec3(0.0f);
    lobes.f90 = vec3(0.0f);
    lobes.sheen = vec3(0.0f);
    lobes.glass = 0.0f;
    lobes.coat = 0.0f;
    lobes.diffuseShare = maxComponent(albedo) > 0.0f ? 1.0f : 0.0f;
    lobes.specularShare = 0.0f;
    lobes.coatShare = 0.0f;
    lobes.glassShare = 0.0f;
    return lobes;
}

// The layers over all others: what they are multiplied by, and what they reflect in all.
struct LayersAbove {
    float coat;
    float coatAlbedo;
    vec3 sheen;
    float sheenAlbedo;
};

// Those of these values; from inside of glass there are none. `cosine` is that of wo, with the coat's normal
// `coatCosine`.
RT_FN LayersAbove layersAbove(SceneRef scene, RT_IN(PrincipledValues) values, float cosine, float coatCosine,
                              bool inside) {
    LayersAbove layers;
    layers.coat = 0.0f;
    layers.coatAlbedo = 0.0f;
    layers.sheen = vec3(0.0f);
    layers.sheenAlbedo = 0.0f;
    if (hasLobe(values.others, kLobeCoat)) {
        vec3 c = directionalAlbedo(scene, coatCosine, values.clearcoatRoughness);
        float boost = compensation(vec3(kCoatReflectance), c.x + c.y).x;
        layers.coat = inside ? 0.0f : values.clearcoat * boost;
        layers.coatAlbedo = layers.coat * (kCoatReflectance * c.x + c.y);
    }
    if (hasLobe(values.others, kLobeSheen)) {
        // Bounded to what arrives: the visibility of these fibres is an approximation without a bound of its own.
        float whole = sheenAlbedo(scene, cosine, values.sheenRoughness);
        layers.sheen = select(inside, vec3(0.0f), values.sheenColor * (1.0f / max(whole, 1.0f)));
        layers.sheenAlbedo = min(maxComponent(layers.sheen) * whole, 1.0f);
    }
    return layers;
}

// What makes up for the losses of rough glass; `a` is the directional albedo of its facets.
RT_FN float glassBoost(Features features, SceneRef scene, RT_IN(PrincipledValues) values, RT_IN(PrincipledLobes) lobes,
                       RT_IN(Film) film, float cosine, vec3 a, bool front) {
    if (isMirror(lobes.alpha) || isStraight(lobes)) return 1.0f;
    float reflection = a.x + a.y;
    if (isStretched(features, lobes)) { // which facets of glass are not
        vec3 own = directionalAlbedo(scene, cosine, values.roughness);
        reflection = own.x + own.y;
    }
    float whole = reflection; // a sheet mirrors to its other side what it does not reflect
    if (values.glass != kNone) {
        whole = glassAlbedo(scene, values.glass, !front, cosine, values.roughness);
        if (isFilmed(features, lobes)) whole = filmedAlbedo(film, reflection, whole, fresnel(cosine, lobes.eta).x);
    }
    return compensation(vec3(1.0f), whole).x;
}

// The lobes of a bsdf that has these values and the base colour `albedo`. `cosine` is that of wo and `a` its
// facetsAlbedo(); `coatNormal` is as lobes have it, `coatCosine` that of wo with it; `front` tells whether wo is on the
// front side. Without a branch but for values.others, for loops over samples.
RT_FN PrincipledLobes makeLobes(Features features, SceneRef scene, RT_IN(PrincipledValues) values, vec3 albedo,
                                float cosine, vec3 a, vec3 coatNormal, float coatCosine, bool front) {
    PrincipledLobes lobes;
    lobes.others = values.others;
    lobes.alpha = square(values.roughness);
    lobes.eta = front || values.thin != 0u ? 1.0f / values.ior : values.ior;
    lobes.thin = values.thin;

    // Clear coat and sheen leave the rest to what is below.
    bool inside = hasLobe(values.others, kLobeGlass) && !front && values.thin == 0u;
    LayersAbove layers = layersAbove(scene, values, cosine, coatCosine, inside);
    float below = (1.0f - layers.coatAlbedo) * (1.0f - layers.sheenAlbedo);

    float metallic = values.metallic;
    float opaque = (1.0f - metallic) * (1.0f - values.transmission);
    vec3 clear = min(values.specularColor * square((values.ior - 1.0f) / (values.ior + 1.0f)), vec3(1.0f));
    Film film = noFilm(clear * values.specular, values.specular, albedo);
    if (isFilmed(features, lobes)) film = filmOf(values, film, cosine, lobes.eta, inside);
    vec3 boost = compensation(film.f0, a.x + a.y);
    vec3 metalBoost = compensation(film.metalF0, a.x + a.y);
    vec3 reflected = (film.f0 * a.x + film.f90 * a.y) * boost;
    float left = below * opaque * max(1.0f - maxComponent(reflected), 0.0f);
    lobes.diffuse = albedo * left;
    lobes.f0 = (film.f0 * boost * opaque + film.metalF0 * metalBoost * metallic) * below;
    lobes.f90 = (boost * (film.f90 * opaque) + film.metalF90 * metalBoost * metallic) * below;
    lobes.sheen = layers.sheen * (1.0f - layers.coatAlbedo);
    lobes.sheenExponent = 1.0f / square(values.sheenRoughness);
    lobes.glass = 0.0f;
    if (hasLobe(values.others, kLobeGlass)) {
        lobes.glass = (1.0f - metallic) * values.transmission * below;
        if (lobes.glass > 0.0f) lobes.glass *= glassBoost(features, scene, values, lobes, film, cosine, a, front);
    }
    lobes.coat = layers.coat;
    lobes.coatAlpha = square(values.clearcoatRoughness);
    lobes.coatNormal = coatNormal;
    lobes.rare = rareLobes(features, values, lobes, film);
    if (!(lobes.glass > 0.0f)) lobes.others &= ~kLobeFilm; // which is in f0 and f90

    if (has(features, kFeatureDiffuseTransmission) && hasLobe(values.others, kLobeBeyond)) {
        lobes.others &= ~kLobeBeyond;
        lobes.diffuse *= 1.0f - values.rare.beyond;
        vec3 beyond = values.rare.beyondColor * (left * values.rare.beyond);
        if (values.rare.isBeyond != 0u) return onlyDiffuse(lobes, beyond);
    }

    float diffuseAlbedo = maxComponent(lobes.diffuse) + layers.sheenAlbedo * (1.0f - layers.coatAlbedo);
    float specularAlbedo = maxComponent(lobes.f0 * a.x + lobes.f90 * a.y);
    float sum = diffuseAlbedo + specularAlbedo + layers.coatAlbedo + lobes.glass;
    float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    lobes.diffuseShare = diffuseAlbedo * scale;
    lobes.specularShare = specularAlbedo * scale;
    lobes.coatShare = layers.coatAlbedo * scale;
    lobes.glassShare = lobes.glass * scale;
    return lobes;
}

RT_SHARED_END

#endif
