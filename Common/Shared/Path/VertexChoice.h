// What a path chooses where it meets a surface, before lights are sampled and it scatters there.
#ifndef RT_SHARED_VERTEX_CHOICE_H
#define RT_SHARED_VERTEX_CHOICE_H
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Path/Vertex.h"

RT_SHARED_BEGIN

const float kOddsOfReflection = 0.05f; // keeps some for what no number below tells of: facets' reflection

// The probability with which a path goes on beyond a surface that transmits diffusely: the share of that light, about.
RT_FN float oddsBeyond(RT_IN(PrincipledValues) values, vec3 albedo) {
    float base = (1.0f - values.metallic) * (1.0f - values.transmission);
    float beyond = base * values.rare.beyond * maxComponent(values.rare.beyondColor);
    float here = base * (1.0f - values.rare.beyond) * maxComponent(albedo) + (1.0f - base);
    return beyond / (beyond + here + kOddsOfReflection);
}

// Where light is transmitted diffusely a path chooses the side of the surface on which it goes on, so that lights there
// can be sampled as well. Beyond, the vertex is as one that reflects diffusely and is seen from there.
RT_FN void chooseSide(Features features, RT_IN(Sampler) smp, RT_INOUT(PathState) s, RT_INOUT(Vertex) v) {
    if (!has(features, kFeatureDiffuseTransmission) || !isPrincipled(features, v.bsdf)) return;
    if (!hasLobe(v.values.others, kLobeBeyond)) return;
    float odds = oddsBeyond(v.values, v.bsdf.albedo);
    bool goesBeyond = sample2D(smp, vertexDimension(v.index, kDimensionSide)).x < odds;
    s.throughput *= 1.0f / (goesBeyond ? odds : 1.0f - odds);
    if (!goesBeyond) return;
    v.wo = -mirrorDirection(v.wo, v.shading);
    v.normal = -v.normal;
    v.shading = -v.shading;
    v.origin = offsetOrigin(v.position, v.error, v.normal, v.normal);
    v.values.rare.isBeyond = 1u;
}

RT_SHARED_END

#endif
