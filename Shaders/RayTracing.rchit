// Reports the hit of a triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "HitGeometry.glsl"

layout(location = 0) rayPayloadInEXT HitPayload payload;
hitAttributeEXT vec2 barycentrics; // weights of the vertices 1 and 2

void main() {
    payload.t = gl_HitTEXT;
    payload.kind = kTriangle;
    payload.primitive = hitGeometry().firstTriangle + uint(gl_PrimitiveID);
    payload.instance = hitInstance();
    payload.uv = barycentrics;
}
