// The weight of each candidate in each pixel, and for each cell how much of the filter is to be kept.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "DenoiseBlended.glsl"
#include "DenoiseCells.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

const int kColumns = kDenoiseColumns + 2 * kDenoiseBlendReach; // of pixels whose choices count
const int kRows = kDenoiseRows + 2 * kDenoiseBlendReach;
const uint kNoChoice = 4u; // of what is outside of the image

shared uint choices[kRows * kColumns];

// The candidate of the least error.
uint choiceAt(ivec2 pixel) {
    vec4 errors = launch.means.at[pixelIndex(pixel)];
    uint best = 0u;
    for (uint candidate = 1u; candidate < launch.candidates; candidate++)
        if (errors[candidate] < errors[best]) best = candidate;
    return best;
}

void loadChoice(int at) {
    ivec2 pixel = pixelInReach(at, kDenoiseBlendReach);
    choices[at] = isInside(pixel) ? choiceAt(pixel) : kNoChoice;
}

// Of each candidate: the share of the pixels around that chose it.
vec4 shareOfChoices(int reach) {
    ivec2 place = ivec2(gl_LocalInvocationID.xy) + kDenoiseBlendReach;
    int middle = place.y * kColumns + place.x;
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
    for (int at = int(gl_LocalInvocationIndex); at < kRows * kColumns; at += kDenoiseGroupSize) loadChoice(at);
    barrier();
    vec2 sum = vec2(0.0f);
    if (isInside(pixel)) {
        vec4 shares = blend();
        launch.values.at[pixelIndex(pixel)] = shares;
        if (launch.mixed != 0u) {
            DenoiseMix mix = mixAt(shares, pixel);
            sum = vec2(mix.gain, mix.change);
        }
    }
    writeMix(sum, pixel, kMixOfFilter);
}
