// Means over the pixels of the image in a square around each: sums of rows, which pixels above each other share, then
// of these.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

const int kMaxReach = max(kDenoiseVarianceReach, kDenoiseErrorReach);
const int kColumns = kDenoiseColumns + 2 * kMaxReach; // of pixels in reach
const int kRows = kDenoiseRows + 2 * kMaxReach;

shared vec4 values[kRows * kColumns];         // 0 outside of the image
shared vec4 rowSums[kRows * kDenoiseColumns]; // over the pixels in reach of each column

void load(int at) {
    ivec2 pixel = pixelInReach(at, kMaxReach);
    values[at] = isInside(pixel) ? launch.values.at[pixelIndex(pixel)] : vec4(0.0f);
}

void sumRow(int at, int reach) {
    int middle = at / kDenoiseColumns * kColumns + at % kDenoiseColumns + kMaxReach;
    vec4 sum = vec4(0.0f);
    for (int x = -reach; x <= reach; x++) sum += values[middle + x];
    rowSums[at] = sum;
}

void write(ivec2 pixel, int reach) {
    vec4 sum = vec4(0.0f);
    for (int y = -reach; y <= reach; y++)
        sum += rowSums[int(gl_LocalInvocationIndex) + (y + kMaxReach) * kDenoiseColumns];
    vec4 mean = sum / float(pixelsInReach(pixel, reach));
    if (launch.use == kMeansOfTones || launch.use == kMeansToGuides)
        launch.kept.at[pixelCount() + pixelIndex(pixel)] = mean.x;
    if (launch.use == kMeansOfTones) {
        for (int half_ = 0; half_ < 2; half_++) launch.filtered.at[planeIndex(pixel, half_)].w = mean.x;
    } else if (launch.use == kMeansToGuides) {
        for (int half_ = 0; half_ < 2; half_++) launch.guides.at[planeIndex(pixel, half_)].w = mean.x;
    } else if (launch.use == kMeansToTones) {
        for (uint half_ = 0u; half_ < 2u; half_++)
            launch.guides.at[half_ * pixelCount() + pixelIndex(pixel)].w = mean.x;
    } else if (launch.use == kMeansPositive) {
        launch.means.at[pixelIndex(pixel)] = max(mean, vec4(0.0f));
    } else {
        launch.means.at[pixelIndex(pixel)] = mean;
    }
}

void main() {
    int reach = launch.use == kMeansPositive ? kDenoiseErrorReach : kDenoiseVarianceReach;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    int lane = int(gl_LocalInvocationIndex);
    for (int at = lane; at < kRows * kColumns; at += kDenoiseGroupSize) load(at);
    barrier();
    for (int at = lane; at < kRows * kDenoiseColumns; at += kDenoiseGroupSize) sumRow(at, reach);
    barrier();
    if (isInside(pixel)) write(pixel, reach);
}
