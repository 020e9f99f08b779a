// Distances of patches at several offsets at once, for the pixels of a work group of kDenoiseColumns x kDenoiseRows, and
// the weights that follow from them. An invocation walks down a column of pixels at one offset; the rows of patches are
// summed where they are asked for.
const int kAtOnce = 9; // offsets: half a row of what is in reach, or all pixels next to one
const int kPatchSide = 2 * kDenoisePatchReach + 1;
const int kPatchColumns = kDenoiseColumns + 2 * kDenoisePatchReach; // that the patches of a row of the group have
const int kSmallColumns = kDenoiseColumns + 2;                      // the same for small patches
// From a row of the group to the next: rows that a subgroup reads begin in banks of their own.
const int kLargePitch = 136;
const int kSmallPitch = 104;
const float kSmallShare = 1.0f / 9.0f; // of a pixel in a patch
const float kLargeShare = 1.0f / float(kPatchSide * kPatchSide);

// Sums of the columns of patches, [row][offset][column]. Together less than the 16 kB that every device has.
shared float largeSums[kDenoiseRows * kLargePitch];
shared float smallSums[kDenoiseRows * kSmallPitch];

float pixelDistance(vec4 a, vec4 b) {
    vec3 difference = a.rgb - b.rgb;
    return denoiseDistance(dot(difference, difference), a.w, b.w);
}

// On the way down a column of pixels: the next ones that are compared, and, of the rows before, by how far up: the
// distance, the sums of it and the one above, and of three.
struct Walk {
    int pitch;
    int here;
    int there;
    float distance1, distance2;
    float pair1, pair2, pair3, pair4, pair5;
    float three1, three2;
};

// Goes on by a row. Returns the sums of the last seven rows and of the three in their middle.
vec2 nextRow(inout Walk walk) {
    float distance = pixelDistance(launch.guides.at[walk.here], launch.guides.at[walk.there]);
    float pair = distance + walk.distance1;
    vec2 sums = vec2(pair + walk.three2 + walk.pair5, walk.three2); // of 2, 3 and 2 rows
    walk.three2 = walk.three1;
    walk.three1 = pair + walk.distance2;
    walk.distance2 = walk.distance1;
    walk.distance1 = distance;
    walk.pair5 = walk.pair4;
    walk.pair4 = walk.pair3;
    walk.pair3 = walk.pair2;
    walk.pair2 = walk.pair1;
    walk.pair1 = pair;
    walk.here += walk.pitch;
    walk.there += walk.pitch;
    return sums;
}

// Where the sums of a column are kept.
struct Slot {
    int large;
    int small;
    bool hasSmall; // as a part of small patches
};

void keepRow(inout Walk walk, inout Slot slot) {
    vec2 sums = nextRow(walk);
    largeSums[slot.large] = sums.x;
    if (slot.hasSmall) smallSums[slot.small] = sums.y;
    slot.large += kLargePitch;
    slot.small += kSmallPitch;
}

// Distances of a column of pixels to those at an offset, and of each patch that has its middle in the column, or beside
// it, the sum of this column's. `i`: the number of the offset.
void sumColumn(ivec2 top, int column, ivec2 offset, int i, int half_) {
    Walk walk;
    walk.pitch = denoisePitch(launch.width);
    walk.here = planeIndex(top + ivec2(column, 0), 1 - half_);
    walk.there = walk.here + offset.y * walk.pitch + offset.x;
    walk.distance1 = walk.distance2 = walk.three1 = walk.three2 = 0.0f;
    walk.pair1 = walk.pair2 = walk.pair3 = walk.pair4 = walk.pair5 = 0.0f;
    Slot slot;
    int smallColumn = column - kDenoisePatchReach + 1;
    slot.large = i * kPatchColumns + column;
    slot.small = i * kSmallColumns + smallColumn;
    slot.hasSmall = smallColumn >= 0 && smallColumn < kSmallColumns;
    nextRow(walk); // that are above the first patch's last
    nextRow(walk);
    nextRow(walk);
    nextRow(walk);
    nextRow(walk);
    nextRow(walk);
    // Four at a time, written out: loads of more, which a driver would begin at once, need registers of which fewer
    // groups at a time would have enough, and of one row have to be waited for.
    [[dont_unroll]] for (int row = 0; row < kDenoiseRows; row += 4) {
        keepRow(walk, slot);
        keepRow(walk, slot);
        keepRow(walk, slot);
        keepRow(walk, slot);
    }
}

// Sums of columns at the offsets that follow each other in a row of `inRow`, from the given one on.
void sumColumns(ivec2 group, ivec2 from, int inRow, int half_) {
    int i = int(gl_LocalInvocationIndex) / kPatchColumns;
    int column = int(gl_LocalInvocationIndex) % kPatchColumns;
    ivec2 offset = from + ivec2(i % inRow, i / inRow);
    barrier(); // the sums of before have been read
    if (i < kAtOnce && offset.x <= kDenoiseReach) sumColumn(group - kDenoisePatchReach, column, offset, i, half_);
    barrier();
}

// Of what stands at the i-th of these offsets from the invocation's pixel: the weights that the bandwidths give it.
vec3 weigh(int i) {
    int column = int(gl_LocalInvocationID.x);
    int row = int(gl_LocalInvocationID.y);
    int at = row * kLargePitch + i * kPatchColumns + column;
    float large = (largeSums[at] + largeSums[at + 1]) + (largeSums[at + 2] + largeSums[at + 3]) +
                  (largeSums[at + 4] + largeSums[at + 5]) + largeSums[at + 6];
    at = row * kSmallPitch + i * kSmallColumns + column;
    float small = smallSums[at] + smallSums[at + 1] + smallSums[at + 2];
    return vec3(denoiseWeight(small, kSmallShare * denoisePerSquaredBandwidth(0u)),
                denoiseWeight(large, kLargeShare * denoisePerSquaredBandwidth(1u)),
                denoiseWeight(large, kLargeShare * denoisePerSquaredBandwidth(2u)));
}
