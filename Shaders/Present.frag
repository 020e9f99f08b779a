// The picture in its window: exposure, tone curve, sRGB. Pixels that are enlarged are squares or run into each other;
// where they are reduced, averages are shown.
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
    uint flags;   // 1: the picture, 2: the held image is display intensities already; 4: enlarged pixels are smooth;
                  // 8: the picture less the held image is shown, about grey
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

// What is shown of a pixel, linear; the image goes on beyond its edges as it ends there.
vec3 shown(ivec2 at, bool isHeld) {
    const vec3 value = texel(clamp(at, ivec2(0), ivec2(width, height) - 1), isHeld);
    return (flags & (isHeld ? 2u : 1u)) != 0u ? clamp(value, 0.0, 1.0) : tonemap(value, exposure, curve);
}

// Between the middles of four pixels. Averages, here and below, are taken of what is shown, so that a small bright
// light does not bleed into its surroundings.
vec3 smoothed(vec2 at, bool isHeld) {
    const ivec2 low = ivec2(floor(at - 0.5));
    const vec2 part = at - 0.5 - vec2(low);
    return mix(mix(shown(low, isHeld), shown(low + ivec2(1, 0), isHeld), part.x),
               mix(shown(low + ivec2(0, 1), isHeld), shown(low + ivec2(1, 1), isHeld), part.x), part.y);
}

vec3 averaged(vec2 at, bool isHeld) {
    const int steps = clamp(int(ceil(1.0 / scale - 0.01)), 1, 8);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < steps; y++) {
        for (int x = 0; x < steps; x++) {
            const vec2 offset = (vec2(x, y) + 0.5) / float(steps) - 0.5;
            sum += shown(ivec2(floor(at + offset / scale)), isHeld);
        }
    }
    return sum / float(steps * steps);
}

void main() {
    const vec2 at = (gl_FragCoord.xy - vec2(originX, originY)) / scale;
    const bool isHeld = gl_FragCoord.x < split;
    if (width == 0u || any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(width, height)))) {
        color = vec4(surroundR, surroundG, surroundB, 1.0);
        return;
    }
    if (abs(gl_FragCoord.x - split) < 1.0) {
        color = vec4(1.0);
        return;
    }
    const bool isSmooth = (flags & 4u) != 0u && scale > 1.01;
    const vec3 seen = srgbEncode(isSmooth ? smoothed(at, isHeld) : averaged(at, isHeld));
    color = vec4(seen, 1.0);
    if ((flags & 8u) != 0u) {
        const vec3 other = srgbEncode(isSmooth ? smoothed(at, true) : averaged(at, true));
        color = vec4(clamp(0.5 + 2.0 * (seen - other), 0.0, 1.0), 1.0); // four times as large as it is seen
    }
}
