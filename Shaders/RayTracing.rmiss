// Nothing was hit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "RayTracing.glsl"

layout(location = 0) rayPayloadInEXT HitPayload payload;

void main() {
    payload.t = -1.0f;
}
