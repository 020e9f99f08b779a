// The errors of candidates by which these are chosen: means over the pixels around each, as far as they are alike. Sums
// of rows first, which pixels above each other share, then of these.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

const int kReach = kDenoiseChoiceReach;
const int kColumns = kDenoiseColumns + 2 * kReach; // of pixels in reach
const int kRows = kDenoiseRows + 2 * kReach;

shared vec4 errors[kRows * kColumns]; // of each candidate; 0 outside of the image
shared vec4 shapes[kRows * kColumns]; // normals and depths, scaled
// Weighted, over the pixels in reach of each column, and over these but the nearest; of both, the sums of weights.
shared vec4 rowSums[kRows * kDenoiseColumns];
shared vec4 otherSums[kRows * kDenoiseColumns];
shared vec2 rowWeights[kRows * kDenoiseColumns];

void load(int at) {
    ivec2 pixel = pixelInReach(at, kReach);
    errors[at] = isInside(pixel) ? launch.values.at[pixelIndex(pixel)] : vec4(0.0f);
    shapes[at] = launch.guides.at[planeIndex(pixel, 0)];
}

float likeness(int pixel, int other) {
    vec4 difference = shapes[pixel] - shapes[other];
    return denoiseLikeness(dot(difference, difference));
}

void sumRow(int at) {
    int middle = at / kDenoiseColumns * kColumns + at % kDenoiseColumns + kReach;
    int column = int(gl_WorkGroupID.x) * kDenoiseColumns + at % kDenoiseColumns;
    vec4 sum = vec4(0.0f), others = vec4(0.0f);
    vec2 weights = vec2(0.0f);
    for (int x = -kReach; x <= kReach; x++) {
        float weight = uint(column + x) < launch.width ? likeness(middle, middle + x) : 0.0f;
        vec4 value = weight * errors[middle + x];
        sum += value;
        weights.x += weight;
        if (abs(x) <= kDenoiseOwnReach) continue;
        others += value;
        weights.y += weight;
    }
    rowSums[at] = sum;
    otherSums[at] = others;
    rowWeights[at] = weights;
}

// By which a candidate is chosen.
vec4 choiceErrors(ivec2 pixel) {
    ivec2 place = ivec2(gl_LocalInvocationID.xy) + kReach;
    int middle = place.y * kColumns + place.x;
    vec4 sum = vec4(0.0f), others = vec4(0.0f);
    vec2 weights = vec2(0.0f);
    for (int y = -kReach; y <= kReach; y++) {
        int at = int(gl_LocalInvocationIndex) + (y + kReach) * kDenoiseColumns;
        float weight = uint(pixel.y + y) < launch.height ? likeness(middle, middle + y * kColumns) : 0.0f;
        bool isOwn = abs(y) <= kDenoiseOwnReach;
        sum += weight * rowSums[at];
        others += weight * (isOwn ? otherSums[at] : rowSums[at]);
        weights += weight * (isOwn ? rowWeights[at] : rowWeights[at].xx);
    }
    vec4 mean = sum / weights.x;
    others = weights.y > 0.0f ? others / weights.y : mean;
    mean = vec4(denoiseChoiceError(mean.x, others.x), denoiseChoiceError(mean.y, others.y),
                denoiseChoiceError(mean.z, others.z), denoiseChoiceError(mean.w, others.w));
    mean[kRawCandidate] *= kDenoiseRawCaution;
    return mean;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    int lane = int(gl_LocalInvocationIndex);
    for (int at = lane; at < kRows * kColumns; at += kDenoiseGroupSize) load(at);
    barrier();
    for (int at = lane; at < kRows * kDenoiseColumns; at += kDenoiseGroupSize) sumRow(at);
    barrier();
    if (isInside(pixel)) launch.means.at[pixelIndex(pixel)] = choiceErrors(pixel);
}
