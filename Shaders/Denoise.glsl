// What the denoiser's passes have in common.
#include "DenoiseRecords.h"

layout(push_constant, scalar) uniform Launch { DenoiseLaunch launch; };
#include "DenoisePixels.glsl"

const uint kRawCandidate = kDenoiseBandwidths; // leaves a pixel as it is

// Of the work group's pixels and those in reach of them, counted row by row.
ivec2 pixelInReach(int at, int reach) {
    int columns = kDenoiseColumns + 2 * reach;
    ivec2 first = ivec2(gl_WorkGroupID.xy) * ivec2(kDenoiseColumns, kDenoiseRows) - reach;
    return first + ivec2(at % columns, at / columns);
}

// How many of the image are in the square around one.
int pixelsInReach(ivec2 pixel, int reach) {
    ivec2 size = min(pixel + reach, ivec2(launch.width, launch.height) - 1) - max(pixel - reach, ivec2(0)) + 1;
    return size.x * size.y;
}

// In a bordered plane of a half; up to kDenoiseBorder pixels outside of the image.
int planeIndex(ivec2 pixel, int half_) {
    return (half_ * denoisePlaneRows(launch.height) + pixel.y + kDenoiseBorder) * denoisePitch(launch.width) + pixel.x +
           kDenoiseBorder;
}

// Tones of a half, and their variance, until there is something filtered.
vec4 tonesAt(ivec2 pixel, int half_) {
    return launch.filtered.at[planeIndex(pixel, half_)];
}

// What a candidate makes of a pixel of a half.
struct Candidate {
    vec3 filtered;
    vec2 factors; // DenoisedValue's
};
Candidate candidateOf(uint candidate, ivec2 pixel, int half_) {
    Candidate result;
    if (candidate == kRawCandidate) {
        result.filtered = launch.radiance.at[planeIndex(pixel, half_)].rgb;
        result.factors = vec2(1.0f, 0.0f);
        return result;
    }
    vec4 stored = launch.filtered.at[(candidate * 2u + uint(half_)) * pixelCount() + pixelIndex(pixel)];
    result.filtered = stored.rgb;
    result.factors = unpackHalf2x16(floatBitsToUint(stored.w));
    return result;
}
