// What both passes of a live picture's history have in common.
#include "DenoiseRecords.h"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;
layout(push_constant, scalar) uniform Launch { HistoryLaunch launch; };
#include "DenoisePixels.glsl"


// Samples of a half that the picture has in a pixel. Of a picture that is one the pixels are those of both halves in
// turn, as squares of a chessboard: each half is a picture then, and both stay independent.
bool hasOwnSamples(ivec2 pixel, uint half_) {
    return launch.isOne == 0u || (uint(pixel.x + pixel.y) + launch.firstHalfOfOne) % 2u == half_;
}
vec3 ownRadiance(ivec2 pixel, uint half_) {
    vec3 radiance = launch.halves.at[(launch.isOne == 0u ? half_ * pixelCount() : 0u) + pixelIndex(pixel)];
    for (int channel = 0; channel < 3; channel++) radiance[channel] = max(denoiseRadiance(radiance[channel]), 0.0f);
    return radiance;
}

// Of the camera in sight of the pixel: the point from the middle of its lens.
HistorySurface seenSurface(ivec2 pixel) {
    uint at = pixelIndex(pixel) * kSurfaceValues;
    HistorySurface surface;
    for (int i = 0; i < 3; i++) {
        surface.albedo[i] = denoiseBounded(launch.surfaces.at[at + i], 0.0f);
        surface.normal[i] = denoiseBounded(launch.surfaces.at[at + 3 + i], -2.0f);
    }
    float depth = launch.surfaces.at[at + 6];
    float size = length(surface.normal);
    surface.isHit = isFinite(depth) && depth > 0.0f && size > 0.0f;
    surface.normal = surface.isHit ? surface.normal / size : vec3(0.0f, 0.0f, 1.0f);
    vec2 place = (vec2(pixel) + 0.5f) / vec2(launch.width, launch.height);
    surface.point = historyDirection(launch.views.at.now, place) * (surface.isHit ? depth : 1.0f);
    return surface;
}
