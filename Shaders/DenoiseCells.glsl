// How much of the filter is kept where a work group is, by the sums of the cell that it is in and of those around.
// After Denoise.glsl.
#include "Common/Shared/Denoise/DenoiseMix.h"

const int kGroupColumnsOfCell = kDenoiseCell / kDenoiseColumns;
const int kGroupRowsOfCell = kDenoiseCell / kDenoiseRows;

shared vec2 cellSums[9]; // gain and change, row by row

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
            uint at = uint(y * groups.x + x) * kDenoiseSums + firstSum;
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
