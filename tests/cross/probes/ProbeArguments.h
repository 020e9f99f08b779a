// What the probes of shared code have in common: arguments made of hashes, so that they are the same words on host and
// device, and results as words.
#ifndef RT_SHADERS_PROBE_ARGUMENTS_H
#define RT_SHADERS_PROBE_ARGUMENTS_H
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

// A source of arguments. At most one of them stands in an expression: C++ leaves open which is evaluated first.
struct Arguments {
    uint key;
    uint next;
};

RT_FN vec2 uniformPair(RT_INOUT(Arguments) a) {
    uvec3 h = hash3(uvec3(a.key, a.next, 0x517cc1b7u));
    a.next++;
    return vec2(toUniform(h.x), toUniform(h.y));
}
RT_FN float uniformNumber(RT_INOUT(Arguments) a) {
    return uniformPair(a).x;
}

RT_FN uvec4 floatWords(float x, float y, float z, float w) {
    return uvec4(floatBitsToUint(x), floatBitsToUint(y), floatBitsToUint(z), floatBitsToUint(w));
}
RT_FN uvec4 floatWords(vec3 v, float w) {
    return floatWords(v.x, v.y, v.z, w);
}

// Lights are sampled by MIS, and those of every shape by `shape`.
RT_FN RenderParams probeParams(uint shape) {
    RenderParams p;
    p.width = 640u;
    p.height = 360u;
    p.maxDepth = 50u;
    p.seed = 7u;
    p.lightSampling = kSampleMis;
    p.lightSelection = kSelectContribution;
    p.sphereLight = shape;
    p.quadLight = shape;
    p.triangleLight = shape;
    p.samplerKind = kSamplerIndependent;
    p.strataX = 5u;
    p.strataY = 7u;
    p.russianRoulette = 1u;
    return p;
}

RT_SHARED_END

#endif
