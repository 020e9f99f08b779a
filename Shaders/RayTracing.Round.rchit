// Reports the hit of a disk or cylinder.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "HitGeometry.glsl"

layout(location = 0) rayPayloadInEXT HitPayload payload;

void main() {
    payload.t = gl_HitTEXT;
    payload.kind = kRound;
    payload.primitive = hitGeometry().firstRound + uint(gl_PrimitiveID);
    payload.instance = hitInstance();
}
