// What the stages of the ray tracing pipeline have in common.
#extension GL_EXT_ray_tracing : require
#include "Bindings.glsl"

// What the hit shaders report of the nearest hit.
struct HitPayload {
    float t;        // negative: nothing was hit
    uint kind;
    uint primitive; // index into the whole scene's array
    uint instance;
    vec2 uv;
};
