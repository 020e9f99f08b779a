// Numbers the samples that a plan gives a launch, and lists them in the order in which they are traced: of each slot a
// sample of every pixel that gets one before the next, as without a plan, so that rays that are traced at a time are
// alike, and no invocation looks for a sample that is not there.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Records.h"
#include "PixelEnd.glsl"

layout(local_size_x = 64) in; // the pixels of one slot
layout(push_constant, scalar) uniform Launch { ListLaunch launch; };

shared uint counts[kTilePixels]; // samples of each pixel, in the order of the invocations
shared uint first;               // number of the slot's first sample, and its place in the list

// Of a pixel. One of a group that shares has as many as any of them, so that their numbers alternate.
uint countOf(uint invocation, bool isShared) {
    uint count = counts[invocation];
    uint groupFirst = invocation - invocation % kReuseGroup;
    for (uint i = 0u; isShared && i < kReuseGroup; i++) count = max(count, counts[groupFirst + i]);
    return count;
}

void main() {
    uint position = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (position >= launch.film.slotCount) return;
    uint slot = launchSlot(launch.film, position);
    if (slot >= launch.film.filmSlots) return;
    uint invocation = gl_LocalInvocationID.x;
    uint tilePixel = groupedPixel(invocation);
    uint pixel = slot * kTilePixels + tilePixel;
    uint done = launch.film.samples.at[slot];
    uint slotEnd = samplesAfter(launch.film, slot % launch.film.replicates, done);
    counts[invocation] = max(pixelEnd(launch.film, pixel, slotEnd), done) - done;
    barrier();
    bool isShared = (launch.film.flags & kSharesPaths) != 0u;
    uint count = countOf(invocation, isShared);
    barrier(); // every invocation has read what its group has
    counts[invocation] = count;
    barrier();
    uint before = 0u; // samples of the invocations before this one
    uint all = 0u;
    for (uint i = 0u; i < kTilePixels; i++) {
        if (i < invocation) before += counts[i];
        all += counts[i];
    }
    if (invocation == 0u) first = atomicAdd(launch.progress.counters[kListed], all);
    barrier();
    uint inGroup = invocation % kReuseGroup;
    uint start = first + (isShared ? before - inGroup * count + inGroup : before);
    launch.film.starts.at[pixel] = start - plannedAt(launch.film, 0u, done);
    // As long as no pixel gets its last sample, each step lists as many as the one before.
    for (uint step = 0u; step < count;) {
        uint listed = 0u; // in the steps before
        uint alive = 0u;  // pixels that get a sample
        uint rank = 0u;   // of this one among them
        uint end = count;
        for (uint i = 0u; i < kTilePixels; i++) {
            listed += min(counts[i], step);
            if (counts[i] <= step) continue;
            alive++;
            if (i < invocation) rank++;
            end = min(end, counts[i]);
        }
        for (uint place = first + listed + rank; step < end; step++) {
            launch.planned.at[place].place = sampleAt(launch.film, position, step, tilePixel);
            launch.planned.at[place].number = plannedAt(launch.film, start, step);
            place += alive;
        }
    }
}
