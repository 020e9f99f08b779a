// How much of the filter is kept, by the sums of cells: of the one that a work group is in and of those around.
// After Denoise.glsl.
#include "Common/Shared/Denoise/DenoiseMix.h"

const int kGroupColumnsOfCell = kDenoiseCell / kDenoiseColumns;
const int kGroupRowsOfCell = kDenoiseCell / kDenoiseRows;

// Gain and change:
shared vec2 groupMix[kDenoiseGroupSize]; // of each invocation, then of all
shared vec2 cellSums[9];                 // of the cell and those around, row by row

uint firstSumOf(ivec2 group) {
    return (uint(group.y) * gl_NumWorkGroups.x + uint(group.x)) * kDenoiseSums;
}

// The work group's part of its cell's sums. All invocations call it.
void writeMix(vec2 mix, uint firstSum) {
    int lane = int(gl_LocalInvocationIndex);
    groupMix[lane] = mix;
    for (int other = kDenoiseGroupSize / 2; other > 0; other /= 2) {
        barrier();
        if (lane < other) groupMix[lane] += groupMix[lane + other];
    }
    if (lane != 0) return;
    uint at = firstSumOf(ivec2(gl_WorkGroupID.xy)) + firstSum;
    launch.sums.at[at] = groupMix[0].x;
    launch.sums.at[at + 1u] = groupMix[0].y;
}

ivec2 cellOf(uvec2 group) {
    return ivec2(group) / ivec2(kGroupColumnsOfCell, kGroupRowsOfCell);
}

// A cell that lies outside of the image is that at its edge.
vec2 sumsOfCell(ivec2 cell, uint firstSum) {
    ivec2 groups = ivec2(gl_NumWorkGroups.xy);
    ivec2 first = clamp(cell, ivec2(0), cellOf(gl_NumWorkGroups.xy - 1u)) *
                  ivec2(kGroupColumnsOfCell, kGroupRowsOfCell);
    vec2 sum = vec2(0.0f);
    for (int y = first.y; y < min(first.y + kGroupRowsOfCell, groups.y); y++)
        for (int x = first.x; x < min(first.x + kGroupColumnsOfCell, groups.x); x++) {
            uint at = firstSumOf(ivec2(x, y)) + firstSum;
            sum += vec2(launch.sums.at[at], launch.sums.at[at + 1u]);
        }
    return sum;
}

// All invocations of a work group call it, before mixShare().
void loadCells(uint firstSum) {
    int lane = int(gl_LocalInvocationIndex);
    if (lane < 9) cellSums[lane] = sumsOfCell(cellOf(gl_WorkGroupID.xy) + ivec2(lane % 3, lane / 3) - 1, firstSum);
    barrier();
}

float mixShare(ivec2 pixel) {
    DenoiseCellPlace x = denoiseCellPlace(pixel.x);
    DenoiseCellPlace y = denoiseCellPlace(pixel.y);
    ivec2 first = ivec2(x.first, y.first) - cellOf(gl_WorkGroupID.xy) + 1; // from 0 to 1
    int at = first.y * 3 + first.x;
    vec2 sums = mix(mix(cellSums[at], cellSums[at + 1], x.fraction),
                    mix(cellSums[at + 3], cellSums[at + 4], x.fraction), y.fraction);
    DenoiseMix cells;
    cells.gain = sums.x;
    cells.change = sums.y;
    return denoiseMixShare(cells);
}
