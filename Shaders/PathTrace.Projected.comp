// Paths through our own tree, with the samplers by projected solid angle.
#version 460
#extension GL_GOOGLE_include_directive : require
#define RT_PROJECTED
#include "Traverse.glsl"
#include "PathLoop.glsl"

layout(local_size_x_id = 8) in;

void main() {
    tracePaths(gl_GlobalInvocationID.x);
}
