// What pixels share of their paths.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Trace.glsl"
#include "PathReuse.glsl"

void main() {
    sharePaths(invocationNumber());
}
