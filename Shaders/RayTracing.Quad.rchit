// Reports the hit of a quad, which the acceleration structure holds as two triangles:
//
//   corner+V .------. corner+U+V     even: corner, +U, +U+V     (u, v) = (w1 + w2, w2)
//            | odd /|                odd:  corner, +U+V, +V     (u, v) = (w1, w1 + w2)
//            |  /   |
//     corner '------' corner+U
#version 460
#extension GL_GOOGLE_include_directive : require
#include "HitGeometry.glsl"

layout(location = 0) rayPayloadInEXT HitPayload payload;
hitAttributeEXT vec2 barycentrics; // weights of the vertices 1 and 2

void main() {
    float sum = barycentrics.x + barycentrics.y;
    payload.t = gl_HitTEXT;
    payload.kind = kQuad;
    payload.primitive = hitGeometry().firstQuad + uint(gl_PrimitiveID) / 2u;
    payload.instance = hitInstance();
    payload.uv = (gl_PrimitiveID & 1) == 0 ? vec2(sum, barycentrics.y) : vec2(barycentrics.x, sum);
}
