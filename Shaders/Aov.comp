// First-hit features in compute shaders.
#version 460
#extension GL_GOOGLE_include_directive : require
#define RT_HEAVY_FEATURES // few pixels are traced once
#include "Trace.glsl"
#include "FirstHit.glsl"

layout(local_size_x_id = kGroupSizeId) in;

void main() {
    writeFeatures(gl_GlobalInvocationID.x);
}
