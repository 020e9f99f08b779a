// What a path chooses where it meets a surface, before lights are sampled and it scatters there.
#ifndef RT_SHARED_VERTEX_CHOICE_H
#define RT_SHARED_VERTEX_CHOICE_H
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Path/Vertex.h"

RT_SHARED_BEGIN

const float kOddsOfReflection = 0.05f; // keeps some for what no number below tells of: facets' reflection

// Where glass disperses a path goes on with one colour channel, chosen as likely as it weighs and weighed accordingly,
// and with the index of refraction of that channel. What has chosen before has one channel left, and keeps it.
RT_FN void chooseChannel(Features features, SceneRef scene, RT_IN(Sampler) smp, uint material, RT_INOUT(PathState) s,
                         RT_INOUT(Vertex) v) {
    if (!has(features, kFeatureDispersion) || !isPrincipled(features, v.bsdf)) return;
    if (!hasLobe(v.values.others, kLobeGlass) || v.values.thin != 0u) return;
    RT_IN(Principled) p = loadPrincipled(scene, material);
    if (!(p.channelIor.x > 0.0f)) return;
    vec3 t = s.throughput;
    float sum = t.x + t.y + t.z;
    float u = sample2D(smp, vertexDimension(v.index, kDimensionSide)).y * sum;
    if (u < t.x) {
        s.throughput = vec3(sum, 0.0f, 0.0f);
        v.values.ior = p.channelIor.x;
        v.values.glass = p.channelGlass.x;
    } else if (u < t.x + t.y || !(t.z > 0.0f)) {
        s.throughput = vec3(0.0f, sum, 0.0f);
        v.values.ior = p.channelIor.y;
        v.values.glass = p.channelGlass.y;
    } else {
        s.throughput = vec3(0.0f, 0.0f, sum);
        v.values.ior = p.channelIor.z;
        v.values.glass = p.channelGlass.z;
    }
}

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
