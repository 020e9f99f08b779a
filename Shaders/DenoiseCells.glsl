// How much of the filter is kept, by the sums of cells and levels of noise: of the cell that a work group is in and of
// those around. After Denoise.glsl.
const int kGroupColumnsOfCell = kDenoiseCell / kDenoiseColumns;
const int kGroupRowsOfCell = kDenoiseCell / kDenoiseRows;
const int kPartsOfLevel = kDenoiseGroupSize / kDenoiseNoiseLevels; // invocations that sum what is of a level

// Gain and change:
shared vec2 pixelMixes[kDenoiseGroupSize];     // of each invocation's pixel,
shared float pixelLevels[kDenoiseGroupSize];   // and its level of noise
shared vec2 levelSums[kDenoiseGroupSize];      // of parts of the work group, then of all, level by level
shared vec2 cellSums[9 * kDenoiseNoiseLevels]; // of the cell and those around, row by row

float noiseLevelAt(ivec2 pixel) {
    return denoiseNoiseLevel(launch.kept.at[pixelCount() + pixelIndex(pixel)]);
}

// Of work groups, row by row.
uint numberOf(uvec2 group) {
    return group.y * gl_NumWorkGroups.x + group.x;
}

// In the sums. `which`: kMixOfFilter or kMixOfResidual.
uint firstMixSumOf(uvec2 group, uint which) {
    return gl_NumWorkGroups.x * gl_NumWorkGroups.y * kDenoiseSums +
           (numberOf(group) * kDenoiseMixes + which) * uint(kDenoiseNoiseLevels) * 2u;
}

// The work group's part of its cell's sums. All invocations call it, with 0 for what is outside of the image.
void writeMix(vec2 mix, ivec2 pixel, uint which) {
    int lane = int(gl_LocalInvocationIndex);
    pixelMixes[lane] = mix;
    pixelLevels[lane] = isInside(pixel) ? noiseLevelAt(pixel) : 0.0f;
    barrier();
    int level = lane / kPartsOfLevel, part = lane % kPartsOfLevel;
    vec2 sum = vec2(0.0f);
    for (int i = part; i < kDenoiseGroupSize; i += kPartsOfLevel)
        sum += denoisePartOfLevel(pixelLevels[i], level) * pixelMixes[i];
    levelSums[lane] = sum;
    for (int other = kPartsOfLevel / 2; other > 0; other /= 2) {
        barrier();
        if (part < other) levelSums[lane] += levelSums[lane + other];
    }
    if (part != 0) return;
    uint at = firstMixSumOf(gl_WorkGroupID.xy, which) + uint(level) * 2u;
    launch.sums.at[at] = levelSums[lane].x;
    launch.sums.at[at + 1u] = levelSums[lane].y;
}

ivec2 cellOf(uvec2 group) {
    return ivec2(group) / ivec2(kGroupColumnsOfCell, kGroupRowsOfCell);
}

// A cell that lies outside of the image is that at its edge.
vec2 sumsOfCell(ivec2 cell, int level, uint which) {
    ivec2 groups = ivec2(gl_NumWorkGroups.xy);
    ivec2 first =
        clamp(cell, ivec2(0), cellOf(gl_NumWorkGroups.xy - 1u)) * ivec2(kGroupColumnsOfCell, kGroupRowsOfCell);
    vec2 sum = vec2(0.0f);
    for (int y = first.y; y < min(first.y + kGroupRowsOfCell, groups.y); y++)
        for (int x = first.x; x < min(first.x + kGroupColumnsOfCell, groups.x); x++) {
            uint at = firstMixSumOf(uvec2(x, y), which) + uint(level) * 2u;
            sum += vec2(launch.sums.at[at], launch.sums.at[at + 1u]);
        }
    return sum;
}

// All invocations of a work group call it, before mixShare().
void loadCells(uint which) {
    for (int at = int(gl_LocalInvocationIndex); at < 9 * kDenoiseNoiseLevels; at += kDenoiseGroupSize) {
        int cell = at / kDenoiseNoiseLevels;
        cellSums[at] =
            sumsOfCell(cellOf(gl_WorkGroupID.xy) + ivec2(cell % 3, cell / 3) - 1, at % kDenoiseNoiseLevels, which);
    }
    barrier();
}

float mixShare(ivec2 pixel) {
    DenoiseCellPlace x = denoiseCellPlace(pixel.x);
    DenoiseCellPlace y = denoiseCellPlace(pixel.y);
    ivec2 first = ivec2(x.first, y.first) - cellOf(gl_WorkGroupID.xy) + 1; // from 0 to 1
    float noiseLevel = noiseLevelAt(pixel);
    int lower = min(int(noiseLevel), kDenoiseNoiseLevels - 2);
    vec2 sums = vec2(0.0f);
    for (int level = lower; level <= lower + 1; level++) {
        int at = (first.y * 3 + first.x) * kDenoiseNoiseLevels + level;
        vec2 upper = mix(cellSums[at], cellSums[at + kDenoiseNoiseLevels], x.fraction);
        at += 3 * kDenoiseNoiseLevels;
        vec2 below = mix(cellSums[at], cellSums[at + kDenoiseNoiseLevels], x.fraction);
        sums += denoisePartOfLevel(noiseLevel, level) * mix(upper, below, y.fraction);
    }
    DenoiseMix cells;
    cells.gain = sums.x;
    cells.change = sums.y;
    return denoiseMixShare(cells);
}
