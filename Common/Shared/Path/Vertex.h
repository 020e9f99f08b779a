// The vertices of a path: how one comes about, and how it scatters.
#ifndef RT_SHARED_VERTEX_H
#define RT_SHARED_VERTEX_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Material/Bsdf.h"
#include "Common/Shared/Shape/Surface.h"
#include "Common/Shared/Texture/Textures.h"

RT_SHARED_BEGIN

// A place where light scatters: a surface point or a collision in a medium.
struct Vertex {
    uint index;    // position along the path, 0 is what the camera sees
    uint inMedium; // 1: isotropic scattering, the fields up to albedo are unused
    uint front;    // 1: wo is on the front side
    Material material;
    vec3 normal;  // geometric, facing wo; zero in a medium
    vec3 shading; // of the bsdf frame, facing wo; zero in a medium
    vec3 wo;
    vec3 albedo;
    vec3 position;
    vec3 error;  // of position, per axis
    vec3 origin; // where rays on wo's side start
    VertexNumbers numbers;
};

RT_FN vec3 texturedAlbedo(uint features, SceneRef scene, vec3 constant, uint texture, vec3 position, vec2 uv) {
    if (!has(features, kTexturedFeatures) || texture == kNone) return constant;
    return evalTexture(features, scene, texture, position + loadGlobals(scene).origin, uv);
}

// The material of what has none.
RT_FN Material blackMaterial() {
    Material m;
    m.kind = kMaterialEmitter;
    m.albedo = vec3(0.0f, 0.0f, 0.0f);
    m.texture = kNone;
    for (uint i = 0u; i < kMaterialParameters; i++) m.parameter[i] = 0.0f;
    m.emission = vec3(0.0f, 0.0f, 0.0f);
    m.emissionTexture = kNone;
    m.emissionSides = kSidesFront;
    return m;
}

// Sets all of v but its numbers.
RT_FN void placeInMedium(uint features, SceneRef scene, RT_IN(PathState) s, float t, uint index, RT_OUT(Vertex) v) {
    RT_IN(Medium) medium = loadMedium(scene, index);
    v.index = s.vertex - 1u;
    v.inMedium = 1u;
    v.front = 1u;
    v.material = blackMaterial();
    v.normal = vec3(0.0f, 0.0f, 0.0f);
    v.shading = vec3(0.0f, 0.0f, 0.0f);
    v.wo = -s.ray.direction;
    v.position = s.ray.origin + s.ray.direction * t;
    v.error = vec3(0.0f, 0.0f, 0.0f);
    v.origin = v.position;
    v.albedo = texturedAlbedo(features, scene, medium.albedo, medium.texture, v.position, vec2(0.0f, 0.0f));
}

// The same.
RT_FN void placeOnSurface(uint features, SceneRef scene, RT_IN(PathState) s, RT_IN(Surface) surface,
                          RT_IN(Material) material, RT_OUT(Vertex) v) {
    v.index = s.vertex - 1u;
    v.inMedium = 0u;
    v.wo = -s.ray.direction;
    v.front = dot(v.wo, surface.normal) > 0.0f ? 1u : 0u;
    v.material = material;
    v.normal = v.front != 0u ? surface.normal : -surface.normal;
    v.shading = v.front != 0u ? surface.shading : -surface.shading;
    if (!(dot(v.wo, v.shading) > 0.0f)) v.shading = v.normal;
    v.position = surface.position;
    v.error = surface.error;
    v.origin = offsetOrigin(surface.position, surface.error, v.normal, v.normal);
    v.albedo = texturedAlbedo(features, scene, material.albedo, material.texture, surface.position, surface.uv);
}

// f |cos| in rgb, density over solid angle of the bsdf's own sampling in w. Directions that cross the geometric surface
// are black, whatever the interpolated normal says.
RT_FN vec4 evalScattering(uint features, RT_IN(Vertex) v, vec3 wi) {
    if (has(features, kFeatureVolumes) && v.inMedium != 0u) {
        return vec4(v.albedo * kPhasePdf, kPhasePdf);
    }
    if (!(dot(wi, v.normal) > 0.0f)) return vec4(0.0f, 0.0f, 0.0f, 0.0f);
    return evalBsdf(features, v.material, v.albedo, v.shading, v.wo, wi);
}

RT_FN bool isDeltaVertex(uint features, RT_IN(Vertex) v) {
    if (has(features, kFeatureVolumes) && v.inMedium != 0u) return false;
    return isDelta(features, v.material);
}

RT_FN BsdfSample sampleScattering(uint features, RT_IN(Vertex) v, vec2 u) {
    if (has(features, kFeatureVolumes) && v.inMedium != 0u) return samplePhase(v.albedo, u);
    return sampleBsdf(features, v.material, v.albedo, v.shading, v.front, v.wo, u, u.x);
}

RT_FN LightContext lightContext(RT_IN(RenderParams) params, RT_IN(Vertex) v) {
    LightContext context;
    context.position = v.origin;
    context.normal = v.shading;
    context.total = 0.0f;
    context.policy = params.lightSelection;
    return context;
}

RT_SHARED_END

#endif
