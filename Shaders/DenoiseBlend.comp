// Blends the candidates, gives a part of each pixel back to what it was, and estimates the error of what comes out.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "DenoiseBlended.glsl"
#include "DenoiseCells.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

// Of each invocation, then of all: relative errors, the least that these can be, their squares; the weight of each
// candidate.
shared vec4 sharedErrors[kDenoiseGroupSize];
shared vec4 sharedShares[kDenoiseGroupSize];

// The weight of each candidate.
vec4 sharesAt(ivec2 pixel) {
    vec4 shares = launch.values.at[pixelIndex(pixel)];
    if (launch.mixed == 0u) return shares;
    float share = mixShare(pixel);
    shares *= share;
    shares[kRawCandidate] += 1.0f - share;
    return shares;
}

// Writes what a pixel becomes; returns its share of the sums.
vec4 finish(ivec2 pixel, vec4 shares) {
    BlendedPixel here = blendedAt(shares, pixel);
    uint index = pixelIndex(pixel);
    launch.pictures.at[index] = here.mean;
    launch.pictures.at[pixelCount() + index] = here.a.filtered;
    launch.pictures.at[2u * pixelCount() + index] = here.b.filtered;
    launch.kept.at[index] = dot(shares, vec4(0.0f, 1.0f, 2.0f, 3.0f));
    launch.values.at[index] = vec4(here.errors, 0.0f);
    vec3 unit = 1.0f / (here.mean * here.mean + kDenoiseRelativeFloor);
    float error = dot(here.errors, unit);
    return vec4(error, dot(here.noise, unit), error * error, 0.0f);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    uint lane = gl_LocalInvocationIndex;
    sharedErrors[lane] = sharedShares[lane] = vec4(0.0f);
    if (launch.mixed != 0u) loadCells(kMixOfFilter);
    if (isInside(pixel)) {
        vec4 shares = sharesAt(pixel);
        sharedShares[lane] = shares;
        sharedErrors[lane] = finish(pixel, shares);
    }
    for (uint other = uint(kDenoiseGroupSize) / 2u; other > 0u; other /= 2u) {
        barrier();
        if (lane >= other) continue;
        sharedErrors[lane] += sharedErrors[lane + other];
        sharedShares[lane] += sharedShares[lane + other];
    }
    if (lane != 0u) return;
    uint at = numberOf(gl_WorkGroupID.xy) * kDenoiseSums;
    for (int i = 0; i < 4; i++) {
        launch.sums.at[at + i] = sharedErrors[0][i];
        launch.sums.at[at + 4 + i] = sharedShares[0][i];
    }
}
