// Nothing is in the way of a shadow ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Bindings.glsl"

layout(location = 1) rayPayloadInEXT uint payload;

void main() {
    payload = 0u;
}
