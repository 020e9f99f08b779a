// From a principled material and a hit to the lobes of Principled.h: textures, normal map, what the layers leave to
// those below them, and the choice among lobes.
//
// In GLSL only shaders that define RT_HEAVY_FEATURES have the code, see Shim.h.
#ifndef RT_SHARED_PRINCIPLED_SURFACE_H
#define RT_SHARED_PRINCIPLED_SURFACE_H
#include "Common/Shared/Material/Bsdf.h"
#include "Common/Shared/Shape/Surface.h"
#include "Common/Shared/Texture/Textures.h"

RT_SHARED_BEGIN

RT_FN bool isPrincipled(Features features, RT_IN(Material) m) {
    return has(features, kFeaturePrincipled) && m.kind == kMaterialPrincipled;
}

#ifdef RT_HEAVY_FEATURES

// ---- directional albedo --------------------------------------------------------------------------------------------

// Tables of what lobes reflect in all, over the cosine of wo and the roughness, kAlbedoSteps entries each. Between them
// albedos are never too low: what is left to the layers below, and what makes up for losses, would add up to more than
// arrives.

const float kMinAlbedoCosine = 1.0e-4f; // of the first column; its fourth root, by which columns lie, is 0.1

// (column, row) of a lobe that has no roughness below `minRoughness`, that of the first row. Albedos change fastest at
// grazing angles and with little roughness.
RT_FN vec2 albedoPlace(float cosine, float roughness, float minRoughness) {
    float column = (sqrt(sqrt(max(cosine, kMinAlbedoCosine))) - 0.1f) * (1.0f / 0.9f);
    float row = sqrt(max(roughness - minRoughness, 0.0f) * (1.0f / (1.0f - minRoughness)));
    return vec2(column, row) * float(kAlbedoSteps - 1u);
}

RT_FN vec3 tabledAlbedo(SceneRef scene, vec2 at) {
    uint column = min(uint(at.x), kAlbedoSteps - 2u);
    uint row = min(uint(at.y), kAlbedoSteps - 2u);
    vec2 part = at - vec2(float(column), float(row));
    uint first = row * kAlbedoSteps + column;
    vec3 lower = mix(loadDirectionalAlbedo(scene, first), loadDirectionalAlbedo(scene, first + 1u), part.x);
    first += kAlbedoSteps;
    vec3 upper = mix(loadDirectionalAlbedo(scene, first), loadDirectionalAlbedo(scene, first + 1u), part.x);
    return mix(lower, upper, part.y);
}

// What GGX facets reflect in all: x and y are the factors of the reflectance at normal and at grazing incidence (Karis,
// "Real Shading in Unreal Engine 4", 2013).
RT_FN vec3 directionalAlbedo(SceneRef scene, float cosine, float roughness) {
    vec3 rough = tabledAlbedo(scene, albedoPlace(cosine, roughness, kMinRoughness));
    float grazing = schlick(cosine);
    return select(isMirror(square(roughness)), vec3(1.0f - grazing, grazing, 0.0f), rough);
}

// What white sheen would reflect in all: more than arrives, where it grazes fibres that are smooth.
RT_FN float sheenAlbedo(SceneRef scene, float cosine, float roughness) {
    return tabledAlbedo(scene, albedoPlace(cosine, roughness, kMinSheenRoughness)).z;
}

// What rough glass reflects and transmits in all, from outside or from inside: two such tables, one after the other,
// from `first` on.
RT_FN float glassAlbedo(SceneRef scene, uint first, bool inside, float cosine, float roughness) {
    vec2 at = albedoPlace(cosine, roughness, kMinRoughness);
    uint column = min(uint(at.x), kAlbedoSteps - 2u);
    uint row = min(uint(at.y), kAlbedoSteps - 2u);
    vec2 part = at - vec2(float(column), float(row));
    uint i = first + ((inside ? kAlbedoSteps : 0u) + row) * kAlbedoSteps + column;
    float lower = mix(loadGlassAlbedo(scene, i), loadGlassAlbedo(scene, i + 1u), part.x);
    i += kAlbedoSteps;
    return mix(lower, mix(loadGlassAlbedo(scene, i), loadGlassAlbedo(scene, i + 1u), part.x), part.y);
}

// The width of facets along the direction in which they are rougher, given the roughness across it: that of
// KHR_materials_anisotropy.
RT_FN float stretchedWidth(float roughness, float strength) {
    return mix(square(roughness), 1.0f, square(strength));
}

// That of facets that are rougher along one direction, for the unit direction wo in the frame of which x is that
// direction: as directionalAlbedo(). A table over the strength, the roughness across, the width of facets as wo sees
// them, and the cosine.
RT_FN vec3 stretchedAlbedo(SceneRef scene, vec3 wo, float roughness, float strength) {
    float across = square(roughness);
    float along = stretchedWidth(roughness, strength);
    float side = max(square(wo.x) + square(wo.y), 1.0e-20f);
    float seen = sqrt((square(along * wo.x) + square(across * wo.y)) / side);
    float turn = clamp((seen - across) / max(along - across, 1.0e-20f), 0.0f, 1.0f);
    vec2 place = albedoPlace(clamp(wo.z, 0.0f, 1.0f), roughness, kMinRoughness) * (1.0f / float(kAlbedoSteps - 1u));
    vec4 at = vec4(place.x * float(kStretchedCosines - 1u), sqrt(sqrt(turn)) * float(kStretchedTurns - 1u),
                   place.y * float(kStretchedRoughnesses - 1u), sqrt(strength) * float(kStretchedStrengths - 1u));
    uvec4 cell = min(uvec4(at), uvec4(kStretchedCosines - 2u, kStretchedTurns - 2u, kStretchedRoughnesses - 2u,
                                      kStretchedStrengths - 2u));
    vec4 part = at - vec4(cell);
    vec2 sum = vec2(0.0f, 0.0f);
    for (uint corner = 0u; corner < 16u; corner++) {
        uvec4 step = uvec4(corner & 1u, corner >> 1u & 1u, corner >> 2u & 1u, corner >> 3u);
        uvec4 i = cell + step;
        float weight = (step.x != 0u ? part.x : 1.0f - part.x) * (step.y != 0u ? part.y : 1.0f - part.y) *
                       (step.z != 0u ? part.z : 1.0f - part.z) * (step.w != 0u ? part.w : 1.0f - part.w);
        uint entry = ((i.w * kStretchedRoughnesses + i.z) * kStretchedTurns + i.y) * kStretchedCosines + i.x;
        sum += loadStretchedAlbedo(scene, entry) * weight;
    }
    return vec3(sum.x, sum.y, 0.0f);
}

// ---- textures ------------------------------------------------------------------------------------------------------

// A texture's colour and opacity on a surface.
RT_FN vec4 surfaceTexture(Features features, SceneRef scene, uint texture, RT_IN(Surface) s) {
    return evalTexture(features, scene, texture, s.position + loadGlobals(scene).origin, s.uv, s.uv2);
}

RT_FN float surfaceNumber(Features features, SceneRef scene, RT_IN(ScaledChannel) number, RT_IN(Surface) s) {
    if (!has(features, kTexturedFeatures) || number.texture == kNone) return number.factor;
    vec4 texel = surfaceTexture(features, scene, number.texture, s);
    float high = number.channel == 2u ? texel.z : texel.w;
    float low = number.channel == 0u ? texel.x : texel.y;
    float usual = number.factor < 0.0f ? 1.0f : 0.0f;
    return clamp(usual + number.factor * (number.channel < 2u ? low : high), 0.0f, 1.0f);
}

RT_FN vec3 surfaceColor(Features features, SceneRef scene, RT_IN(TintedTexture) source, RT_IN(Surface) s) {
    if (!has(features, kTexturedFeatures) || source.texture == kNone) return source.color;
    return vec3(surfaceTexture(features, scene, source.texture, s));
}

// Share of rays that meet the surface.
RT_FN float surfaceOpacity(Features features, SceneRef scene, RT_IN(Principled) p, RT_IN(Surface) s) {
    float opacity = surfaceNumber(features, scene, p.opacity, s) * s.color.w;
    if (p.alphaCutoff < 0.0f) return opacity;
    return opacity < p.alphaCutoff ? 0.0f : 1.0f;
}

// ---- normal map ----------------------------------------------------------------------------------------------------

// The least cosine with the geometric normal of the reflection at a bent shading normal.
const float kMinReflection = 0.01f;

// The normal n, bent back so far towards the geometric one that the mirror direction of wo stays above the surface:
// otherwise bumps seen at grazing angles would be black.
RT_FN vec3 keepReflectionAbove(vec3 n, vec3 geometric, vec3 wo) {
    vec3 reflected = n * (2.0f * dot(n, wo)) - wo;
    float above = dot(reflected, geometric);
    // At grazing angles the flat surface's own reflection is as low as wo.
    float minimum = min(kMinReflection, 0.5f * dot(wo, geometric));
    if (above >= minimum) return n;
    vec3 half_ = wo + normalize(reflected + geometric * (minimum - above));
    return normalize(half_);
}

// The shading normal that a map asks for, on the side of `shading`; `facing` is 1 on the front and -1 on the back.
// `scale` is that of the map's x and y.
RT_FN vec3 mappedNormal(Features features, SceneRef scene, uint texture, float scale, RT_IN(Surface) s, vec3 shading,
                        float facing) {
    if (!has(features, kTexturedFeatures) || texture == kNone || s.tangent.w == 0.0f) return shading;
    vec3 tangent = vec3(s.tangent) - shading * dot(vec3(s.tangent), shading);
    float length2 = dot(tangent, tangent);
    if (!(length2 > 1.0e-12f)) return shading;
    tangent = tangent * (1.0f / sqrt(length2));
    vec3 bitangent = cross(shading * facing, tangent) * s.tangent.w;
    vec3 local = vec3(surfaceTexture(features, scene, texture, s)) * 2.0f - vec3(1.0f);
    // On the back the map is seen from behind.
    vec3 n =
        tangent * (local.x * scale * facing) + bitangent * (local.y * scale * facing) + shading * max(local.z, 0.0f);
    float squared = dot(n, n);
    return squared > 1.0e-12f ? n * (1.0f / sqrt(squared)) : shading;
}

// The normal of the clear coat in the frame of n, the normal of what is below it: each has its own map, and without one
// is smooth. Other arguments as of mappedNormal() and keepReflectionAbove().
RT_FN vec3 coatNormalOf(Features features, SceneRef scene, RT_IN(Principled) p, RT_IN(Surface) s, vec3 shading,
                        float facing, vec3 geometric, vec3 wo, vec3 n) {
    bool isOwn = has(features, kFeatureCoatNormal) && (p.normalTexture != kNone || p.coatTexture != kNone);
    if (!isOwn) return vec3(0.0f, 0.0f, 1.0f);
    vec3 mapped = mappedNormal(features, scene, p.coatTexture, p.coatScale, s, shading, facing);
    return toLocal(makeFrame(n), keepReflectionAbove(mapped, geometric, wo));
}

// ---- lobes ---------------------------------------------------------------------------------------------------------

// What single reflection at rough facets loses is put back in proportion: Turquin, "Practical Multiple Scattering
// Compensation for Microfacet Models", 2019. `whole` is the albedo of facets that reflect everything.
RT_FN vec3 compensation(vec3 f0, float whole) {
    return vec3(1.0f) + f0 * (1.0f / max(whole, 1.0e-3f) - 1.0f);
}

// Adds how far facets are stretched, where they are and the surface has a tangent; see addRareValues().
RT_FN void addAnisotropy(Features features, SceneRef scene, RT_IN(Principled) p, RT_IN(Surface) s, vec3 n, float facing,
                         RT_INOUT(PrincipledValues) values) {
    if (!has(features, kFeatureAnisotropy) || s.tangent.w == 0.0f) return;
    float strength = surfaceNumber(features, scene, p.anisotropy, s);
    if (isMirror(stretchedWidth(values.roughness, strength))) return;
    vec2 direction = p.stretch;
    if (has(features, kTexturedFeatures) && p.stretchTexture != kNone) {
        vec3 texel = vec3(surfaceTexture(features, scene, p.stretchTexture, s));
        vec2 mapped = vec2(2.0f * texel.x - 1.0f, 2.0f * texel.y - 1.0f);
        direction =
            vec2(mapped.x * p.stretch.x - mapped.y * p.stretch.y, mapped.x * p.stretch.y + mapped.y * p.stretch.x);
    }
    vec3 tangent = vec3(s.tangent) - n * dot(vec3(s.tangent), n);
    float length2 = dot(tangent, tangent);
    if (!(strength > 0.0f) || !(length2 > 1.0e-12f)) return;
    tangent = tangent * (1.0f / sqrt(length2));
    vec3 along = tangent * direction.x + cross(n * facing, tangent) * (s.tangent.w * direction.y);
    vec3 local = toLocal(makeFrame(n), along);
    float squared = square(local.x) + square(local.y);
    if (!(squared > 1.0e-12f)) return;
    values.others |= kLobeStretched;
    values.rare.anisotropy = strength;
    values.rare.stretch = vec2(local.x, local.y) * (1.0f / sqrt(squared));
}

// Of the principled material p at a point, but for addRareValues().
RT_FN PrincipledValues principledValues(Features features, SceneRef scene, RT_IN(Principled) p, RT_IN(Surface) s) {
    PrincipledValues values;
    values.metallic = surfaceNumber(features, scene, p.metallic, s);
    values.roughness = surfaceNumber(features, scene, p.roughness, s);
    values.specular = surfaceNumber(features, scene, p.specular, s);
    values.transmission = surfaceNumber(features, scene, p.transmission, s);
    values.clearcoat = surfaceNumber(features, scene, p.clearcoat, s);
    values.clearcoatRoughness = surfaceNumber(features, scene, p.clearcoatRoughness, s);
    values.sheenRoughness = max(surfaceNumber(features, scene, p.sheenRoughness, s), kMinSheenRoughness);
    values.specularColor = surfaceColor(features, scene, p.specularColor, s);
    values.sheenColor = surfaceColor(features, scene, p.sheenColor, s);
    values.ior = p.ior;
    values.thin = p.thin;
    values.glass = p.glass;
    values.rare.anisotropy = 0.0f;
    values.rare.stretch = vec2(1.0f, 0.0f);
    values.rare.film = 0.0f;
    values.rare.filmThickness = 0.0f;
    values.rare.filmIor = 1.0f;
    values.rare.beyond = 0.0f;
    values.rare.beyondColor = vec3(1.0f);
    values.rare.isBeyond = 0u;
    values.others = (maxComponent(values.sheenColor) > 0.0f ? kLobeSheen : 0u) |
                    (values.clearcoat > 0.0f ? kLobeCoat : 0u) | (values.transmission > 0.0f ? kLobeGlass : 0u);
    return values;
}

// What specular facets reflect in all towards wo, which is in the frame of the normal n.
RT_FN vec3 facetsAlbedo(Features features, SceneRef scene, RT_IN(PrincipledValues) values, vec3 n, vec3 wo) {
    if (!has(features, kFeatureAnisotropy) || !hasLobe(values.others, kLobeStretched)) {
        return directionalAlbedo(scene, clamp(dot(wo, n), 0.0f, 1.0f), values.roughness);
    }
    vec3 local = toStretch(values.rare.stretch, toLocal(makeFrame(n), wo));
    return stretchedAlbedo(scene, local, values.roughness, values.rare.anisotropy);
}

// Adds the thin film, where there is one.
RT_FN void addFilm(Features features, SceneRef scene, RT_IN(Principled) p, RT_IN(Surface) s,
                   RT_INOUT(PrincipledValues) values) {
    if (!has(features, kFeatureIridescence)) return;
    values.rare.film = surfaceNumber(features, scene, p.iridescence, s);
    float thickness = surfaceNumber(features, scene, p.iridescenceThickness, s);
    values.rare.filmThickness = mix(p.filmThickness.x, p.filmThickness.y, thickness);
    values.rare.filmIor = p.filmIor;
    if (values.rare.film > 0.0f && values.rare.filmThickness > 0.0f) values.others |= kLobeFilm;
}

// Adds diffuse transmission, where there is some.
RT_FN void addDiffuseTransmission(Features features, SceneRef scene, RT_IN(Principled) p, RT_IN(Surface) s,
                                  RT_INOUT(PrincipledValues) values) {
    if (!has(features, kFeatureDiffuseTransmission)) return;
    values.rare.beyond = surfaceNumber(features, scene, p.diffuseTransmission, s);
    values.rare.beyondColor = clamp(surfaceColor(features, scene, p.diffuseTransmissionColor, s), 0.0f, 1.0f);
    if (values.rare.beyond > 0.0f) values.others |= kLobeBeyond;
}

// What few materials have. `n` is the normal that facets lie about, on the side that is seen; `facing` is 1 on the front
// and -1 on the back.
RT_FN void addRareValues(Features features, SceneRef scene, RT_IN(Principled) p, RT_IN(Surface) s, vec3 n, float facing,
                         RT_INOUT(PrincipledValues) values) {
    addAnisotropy(features, scene, p, s, n, facing, values);
    addFilm(features, scene, p, s, values);
    addDiffuseTransmission(features, scene, p, s, values);
}

// What a film makes of reflectances: of those at normal and at grazing incidence, and of that of glass, R, which becomes
// glassScale R + glassOffset.
struct Film {
    vec3 f0;
    vec3 f90;
    vec3 metalF0;
    vec3 metalF90;
    vec3 glassScale;
    vec3 glassOffset;
};

RT_FN Film noFilm() {
    Film film;
    film.f0 = vec3(0.0f);
    film.f90 = vec3(1.0f);
    film.metalF0 = vec3(0.0f);
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

// Of the film of these values over reflectances f0 and, of metal, `albedo`. Its colour is that of the direction wo, of
// this cosine, for all facets: what tables know about Schlick's approximation then bounds what is sent out. A smooth
// surface has no other. Glass from inside reflects as from outside, along the refracted ray.
RT_FN Film filmOf(RT_IN(PrincipledValues) values, vec3 f0, vec3 albedo, float cosine, float eta, bool inside) {
    Film film;
    vec2 bare = fresnel(cosine, eta);
    float outside = inside ? bare.y : cosine;
    vec3 dielectric = filmReflectance(outside, values.rare.filmIor, values.rare.filmThickness, f0);
    vec3 metal = filmReflectance(outside, values.rare.filmIor, values.rare.filmThickness, albedo);
    float grazing = schlick(cosine);
    film.f0 = beforeSchlick(dielectric, grazing);
    film.f90 = beforeGrazing(film.f0, dielectric, grazing);
    film.f0 = max(film.f0, vec3(0.0f));
    film.metalF0 = beforeSchlick(metal, grazing);
    film.metalF90 = beforeGrazing(film.metalF0, metal, grazing);
    film.metalF0 = max(film.metalF0, vec3(0.0f));

    float clear = square((values.ior - 1.0f) / (values.ior + 1.0f));
    vec3 glass = filmReflectance(outside, values.rare.filmIor, values.rare.filmThickness, vec3(clear));
    vec3 filmed = mix(vec3(bare.x), glass, values.rare.film);
    film.glassScale = vec3(glassScale(filmed.x, bare.x), glassScale(filmed.y, bare.x), glassScale(filmed.z, bare.x));
    film.glassOffset =
        vec3(filmed.x > bare.x ? 1.0f - film.glassScale.x : 0.0f, filmed.y > bare.x ? 1.0f - film.glassScale.y : 0.0f,
             filmed.z > bare.x ? 1.0f - film.glassScale.z : 0.0f);
    return film;
}

// What filmed glass reflects and transmits in all, at most: `reflection` is the albedo of facets that reflect all,
// `whole` that of the glass without a film. Where the film reflects more, so much of it reflects all; where it reflects
// less, the rest transmits what the glass would reflect.
RT_FN float filmedAlbedo(RT_IN(Film) film, float reflection, float whole) {
    float transmitted = 1.0f - min(film.glassScale.x + film.glassOffset.x,
                                   min(film.glassScale.y + film.glassOffset.y, film.glassScale.z + film.glassOffset.z));
    float most = max(whole, reflection);
    return most + transmitted * max(1.0f - most, 0.0f);
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

// The lobes of a bsdf that has these values and the base colour `albedo`. `cosine` is that of wo and `a` its
// facetsAlbedo(); `coatNormal` is as lobes have it, `coatCosine` that of wo with it; `front`
// tells whether wo is on the front side. Without a branch but for values.others, for loops over samples.
RT_FN PrincipledLobes makeLobes(Features features, SceneRef scene, RT_IN(PrincipledValues) values, vec3 albedo,
                                float cosine, vec3 a, vec3 coatNormal, float coatCosine, bool front) {
    PrincipledLobes lobes;
    lobes.others = values.others;

    // Clear coat and sheen leave the rest to what is below. From inside of glass there is neither.
    bool inside = hasLobe(values.others, kLobeGlass) && !front && values.thin == 0u;
    float coat = 0.0f;
    float coatAlbedo = 0.0f;
    if (hasLobe(values.others, kLobeCoat)) {
        vec3 c = directionalAlbedo(scene, coatCosine, values.clearcoatRoughness);
        float boost = compensation(vec3(kCoatReflectance), c.x + c.y).x;
        coat = inside ? 0.0f : values.clearcoat * boost;
        coatAlbedo = coat * (kCoatReflectance * c.x + c.y);
    }
    vec3 sheen = vec3(0.0f);
    float reflectedBySheen = 0.0f;
    if (hasLobe(values.others, kLobeSheen)) {
        // Bounded to what arrives: the visibility of these fibres is an approximation without a bound of its own.
        float whole = sheenAlbedo(scene, cosine, values.sheenRoughness);
        sheen = select(inside, vec3(0.0f), values.sheenColor * (1.0f / max(whole, 1.0f)));
        reflectedBySheen = min(maxComponent(sheen) * whole, 1.0f);
    }
    float below = (1.0f - coatAlbedo) * (1.0f - reflectedBySheen);

    lobes.alpha = square(values.roughness);
    lobes.eta = front || values.thin != 0u ? 1.0f / values.ior : values.ior;
    lobes.thin = values.thin;

    float specular = values.specular;
    float metallic = values.metallic;
    float opaque = (1.0f - metallic) * (1.0f - values.transmission);
    vec3 f0 = min(values.specularColor * square((values.ior - 1.0f) / (values.ior + 1.0f)), vec3(1.0f)) * specular;
    vec3 f90 = vec3(specular);
    vec3 metalF0 = albedo;
    vec3 metalF90 = vec3(1.0f);
    Film film = noFilm();
    if (isFilmed(features, lobes)) {
        film = filmOf(values, f0, albedo, cosine, lobes.eta, inside);
        f0 = mix(f0, film.f0, values.rare.film);
        f90 = mix(f90, film.f90, values.rare.film);
        metalF0 = mix(metalF0, film.metalF0, values.rare.film);
        metalF90 = mix(metalF90, film.metalF90, values.rare.film);
    }
    vec3 boost = compensation(f0, a.x + a.y);
    vec3 metalBoost = compensation(metalF0, a.x + a.y);
    vec3 reflected = (f0 * a.x + f90 * a.y) * boost;
    float left = below * opaque * max(1.0f - maxComponent(reflected), 0.0f);
    lobes.diffuse = albedo * left;
    lobes.f0 = (f0 * boost * opaque + metalF0 * metalBoost * metallic) * below;
    lobes.f90 = (boost * (f90 * opaque) + metalF90 * metalBoost * metallic) * below;
    lobes.sheen = sheen * (1.0f - coatAlbedo);
    lobes.sheenExponent = 1.0f / square(values.sheenRoughness);
    lobes.glass = 0.0f;
    if (hasLobe(values.others, kLobeGlass)) {
        lobes.glass = (1.0f - metallic) * values.transmission * below;
        if (lobes.glass > 0.0f && !isMirror(lobes.alpha) && !isStraight(lobes)) {
            // A sheet mirrors to its other side what it does not reflect.
            float whole = a.x + a.y;
            if (isStretched(features, lobes)) { // which facets of glass are not
                vec3 own = directionalAlbedo(scene, cosine, values.roughness);
                whole = own.x + own.y;
            }
            if (values.glass != kNone) whole = glassAlbedo(scene, values.glass, !front, cosine, values.roughness);
            if (isFilmed(features, lobes)) whole = filmedAlbedo(film, a.x + a.y, whole);
            lobes.glass *= compensation(vec3(1.0f), whole).x;
        }
    }
    lobes.coat = coat;
    lobes.coatAlpha = square(values.clearcoatRoughness);
    lobes.coatNormal = coatNormal;
    lobes.rare.filmScale = film.glassScale;
    lobes.rare.filmOffset = film.glassOffset;
    if (!(lobes.glass > 0.0f)) lobes.others &= ~kLobeFilm; // which is in f0 and f90
    lobes.rare.stretch = vec2(1.0f, 0.0f);
    lobes.rare.stretchedAlpha = vec2(lobes.alpha);
    if (isStretched(features, lobes)) {
        lobes.rare.stretch = values.rare.stretch;
        lobes.rare.stretchedAlpha =
            vec2(stretchedWidth(values.roughness, values.rare.anisotropy), max(lobes.alpha, kMinAlpha));
    }

    if (has(features, kFeatureDiffuseTransmission) && hasLobe(values.others, kLobeBeyond)) {
        lobes.others &= ~kLobeBeyond;
        lobes.diffuse *= 1.0f - values.rare.beyond;
        if (values.rare.isBeyond != 0u)
            return onlyDiffuse(lobes, values.rare.beyondColor * (left * values.rare.beyond));
    }

    float diffuseAlbedo = maxComponent(lobes.diffuse) + reflectedBySheen * (1.0f - coatAlbedo);
    float specularAlbedo = maxComponent(lobes.f0 * a.x + lobes.f90 * a.y);
    float sum = diffuseAlbedo + specularAlbedo + coatAlbedo + lobes.glass;
    float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    lobes.diffuseShare = diffuseAlbedo * scale;
    lobes.specularShare = specularAlbedo * scale;
    lobes.coatShare = coatAlbedo * scale;
    lobes.glassShare = lobes.glass * scale;
    return lobes;
}

#else

float surfaceOpacity(Features features, SceneRef scene, Principled p, Surface s) {
    return 1.0f;
}
vec3 keepReflectionAbove(vec3 n, vec3 geometric, vec3 wo) {
    return n;
}
vec3 mappedNormal(Features features, SceneRef scene, uint texture, float scale, Surface s, vec3 shading, float facing) {
    return shading;
}
vec3 coatNormalOf(Features features, SceneRef scene, Principled p, Surface s, vec3 shading, float facing,
                  vec3 geometric, vec3 wo, vec3 n) {
    return vec3(0.0f, 0.0f, 1.0f);
}
vec3 facetsAlbedo(Features features, SceneRef scene, PrincipledValues values, vec3 n, vec3 wo) {
    return vec3(0.0f);
}
void addRareValues(Features features, SceneRef scene, Principled p, Surface s, vec3 n, float facing,
                   inout PrincipledValues values) {}
PrincipledValues principledValues(Features features, SceneRef scene, Principled p, Surface s) {
    PrincipledValues values;
    values.others = 0u;
    values.roughness = 0.0f;
    return values;
}
PrincipledLobes makeLobes(Features features, SceneRef scene, PrincipledValues values, vec3 albedo, float cosine, vec3 a,
                          vec3 coatNormal, float coatCosine, bool front) {
    return noLobes();
}

#endif

RT_SHARED_END

#endif
