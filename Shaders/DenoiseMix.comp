// The weight of each candidate in each pixel, and for each cell how much of the filter is to be kept.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "DenoiseBlended.glsl"
#include "Common/Shared/Denoise/DenoiseMix.h"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

const uint kGroupSize = uint(kDenoiseColumns * kDenoiseRows);

const int kColumns = kDenoiseColumns + 2 * kDenoiseBlendReach; // of pixels whose choices count
const int kRows = kDenoiseRows + 2 * kDenoiseBlendReach;
const uint kNoChoice = 4u; // of what is outside of the image

shared uint choices[kRows * kColumns];
shared vec2 sharedMix[kGroupSize]; // of each invocation, then of all

// The candidate of the least error.
uint choiceAt(ivec2 pixel) {
    vec4 errors = launch.means.at[pixelIndex(pixel)];
    uint best = 0u;
    for (uint candidate = 1u; candidate < launch.candidates; candidate++)
        if (errors[candidate] < errors[best]) best = candidate;
    return best;
}

void loadChoice(uint at) {
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * ivec2(kDenoiseColumns, kDenoiseRows) - kDenoiseBlendReach;
    ivec2 pixel = corner + ivec2(int(at) % kColumns, int(at) / kColumns);
    choices[at] = isInside(pixel) ? choiceAt(pixel) : kNoChoice;
}

// Of each candidate: the share of the pixels around that chose it.
vec4 shareOfChoices(int reach) {
    int middle =
        (int(gl_LocalInvocationID.y) + kDenoiseBlendReach) * kColumns + int(gl_LocalInvocationID.x) + kDenoiseBlendReach;
    vec4 sum = vec4(0.0f);
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++)
            sum += vec4(equal(uvec4(choices[middle + y * kColumns + x]), uvec4(0u, 1u, 2u, 3u)));
    return sum / (sum.x + sum.y + sum.z + sum.w);
}

vec4 blend() {
    vec4 shares = shareOfChoices(kDenoiseBlendReach);
    if (launch.candidates <= kRawCandidate) return shares;
    float raw = shareOfChoices(kDenoiseRawBlendReach)[kRawCandidate];
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
    for (uint at = lane; at < uint(kRows * kColumns); at += kGroupSize) loadChoice(at);
    sharedMix[lane] = vec2(0.0f);
    barrier();
    if (isInside(pixel)) {
        vec4 shares = blend();
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
