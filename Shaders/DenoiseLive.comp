// A level of live quality, as LiveRow.h has it: each half becomes a weighted mean of 3x3 pixels some way apart.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Common/Shared/Denoise/DenoiseLive.h"
#include "DenoiseRecords.h"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;
layout(push_constant, scalar) uniform Launch { LiveLaunch launch; };

struct LiveSums {
    vec3 radiance;
    vec3 tones;
    float weights;
    float variance;
};

float squaredLength(vec4 v) {
    return dot(v, v);
}

void add(inout LiveSums sums, vec4 here, uint there, float kernel, float squaredFeatures) {
    vec4 tones = launch.tones.at[there];
    vec3 difference = here.rgb - tones.rgb;
    float distance = denoiseDistance(dot(difference, difference), here.w, tones.w);
    float weight = kernel * liveWeight(distance, squaredFeatures);
    sums.radiance += weight * launch.radiance.at[there].rgb;
    sums.tones += weight * tones.rgb;
    sums.weights += weight;
    sums.variance += weight * weight * tones.w;
}

// A pixel is like itself, so that its weights are never all 0. Returns the radiance.
vec3 store(LiveSums sums, uint at) {
    float share = 1.0f / sums.weights;
    vec3 radiance = share * sums.radiance;
    launch.newRadiance.at[at] = vec4(radiance, 0.0f);
    launch.newTones.at[at] = vec4(share * sums.tones, share * share * sums.variance);
    return radiance;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(launch.width, launch.height);
    if (any(greaterThanEqual(pixel, size))) return;
    uint pixels = launch.width * launch.height;
    uint here = uint(pixel.y * size.x + pixel.x);
    vec4 surface = launch.features.at[here];
    vec4 normal = launch.features.at[pixels + here];
    vec4 tonesA = launch.tones.at[here];
    vec4 tonesB = launch.tones.at[pixels + here];
    LiveSums sumsA = LiveSums(vec3(0.0f), vec3(0.0f), 0.0f, 0.0f);
    LiveSums sumsB = sumsA;
    for (int down = -kLiveReach; down <= kLiveReach; down++) {
        for (int across = -kLiveReach; across <= kLiveReach; across++) {
            ivec2 other = pixel + liveStep(launch.level) * ivec2(across, down);
            if (any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, size))) continue;
            uint there = uint(other.y * size.x + other.x);
            float squaredFeatures = squaredLength(surface - launch.features.at[there]) +
                                    squaredLength(normal - launch.features.at[pixels + there]);
            float kernel = liveKernel(down) * liveKernel(across);
            add(sumsA, tonesA, there, kernel, squaredFeatures);
            add(sumsB, tonesB, pixels + there, kernel, squaredFeatures);
        }
    }
    vec3 radiance = store(sumsA, here) + store(sumsB, pixels + here);
    if (launch.level == kLiveLevels - 1) launch.halves.at[here] = 0.5f * radiance;
}
