// What the filter has taken away, in the mean of the pixels around each, and for each cell how much of that is error.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"
#include "DenoiseCells.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

const int kColumns = kDenoiseColumns + 2 * kDenoiseCoarseReach; // of pixels that are averaged
const int kRows = kDenoiseRows + 2 * kDenoiseCoarseReach;

// Of each pixel in reach, then of each row of the pixels around one: what was taken away from both halves, and half of
// the difference of the raw ones.
shared vec3 residualsA[kRows * kColumns];
shared vec3 residualsB[kRows * kColumns];
shared vec3 halfDifferences[kRows * kColumns];
shared vec3 rowsA[kRows * kDenoiseColumns];
shared vec3 rowsB[kRows * kDenoiseColumns];
shared vec3 rowDifferences[kRows * kDenoiseColumns];

void loadResiduals(int at) {
    ivec2 pixel = pixelInReach(at, kDenoiseCoarseReach);
    residualsA[at] = residualsB[at] = halfDifferences[at] = vec3(0.0f);
    if (!isInside(pixel)) return;
    vec3 rawA = launch.radiance.at[planeIndex(pixel, 0)].rgb;
    vec3 rawB = launch.radiance.at[planeIndex(pixel, 1)].rgb;
    uint index = pixelIndex(pixel);
    residualsA[at] = rawA - launch.pictures.at[pixelCount() + index];
    residualsB[at] = rawB - launch.pictures.at[2u * pixelCount() + index];
    halfDifferences[at] = 0.5f * (rawA - rawB);
}

void sumRow(int at) {
    int first = at / kDenoiseColumns * kColumns + at % kDenoiseColumns;
    vec3 a = vec3(0.0f), b = vec3(0.0f), difference = vec3(0.0f);
    for (int i = first; i <= first + 2 * kDenoiseCoarseReach; i++) {
        a += residualsA[i];
        b += residualsB[i];
        difference += halfDifferences[i];
    }
    rowsA[at] = a;
    rowsB[at] = b;
    rowDifferences[at] = difference;
}

// Writes the means; returns a pixel's part of the sums.
vec2 finish(ivec2 pixel) {
    vec3 a = vec3(0.0f), b = vec3(0.0f), difference = vec3(0.0f);
    for (int y = 0; y <= 2 * kDenoiseCoarseReach; y++) {
        int at = int(gl_LocalInvocationIndex) + y * kDenoiseColumns;
        a += rowsA[at];
        b += rowsB[at];
        difference += rowDifferences[at];
    }
    float share = 1.0f / float(pixelsInReach(pixel, kDenoiseCoarseReach));
    a *= share;
    b *= share;
    difference *= share;
    uint index = pixelIndex(pixel);
    launch.filtered.at[index] = vec4(a, 0.0f);
    launch.filtered.at[pixelCount() + index] = vec4(b, 0.0f);
    vec3 filtered = launch.pictures.at[index];
    vec2 sum = vec2(0.0f);
    for (int channel = 0; channel < 3; channel++) {
        DenoiseMix mix = denoiseCoarseMix(a[channel], b[channel], difference[channel], filtered[channel]);
        sum += vec2(mix.gain, mix.change);
    }
    return sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    int lane = int(gl_LocalInvocationIndex);
    for (int at = lane; at < kRows * kColumns; at += kDenoiseGroupSize) loadResiduals(at);
    barrier();
    for (int at = lane; at < kRows * kDenoiseColumns; at += kDenoiseGroupSize) sumRow(at);
    barrier();
    writeMix(isInside(pixel) ? finish(pixel) : vec2(0.0f), pixel, kMixOfResidual);
}
