// What pixels share of their paths, in compute shaders.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Trace.glsl"
#include "PathReuse.glsl"

layout(local_size_x_id = kGroupSizeId) in;

void main() {
    sharePaths(gl_GlobalInvocationID.x);
}
