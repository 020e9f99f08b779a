// What pixels are compared by: tones of a half, less noisy by those around (DenoiseGuide.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

const int kColumns = kDenoiseColumns + 2 * kDenoiseGuideBorder; // of what the group's pixels are compared with
const int kRows = kDenoiseRows + 2 * kDenoiseGuideBorder;
const float kShare = 1.0f / 9.0f; // of a pixel in a patch
shared vec4 tones[kRows * kColumns];

// Distances of the pixels in the group's patches to those at a row of offsets.
const int kOffsets = 2 * kDenoiseGuideReach + 1;
const int kPatchColumns = kDenoiseColumns + 2 * kDenoiseGuidePatchReach;
const int kPatchRows = kDenoiseRows + 2 * kDenoiseGuidePatchReach;
shared float distances[kOffsets * kPatchRows * kPatchColumns];

// All of it is inside of the planes' border, which is wider.
void loadTones(int half_) {
    for (int i = int(gl_LocalInvocationIndex); i < kRows * kColumns; i += kDenoiseGroupSize)
        tones[i] = tonesAt(pixelInReach(i, kDenoiseGuideBorder), half_);
    barrier();
}

void measure(int down) {
    barrier(); // those before have been read
    for (int place = int(gl_LocalInvocationIndex); place < kPatchRows * kPatchColumns; place += kDenoiseGroupSize) {
        int here = (place / kPatchColumns + kDenoiseGuideReach) * kColumns + place % kPatchColumns + kDenoiseGuideReach;
        int there = here + down * kColumns - kDenoiseGuideReach;
        vec4 tone = tones[here];
        for (int i = 0; i < kOffsets; i++) {
            vec4 other = tones[there + i];
            vec3 difference = tone.rgb - other.rgb;
            distances[place * kOffsets + i] = denoiseDistance(dot(difference, difference), tone.w, other.w);
        }
    }
    barrier();
}

float patchDistance(int offset) {
    float sum = 0.0f;
    int place = int(gl_LocalInvocationID.y) * kPatchColumns + int(gl_LocalInvocationID.x);
    for (int y = 0; y <= 2 * kDenoiseGuidePatchReach; y++)
        for (int x = 0; x <= 2 * kDenoiseGuidePatchReach; x++)
            sum += distances[(place + y * kPatchColumns + x) * kOffsets + offset];
    return kShare * sum;
}

void main() {
    int half_ = int(gl_WorkGroupID.z);
    loadTones(half_);
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    int here = (int(gl_LocalInvocationID.y) + kDenoiseGuideBorder) * kColumns + int(gl_LocalInvocationID.x) +
               kDenoiseGuideBorder;
    vec4 own = tones[here];
    vec3 sum = vec3(0.0f);
    float weights = 0.0f, squares = 0.0f;
    for (int down = -kDenoiseGuideReach; down <= kDenoiseGuideReach; down++) {
        measure(down);
        for (int i = 0; i < kOffsets; i++) {
            int across = i - kDenoiseGuideReach;
            if (!isInside(pixel + ivec2(across, down))) continue;
            float weight = across == 0 && down == 0 ? 1.0f : denoiseGuideWeight(patchDistance(i));
            weights += weight;
            squares += weight * weight;
            sum += weight * tones[here + down * kColumns + across].rgb;
        }
    }
    if (!isInside(pixel)) return;
    vec3 filtered = sum / weights;
    launch.guides.at[planeIndex(pixel, half_)] =
        vec4(denoiseGuideTone(own.r, filtered.r), denoiseGuideTone(own.g, filtered.g),
             denoiseGuideTone(own.b, filtered.b), own.w * denoiseGuideVariance(weights, squares));
}
