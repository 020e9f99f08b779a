// First-hit features.
#version 460
#extension GL_GOOGLE_include_directive : require
#define RT_HEAVY_FEATURES // few pixels are traced once
#include "Trace.glsl"
#include "FirstHit.glsl"

void main() {
    writeFeatures(invocationNumber());
}
