// Counts depths of surfaces by a digit of their bits, which have the order of positive numbers: those that have the
// digits before it in common with the one that is looked for.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "DenoiseRecords.h"

layout(local_size_x = kDepthDigits) in;
layout(push_constant, scalar) uniform Launch { DepthLaunch launch; };

shared uint counts[kDepthDigits];

void main() {
    const uint kInfinity = 0x7f800000u;
    uint lane = gl_LocalInvocationIndex;
    counts[lane] = 0u;
    barrier();
    uint step = gl_NumWorkGroups.x * kDepthDigits;
    for (uint pixel = gl_GlobalInvocationID.x; pixel < launch.pixels; pixel += step) {
        uint bits = floatBitsToUint(launch.surfaces.at[(pixel + 1u) * kSurfaceValues - 1u]);
        bool seesSomething = bits > 0u && bits < kInfinity;
        if (!seesSomething || (bits & launch.mask) != launch.known) continue;
        atomicAdd(counts[bits >> launch.shift & (kDepthDigits - 1u)], 1u);
    }
    barrier();
    if (counts[lane] > 0u) atomicAdd(launch.counts.at[lane], counts[lane]);
}
