// Adds what a launch's paths bring to the film, that of a pixel in the order of its samples.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#include "Records.h"
#include "PixelEnd.glsl"

layout(local_size_x = 64) in; // the pixels of one slot
layout(push_constant, scalar) uniform Launch { ReduceLaunch launch; };

// s + x. Knuth's exact sum, renormalised; then the low word is rounded to 53 bits below the leading bit of the high
// one, so that a double holds both.
void add(inout FilmSum s, vec3 x) {
    precise vec3 sum = s.high + x;
    precise vec3 virtual_ = sum - s.high;
    precise vec3 error = (s.high - (sum - virtual_)) + (x - virtual_);
    precise vec3 rest = s.low + error;
    precise vec3 newHigh = sum + rest;
    precise vec3 newLow = rest - (newHigh - sum);
    vec3 scale = uintBitsToFloat(floatBitsToUint(newHigh) & 0x7f800000u); // power of two below |high|
    precise vec3 grid = scale * 2.7939677e-9f;                            // 1.5 * 2^-29
    precise vec3 shifted = newLow + grid;
    precise vec3 rounded = shifted - grid;
    s.high = newHigh;
    s.low = rounded;
}

void main() {
    uint position = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (position >= launch.film.slotCount) return;
    uint slot = launchSlot(launch.film, position);
    if (slot >= launch.film.filmSlots) return;
    uint pixel = slot * kTilePixels + gl_LocalInvocationID.x;
    uint done = launch.film.samples.at[slot];
    uint end = samplesAfter(launch.film, slot % launch.film.replicates, done);
    if (end == done) return;
    bool blockSquares = (launch.film.flags & kKeepsBlockSquares) != 0u;
    bool sampleSquares = (launch.film.flags & kKeepsSampleSquares) != 0u;
    uint last = pixelEnd(launch.film, pixel, end);
    uint number = sampleAt(launch.film, position, 0u, gl_LocalInvocationID.x); // of the pixel's first sample
    uint distance = kTilePixels;                                               // to that of the next
    if ((launch.film.flags & kIsPlanned) != 0u) {
        uint start = launch.film.starts.at[pixel];
        number = plannedAt(launch.film, start, done);
        distance = plannedAt(launch.film, start, done + 1u) - number;
    }
    FilmSum sum = launch.sums.at[pixel];
    FilmSum square;
    if (blockSquares || sampleSquares) square = launch.squares.at[pixel];
    vec3 block = vec3(0.0f);
    if (done % kBlock != 0u) block = launch.open.at[pixel];
    // All of a block are fetched before the first is added: a launch of few slots has many steps, whose latencies would
    // follow each other.
    uint closed = (max(last, done) + kBlock - 1u) / kBlock * kBlock; // blocks from here on are empty
    for (uint first = done; first < min(closed, end);) {
        uint stop = min((first / kBlock + 1u) * kBlock, end);
        vec3 radiances[kBlock];
        [[unroll]] for (uint i = 0u; i < kBlock; i++) {
            radiances[i] = vec3(0.0f);
            if (first + i < min(stop, last))
                radiances[i] = launch.film.radiance.at[number + (first + i - done) * distance];
        }
        [[unroll]] for (uint i = 0u; i < kBlock; i++) {
            if (first + i < stop) {
                block += radiances[i];
                if (sampleSquares) add(square, radiances[i] * radiances[i]);
            }
        }
        if (stop % kBlock == 0u) {
            add(sum, block);
            if (blockSquares) add(square, block * block / float(kBlock));
            block = vec3(0.0f);
        }
        first = stop;
    }
    if (end % kBlock != 0u) launch.open.at[pixel] = block;
    launch.sums.at[pixel] = sum;
    if (blockSquares || sampleSquares) launch.squares.at[pixel] = square;
    memoryBarrierBuffer();
    barrier(); // every invocation has read the count
    if (gl_LocalInvocationID.x == 0u) launch.film.samples.at[slot] = end;
}
