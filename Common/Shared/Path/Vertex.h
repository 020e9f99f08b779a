// The vertices of a path: how one comes about, and how it scatters.
#ifndef RT_SHARED_VERTEX_H
#define RT_SHARED_VERTEX_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/PathTypes.h"
#include "Common/Shared/Material/Bsdf.h"
#include "Common/Shared/Material/PrincipledSurface.h"
#include "Common/Shared/Shape/Surface.h"
#include "Common/Shared/Texture/Textures.h"

RT_SHARED_BEGIN

// A place where light scatters: a surface point or a collision in a medium.
struct Vertex {
    uint index;    // position along the path, 0 is what the camera sees
    uint inMedium; // 1: isotropic scattering, of the bsdf only the albedo is used
    uint front;    // 1: wo is on the front side
    Bsdf bsdf;
    vec3 normal;  // geometric, facing wo; zero in a medium
    vec3 shading; // of the bsdf frame, facing wo; zero in a medium
    vec3 wo;
    vec3 position;
    vec3 error;              // of position, per axis
    vec3 origin;             // where rays on wo's side start
    PrincipledValues values; // of a principled material, for completeVertex()
};

// A medium's albedo.
RT_FN vec3 texturedAlbedo(Features features, SceneRef scene, vec3 constant, uint texture, vec3 position) {
    if (!has(features, kTexturedFeatures) || texture == kNone) return constant;
    vec2 none = vec2(0.0f, 0.0f);
    return vec3(evalTexture(features, scene, texture, position + loadGlobals(scene).origin, none, none));
}

// A surface's albedo, or base colour.
RT_FN vec3 surfaceAlbedo(Features features, SceneRef scene, RT_IN(Material) material, RT_IN(Surface) s) {
    vec3 albedo = material.albedo;
    if (has(features, kTexturedFeatures) && material.texture != kNone) {
        albedo =
            vec3(evalTexture(features, scene, material.texture, s.position + loadGlobals(scene).origin, s.uv, s.uv2));
    }
    if (isPrincipled(features, material)) albedo = clamp(albedo * vec3(s.color), vec3(0.0f), vec3(1.0f));
    return albedo;
}

// What scatters in a medium: of it only the albedo counts.
RT_FN Bsdf mediumBsdf(vec3 albedo) {
    Bsdf b;
    b.kind = kMaterialEmitter;
    b.albedo = albedo;
    for (uint i = 0u; i < kMaterialParameters; i++) b.parameter[i] = 0.0f;
    b.lobes = noLobes();
    return b;
}

// The vertex of a collision in medium `index` at the distance t along the path's ray.
RT_FN void placeInMedium(Features features, SceneRef scene, RT_IN(PathState) s, float t, uint index, RT_OUT(Vertex) v) {
    RT_IN(Medium) medium = loadMedium(scene, index);
    v.index = s.vertex - 1u;
    v.inMedium = 1u;
    v.front = 1u;
    v.normal = vec3(0.0f, 0.0f, 0.0f);
    v.shading = vec3(0.0f, 0.0f, 0.0f);
    v.wo = -s.ray.direction;
    v.position = s.ray.origin + s.ray.direction * t;
    v.error = vec3(0.0f, 0.0f, 0.0f);
    v.origin = v.position;
    v.bsdf = mediumBsdf(texturedAlbedo(features, scene, medium.albedo, medium.texture, v.position));
}

// The vertex on a surface that the path's ray hit.
RT_FN void placeOnSurface(Features features, SceneRef scene, RT_IN(PathState) s, RT_IN(Surface) surface,
                          RT_IN(Material) material, RT_OUT(Vertex) v) {
    v.index = s.vertex - 1u;
    v.inMedium = 0u;
    v.wo = -s.ray.direction;
    v.front = dot(v.wo, surface.normal) > 0.0f ? 1u : 0u;
    v.normal = v.front != 0u ? surface.normal : -surface.normal;
    v.shading = v.front != 0u ? surface.shading : -surface.shading;
    if (!(dot(v.wo, v.shading) > 0.0f)) v.shading = v.normal;
    v.position = surface.position;
    v.error = surface.error;
    v.origin = offsetOrigin(surface.position, surface.error, v.normal, v.normal);
    v.bsdf = makeBsdf(material, surfaceAlbedo(features, scene, material, surface));
    if (isPrincipled(features, material)) {
        RT_IN(Principled) p = loadPrincipled(scene, surface.material);
        float facing = v.front != 0u ? 1.0f : -1.0f;
        vec3 mapped = mappedNormal(features, scene, p.normalTexture, p.normalScale, surface, v.shading, facing);
        vec3 n = keepReflectionAbove(mapped, v.normal, v.wo);
        v.bsdf.lobes.coatNormal = coatNormalOf(features, scene, p, surface, v.shading, facing, v.normal, v.wo, n);
        v.shading = n;
        v.values = principledValues(features, scene, p, surface);
        addRareValues(features, scene, p, surface, n, facing, v.values);
    }
}

// Gives a vertex of a principled material its lobes. Apart from its place, as packets of paths do it in lanes.
RT_FN void completeVertex(Features features, SceneRef scene, RT_INOUT(Vertex) v) {
    if (!isPrincipled(features, v.bsdf)) return;
    vec3 coat = v.bsdf.lobes.coatNormal;
    vec3 n = v.shading;
    vec3 wo = v.wo;
    if (has(features, kFeatureDiffuseTransmission) && v.values.rare.isBeyond != 0u) {
        n = -n; // the side from which it is seen, see VertexChoice.h
        wo = -mirrorDirection(wo, v.shading);
    }
    float cosine = clamp(dot(wo, n), 0.0f, 1.0f);
    float coatCosine = cosine;
    if (has(features, kFeatureCoatNormal) && coat.z != 1.0f) {
        coatCosine = clamp(dot(wo, toWorld(makeFrame(n), coat)), 0.0f, 1.0f);
    }
    vec3 a = facetsAlbedo(features, scene, v.values, n, wo);
    v.bsdf.lobes = makeLobes(features, scene, v.values, v.bsdf.albedo, cosine, a, coat, coatCosine, v.front != 0u);
}

// f |cos| in rgb, density over solid angle of the bsdf's own sampling in w. Directions that cross the geometric surface
// are black, whatever the interpolated normal says.
RT_FN vec4 evalScattering(Features features, RT_IN(Vertex) v, vec3 wi) {
    if (has(features, kFeatureVolumes) && v.inMedium != 0u) {
        return vec4(v.bsdf.albedo * kPhasePdf, kPhasePdf);
    }
    if (!(dot(wi, v.normal) > 0.0f)) return vec4(0.0f, 0.0f, 0.0f, 0.0f);
    return evalBsdf(features, v.bsdf, v.shading, v.wo, wi);
}

RT_FN bool isDeltaVertex(Features features, RT_IN(Vertex) v) {
    if (has(features, kFeatureVolumes) && v.inMedium != 0u) return false;
    return isDelta(features, v.bsdf);
}

RT_FN BsdfSample sampleScattering(Features features, RT_IN(Vertex) v, vec2 u) {
    if (has(features, kFeatureVolumes) && v.inMedium != 0u) return samplePhase(v.bsdf.albedo, u);
    return sampleBsdf(features, v.bsdf, v.shading, v.front, v.wo, u, u.x);
}

RT_FN LightContext lightContext(RT_IN(Vertex) v) {
    LightContext context;
    context.position = v.origin;
    context.normal = v.shading;
    context.total = 0.0f;
    return context;
}

RT_SHARED_END

#endif
