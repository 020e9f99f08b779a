// What the paths of a launch's samples share, as they are kept: four vectors a sample, each written at once.
//   first vertex, its normal | throughput behind it, SharedPart::aimed | second vertex, its normal
//   | radiance, PathState::reuse
#include "Common/Shared/Technique/AimedScattering.h"

// On the octahedron around the origin, 16 bits a coordinate; within 3e-5.
uint packNormal(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0f) p = (vec2(1.0f) - abs(p.yx)) * vec2(p.x < 0.0f ? -1.0f : 1.0f, p.y < 0.0f ? -1.0f : 1.0f);
    return packSnorm2x16(p);
}

vec3 unpackNormal(uint packed) {
    vec2 p = unpackSnorm2x16(packed);
    vec3 n = vec3(p, 1.0f - abs(p.x) - abs(p.y));
    float fold = max(-n.z, 0.0f);
    n.xy -= vec2(n.x < 0.0f ? -fold : fold, n.y < 0.0f ? -fold : fold);
    return normalize(n);
}

void keepFirst(SharedPathArray paths, uint number, vec3 position, vec3 normal, vec3 throughput, float aimed) {
    paths.at[4u * number] = uvec4(floatBitsToUint(position), packNormal(normal));
    paths.at[4u * number + 1u] = floatBitsToUint(vec4(throughput, aimed));
}

void keepSecond(SharedPathArray paths, uint number, vec3 position, vec3 normal) {
    paths.at[4u * number + 2u] = uvec4(floatBitsToUint(position), packNormal(normal));
}

void keepEnd(SharedPathArray paths, uint number, vec3 radiance, uint reuse) {
    paths.at[4u * number + 3u] = uvec4(floatBitsToUint(radiance), reuse);
}

struct SharedVertex {
    vec3 position;
    vec3 normal;
};

SharedVertex sharedVertex(uvec4 kept) {
    SharedVertex v;
    v.position = uintBitsToFloat(kept.xyz);
    v.normal = unpackNormal(kept.w);
    return v;
}

SharedVertex firstVertex(SharedPathArray paths, uint number) {
    return sharedVertex(paths.at[4u * number]);
}

SharedVertex secondVertex(SharedPathArray paths, uint number) {
    return sharedVertex(paths.at[4u * number + 2u]);
}
