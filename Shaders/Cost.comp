// What pixels cost, in compute shaders.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Trace.glsl"
#include "Cost.glsl"

layout(local_size_x_id = kGroupSizeId) in;

void main() {
    writeCost(gl_GlobalInvocationID.x);
}
