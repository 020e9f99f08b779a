// What the lobes of principled materials send out in all, by tables.
#ifndef RT_SHARED_PRINCIPLED_ALBEDOS_H
#define RT_SHARED_PRINCIPLED_ALBEDOS_H
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Material/Principled.h"

RT_SHARED_BEGIN

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

// What specular facets reflect in all towards wo, which is in the frame of the normal n.
RT_FN vec3 facetsAlbedo(Features features, SceneRef scene, RT_IN(PrincipledValues) values, vec3 n, vec3 wo) {
    if (!has(features, kFeatureAnisotropy) || !hasLobe(values.others, kLobeStretched)) {
        return directionalAlbedo(scene, clamp(dot(wo, n), 0.0f, 1.0f), values.roughness);
    }
    vec3 local = toStretch(values.rare.stretch, toLocal(makeFrame(n), wo));
    return stretchedAlbedo(scene, local, values.roughness, values.rare.anisotropy);
}

RT_SHARED_END

#endif
