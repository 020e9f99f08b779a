// From a principled material and a hit to what it is there: textures, opacity, normal map, numbers.
#ifndef RT_SHARED_PRINCIPLED_VALUES_H
#define RT_SHARED_PRINCIPLED_VALUES_H
#include "Common/Shared/Material/PrincipledAlbedos.h"
#include "Common/Shared/Shape/Surface.h"
#include "Common/Shared/Texture/Textures.h"

RT_SHARED_BEGIN

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

// ---- values --------------------------------------------------------------------------------------------------------

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

// What few materials have. `n` is the normal that facets lie about, on the side that is seen; `facing` is 1 on the
// front and -1 on the back.
RT_FN void addRareValues(Features features, SceneRef scene, RT_IN(Principled) p, RT_IN(Surface) s, vec3 n, float facing,
                         RT_INOUT(PrincipledValues) values) {
    addAnisotropy(features, scene, p, s, n, facing, values);
    addFilm(features, scene, p, s, values);
    addDiffuseTransmission(features, scene, p, s, values);
}

RT_SHARED_END

#endif
