// Paths in compute shaders: through our own tree or by ray queries, for devices whose ray tracing pipeline is missing
// or slower.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Trace.glsl"
#include "PathLoop.glsl"

layout(local_size_x_id = kGroupSizeId) in;

void main() {
    tracePaths(gl_GlobalInvocationID.x);
}
