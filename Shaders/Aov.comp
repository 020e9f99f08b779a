// First-hit features through our own tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#define RT_FULL // few pixels are traced once
#include "Traverse.glsl"
#include "FirstHit.glsl"

layout(local_size_x_id = kGroupSizeId) in;

void main() {
    writeFeatures(gl_GlobalInvocationID.x);
}
