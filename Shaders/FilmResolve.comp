// The picture of a film, or those of its halves.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Records.h"

layout(local_size_x = 64) in; // the pixels of one tile
layout(push_constant, scalar) uniform Launch { ResolveLaunch launch; };

void main() {
    uint position = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (position * launch.replicates >= launch.filmSlots) return;
    uint tilePixel = gl_LocalInvocationID.x;
    uvec2 pixel = pixelInTile(launch.samples.at[launch.filmSlots + position], tilePixel);
    if (pixel.x >= launch.width || pixel.y >= launch.height) return;
    uint index = pixel.y * launch.width + pixel.x;
    vec3 mean = vec3(0.0f);
    for (uint half_ = 0u; half_ < launch.halves; half_++) {
        vec3 sum = vec3(0.0f);
        uint samples = 0u;
        for (uint replicate = half_; replicate < launch.replicates; replicate += launch.halves) {
            uint slot = position * launch.replicates + replicate;
            uint at = slot * kTilePixels + tilePixel;
            uint done = launch.samples.at[slot];
            vec3 low = launch.sums.at[at].low;
            if (done % kBlock != 0u) low += launch.open.at[at];
            sum += launch.sums.at[at].high + low;
            samples += launch.isPlanned != 0u ? min(done, launch.plan.at[at]) : done;
        }
        vec3 meanOfHalf = sum / float(max(samples, 1u));
        if (launch.apart != 0u) launch.pixels.at[half_ * launch.width * launch.height + index] = meanOfHalf;
        mean += meanOfHalf;
    }
    if (launch.apart == 0u) launch.pixels.at[index] = mean / float(launch.halves);
}
