// Paths: of the samples of a film, or with RT_RAYS or RT_TIME of pixels whose cost is asked for.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Trace.glsl"
#include "PathLoop.glsl"

void main() {
    tracePaths(invocationNumber());
}
