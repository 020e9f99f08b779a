// First-hit features.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Trace.glsl"
#include "FirstHit.glsl"

void main() {
    writeFeatures(invocationNumber());
}
