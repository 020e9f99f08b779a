// The weight of each candidate in each pixel, and for each cell how much of the filter is to be kept.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "DenoiseBlended.glsl"
#include "Common/Shared/Denoise/DenoiseMix.h"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

const uint kGroupSize = uint(kDenoiseColumns * kDenoiseRows);

shared vec2 sharedMix[kGroupSize]; // of each invocation, then of all

// The candidate of the least error.
uint choiceAt(ivec2 pixel) {
    vec4 errors = launch.means.at[pixelIndex(pixel)];
    uint best = 0u;
    for (uint candidate = 1u; candidate < launch.candidates; candidate++)
        if (errors[candidate] < errors[best]) best = candidate;
    return best;
}

vec4 oneOf(uint candidate) {
    return vec4(equal(uvec4(candidate), uvec4(0u, 1u, 2u, 3u)));
}

// Of each candidate: the share of the pixels around that chose it.
vec4 shareOfChoices(ivec2 pixel, int reach) {
    ivec2 first = max(pixel - reach, ivec2(0));
    ivec2 last = min(pixel + reach, ivec2(launch.width, launch.height) - 1);
    vec4 sum = vec4(0.0f);
    for (int y = first.y; y <= last.y; y++)
        for (int x = first.x; x <= last.x; x++) sum += oneOf(choiceAt(ivec2(x, y)));
    ivec2 size = last - first + 1;
    return sum / float(size.x * size.y);
}

vec4 blend(ivec2 pixel) {
    vec4 shares = shareOfChoices(pixel, kDenoiseBlendReach);
    if (launch.candidates <= kRawCandidate) return shares;
    float raw = shareOfChoices(pixel, kDenoiseRawBlendReach)[kRawCandidate];
    shares *= denoiseFilterScale(shares[kRawCandidate], raw);
    shares[kRawCandidate] = raw;
    return shares;
}

DenoiseMix mixAt(vec4 shares, ivec2 pixel) {
    BlendedPixel here = blendedAt(shares, pixel);
    DenoiseMix sum;
    sum.gain = sum.change = 0.0f;
    for (int channel = 0; channel < 3; channel++) {
        DenoiseMix mix = denoiseMix(valueOf(here.a, here.rawA, channel), valueOf(here.b, here.rawB, channel),
                                    here.errors[channel]);
        sum.gain += mix.gain;
        sum.change += mix.change;
    }
    return sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    uint lane = gl_LocalInvocationIndex;
    sharedMix[lane] = vec2(0.0f);
    if (isInside(pixel)) {
        vec4 shares = blend(pixel);
        launch.values.at[pixelIndex(pixel)] = shares;
        if (launch.mixed != 0u) {
            DenoiseMix mix = mixAt(shares, pixel);
            sharedMix[lane] = vec2(mix.gain, mix.change);
        }
    }
    for (uint other = kGroupSize / 2u; other > 0u; other /= 2u) {
        barrier();
        if (lane < other) sharedMix[lane] += sharedMix[lane + other];
    }
    if (lane != 0u) return;
    uint at = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kDenoiseSums + kDenoiseMixSums;
    launch.sums.at[at] = sharedMix[0].x;
    launch.sums.at[at + 1u] = sharedMix[0].y;
}
