// Reports the hit of a quad, which the acceleration structure holds as two triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "HitGeometry.glsl"

layout(location = 0) rayPayloadInEXT HitPayload payload;
hitAttributeEXT vec2 barycentrics; // weights of the vertices 1 and 2

void main() {
    payload.t = gl_HitTEXT;
    payload.kind = kQuad;
    payload.primitive = hitGeometry().firstQuad + uint(gl_PrimitiveID) / 2u;
    payload.instance = hitInstance();
    payload.uv = quadUv(uint(gl_PrimitiveID), barycentrics);
}
