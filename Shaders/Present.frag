// The picture in its window: exposure, tone curve, sRGB. Pixels are squares where they are enlarged and averages where
// they are reduced.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Common/Shared/Tonemap.h"

layout(binding = 0, std430) readonly buffer Picture { float picture[]; };
layout(binding = 1, std430) readonly buffer Held { float held[]; };
// As PresentConstants of Common/Gui/FilmPass.h.
layout(push_constant) uniform Constants {
    float originX; // of the image's upper left corner, in pixels of the window
    float originY;
    float scale;   // pixels of the window for one of the image
    float exposure;
    uint width; // of both images; 0: none
    uint height;
    uint curve;
    uint plain;   // bit 0: the picture, bit 1: the held image is display intensities already
    float split;  // the held image is shown to the left of this, in pixels of the window
    float surroundR; // what lies around the image, sRGB
    float surroundG;
    float surroundB;
};
layout(location = 0) out vec4 color;

vec3 texel(ivec2 at, bool isHeld) {
    const uint i = 3u * (uint(at.y) * width + uint(at.x));
    return isHeld ? vec3(held[i], held[i + 1u], held[i + 2u]) : vec3(picture[i], picture[i + 1u], picture[i + 2u]);
}

void main() {
    const vec2 size = vec2(width, height);
    const vec2 at = (gl_FragCoord.xy - vec2(originX, originY)) / scale;
    const bool isHeld = gl_FragCoord.x < split;
    if (width == 0u || any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, size))) {
        color = vec4(surroundR, surroundG, surroundB, 1.0);
        return;
    }
    if (abs(gl_FragCoord.x - split) < 1.0) {
        color = vec4(1.0);
        return;
    }
    // Averages are taken of what is shown, so that a small bright light does not bleed into its surroundings.
    const bool isPlain = (plain >> (isHeld ? 1u : 0u) & 1u) != 0u;
    const int steps = clamp(int(ceil(1.0 / scale - 0.01)), 1, 8);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < steps; y++) {
        for (int x = 0; x < steps; x++) {
            const vec2 offset = (vec2(x, y) + 0.5) / float(steps) - 0.5;
            const ivec2 p = clamp(ivec2(floor(at + offset / scale)), ivec2(0), ivec2(size) - 1);
            const vec3 value = texel(p, isHeld);
            sum += isPlain ? clamp(value, 0.0, 1.0) : tonemap(value, exposure, curve);
        }
    }
    color = vec4(srgbEncode(sum / float(steps * steps)), 1.0);
}
