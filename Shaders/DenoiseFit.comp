// The filters of all bandwidths, first-order regression on features as in FilterTile.h, of the pixels of one work group
// and of one half: by weights from the other half, whose tones are the guide.
//     distances of pixels at some offsets  one column of pixels and one offset an invocation; sums of the columns of
//                                          patches, in shared memory
//     distances of patches, weights        one pixel an invocation, as is what follows
//     normal equations                     in registers, of all bandwidths
// Tiles with as many features as this shader is specialized for are filtered, others left alone: so all sums stand in
// registers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "Denoise.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;
// Of this pipeline. Loops end at kDenoiseFeatures all the same: drivers that unroll none that end at a specialization
// constant would keep the sums in memory.
layout(constant_id = 0) const int kFitFeatures = kDenoiseFeatures;

const int kAtOnce = 8; // offsets
const int kPatchSide = 2 * kDenoisePatchReach + 1;
const int kPatchColumns = kDenoiseColumns + 2 * kDenoisePatchReach; // that the patches of a row of the group have
const int kRowPitch = kAtOnce * kPatchColumns + 8; // rows that a subgroup reads begin in banks of their own
const int kReachSide = 2 * kDenoiseReach + 1;
const int kOffsets = kReachSide * kReachSide;
const float kSmallShare = 1.0f / 9.0f; // of a pixel in a patch
const float kLargeShare = 1.0f / float(kPatchSide * kPatchSide);
const int kDown = 2; // the feature that is the same for all of a row
const int kProducts = kDenoiseFeatures * (kDenoiseFeatures + 1) / 2;

// Sums of the columns of patches, [row][offset][column].
shared float smallSums[kDenoiseRows * kRowPitch];
shared float largeSums[kDenoiseRows * kRowPitch];

float pixelDistance(vec4 a, vec4 b) {
    vec3 difference = a.rgb - b.rgb;
    return denoiseDistance(dot(difference, difference), a.w, b.w);
}

// Of a square around a pixel, row by row.
ivec2 offsetInSquare(int i, int side) {
    return ivec2(i % side, i / side) - side / 2;
}
// Of the pixels next to it, of which there are kAtOnce.
ivec2 neighbour(int i) {
    return offsetInSquare(i < 4 ? i : i + 1, 3);
}

// Walks down a column of pixels: distances to those at an offset, and of each patch that has its middle in the column,
// or beside it, the sum of this column's.
void sumColumn(ivec2 top, ivec2 offset, int half_, int to) {
    int pitch = denoisePitch(launch.width);
    int here = planeIndex(top, 1 - half_);
    int there = here + offset.y * pitch + offset.x;
    float last[kPatchSide]; // distances
    [[unroll]] for (int row = 0; row < kDenoiseRows + kPatchSide - 1; row++) {
        [[unroll]] for (int i = 0; i < kPatchSide - 1; i++) last[i] = last[i + 1];
        last[kPatchSide - 1] = pixelDistance(launch.guides.at[here], launch.guides.at[there]);
        here += pitch;
        there += pitch;
        if (row < kPatchSide - 1) continue;
        float middle = last[2] + last[3] + last[4];
        smallSums[to] = middle;
        largeSums[to] = middle + (last[0] + last[1]) + (last[5] + last[6]);
        to += kRowPitch;
    }
}

// Sums of columns at kAtOnce offsets: from the given one in reach on, or to the neighbours where that is negative.
void sumColumns(ivec2 group, int firstOffset, int half_) {
    int i = int(gl_LocalInvocationIndex) / kPatchColumns;
    int column = int(gl_LocalInvocationIndex) % kPatchColumns;
    if (i >= kAtOnce || firstOffset + i >= kOffsets) return;
    ivec2 offset = firstOffset < 0 ? neighbour(i) : offsetInSquare(firstOffset + i, kReachSide);
    sumColumn(group + ivec2(column, 0) - kDenoisePatchReach, offset, half_, i * kPatchColumns + column);
}

// Of what stands at the i-th of these offsets from the invocation's pixel: the weight that each bandwidth gives it.
void weigh(int i, out float weights[kDenoiseBandwidths]) {
    int at = int(gl_LocalInvocationID.y) * kRowPitch + i * kPatchColumns + int(gl_LocalInvocationID.x);
    float large = 0.0f;
    [[unroll]] for (int dx = 0; dx < kPatchSide; dx++) large += largeSums[at + dx];
    float small = smallSums[at + 2] + smallSums[at + 3] + smallSums[at + 4];
    [[unroll]] for (uint candidate = 0u; candidate < kDenoiseBandwidths; candidate++) {
        float distance = denoiseBandwidth(candidate).patchReach == 1 ? small * kSmallShare : large * kLargeShare;
        weights[candidate] = denoiseWeight(distance, denoisePerSquaredBandwidth(candidate));
    }
}

bool hasWeight(float weights[kDenoiseBandwidths]) {
    float most = 0.0f;
    [[unroll]] for (uint candidate = 0u; candidate < kDenoiseBandwidths; candidate++)
        most = max(most, weights[candidate]);
    return most > 0.0f;
}

// What radiance is a linear function of: 1, the way across and down from the pixel that is fitted, the surface.
void loadFeatures(int at, ivec2 offset, out float features[kDenoiseFeatures]) {
    features[0] = 1.0f;
    features[1] = kDenoisePixel * float(offset.x);
    features[kDown] = kDenoisePixel * float(offset.y);
    vec4 surface = vec4(0.0f);
    if (kFitFeatures > 3) surface = launch.features.at[at + offset.y * kDenoiseTileReach + offset.x];
    [[unroll]] for (int i = 0; i < 4; i++) features[3 + i] = surface[i];
}

// The normal equations of a bandwidth: the lower triangle of the products, row by row, and radiance times features.
struct Equations {
    float products[kProducts];
    vec3 radiance[kDenoiseFeatures];
};

int productOf(int row, int column) {
    return row * (row + 1) / 2 + column;
}

// Adds one that is in reach, but for products with the way down, which is the same for all of a row.
void add(inout Equations sums, float weight, float features[kDenoiseFeatures], vec3 radiance) {
    [[unroll]] for (int i = 0; i < kDenoiseFeatures; i++) {
        if (i >= kFitFeatures || i == kDown) continue;
        float weighed = weight * features[i];
        [[unroll]] for (int j = 0; j <= i; j++) {
            if (j != kDown) sums.products[productOf(i, j)] += weighed * features[j];
        }
        sums.radiance[i] += weighed * radiance;
    }
}

// Products with the way down follow from the others by Abel's summation. Let a(y) be the sum over the row y, from -R to
// R, and s(y) that over all rows up to y. Then the sum of y a(y) is R s(R) less the sum of s(y) over the rows but the
// last, and that of y^2 a(y) is R^2 s(R) less the sum of (2 y + 1) s(y). This is what the end of a row takes off.
void endRow(inout Equations sums, int y) {
    [[unroll]] for (int i = 0; i < kDenoiseFeatures; i++) {
        if (i >= kFitFeatures) continue;
        float row = sums.products[productOf(i, 0)];
        if (i == kDown) continue;
        sums.products[productOf(max(i, kDown), min(i, kDown))] -= row;
        if (i == 0) sums.products[productOf(kDown, kDown)] -= float(2 * y + 1) * row;
    }
    sums.radiance[kDown] -= sums.radiance[0];
}
void endRows(inout Equations sums) {
    const float kReach = float(kDenoiseReach);
    sums.products[productOf(kDown, kDown)] += kReach * kReach * sums.products[0];
    sums.products[productOf(kDown, kDown)] *= kDenoisePixel * kDenoisePixel;
    [[unroll]] for (int i = 0; i < kDenoiseFeatures; i++) {
        if (i >= kFitFeatures || i == kDown) continue;
        int product = productOf(max(i, kDown), min(i, kDown));
        sums.products[product] = kDenoisePixel * (sums.products[product] + kReach * sums.products[productOf(i, 0)]);
    }
    sums.radiance[kDown] = kDenoisePixel * (sums.radiance[kDown] + kReach * sums.radiance[0]);
}

// The inverse of the products times the features of the pixel itself, by L D L^T. What is fitted there is this times
// the sums of radiance.
void solve(Equations sums, float features[kDenoiseFeatures], out float x[kDenoiseFeatures]) {
    float l[kProducts] = sums.products;
    float inverse[kDenoiseFeatures];
    l[0] += kDenoiseTiny;
    [[unroll]] for (int i = 1; i < kDenoiseFeatures; i++)
        if (i < kFitFeatures) l[productOf(i, i)] += kDenoiseRidge * l[0] + kDenoiseTiny;
    float diagonal[kDenoiseFeatures];
    [[unroll]] for (int i = 0; i < kDenoiseFeatures; i++) {
        if (i >= kFitFeatures) continue;
        float d = l[productOf(i, i)];
        [[unroll]] for (int k = 0; k < i; k++) d -= l[productOf(i, k)] * l[productOf(i, k)] * diagonal[k];
        diagonal[i] = max(d, 1.0e-7f); // rounding must not make it negative
        inverse[i] = 1.0f / diagonal[i];
        [[unroll]] for (int j = i + 1; j < kDenoiseFeatures; j++) {
            if (j >= kFitFeatures) continue;
            float sum = l[productOf(j, i)];
            [[unroll]] for (int k = 0; k < i; k++) sum -= l[productOf(j, k)] * l[productOf(i, k)] * diagonal[k];
            l[productOf(j, i)] = sum * inverse[i];
        }
    }
    [[unroll]] for (int i = 0; i < kDenoiseFeatures; i++) {
        if (i >= kFitFeatures) continue;
        x[i] = features[i];
        [[unroll]] for (int j = 0; j < i; j++) x[i] -= l[productOf(i, j)] * x[j];
    }
    [[unroll]] for (int i = kDenoiseFeatures - 1; i >= 0; i--) {
        if (i >= kFitFeatures) continue;
        x[i] *= inverse[i];
        [[unroll]] for (int j = i + 1; j < kDenoiseFeatures; j++)
            if (j < kFitFeatures) x[i] -= l[productOf(j, i)] * x[j];
    }
}

float fitted(float x[kDenoiseFeatures], float features[kDenoiseFeatures]) {
    float sum = 0.0f;
    [[unroll]] for (int i = 0; i < kDenoiseFeatures; i++)
        if (i < kFitFeatures) sum += x[i] * features[i];
    return sum;
}

// Where an invocation's pixel is.
struct Place {
    ivec2 group; // its first pixel
    ivec2 pixel;
    int half_;
    int plane;   // in bordered planes
    int feature; // in the features of its tile
    uint tile;
};
Place placeOf(uvec3 group, ivec2 inGroup) {
    Place place;
    place.group = ivec2(group.x, group.y + launch.firstRow) * ivec2(kDenoiseColumns, kDenoiseRows);
    place.pixel = place.group + inGroup;
    place.half_ = int(group.z);
    place.plane = planeIndex(place.pixel, place.half_);
    ivec2 tile = place.group / kDenoiseTile;
    ivec2 inReach = place.pixel - tile * kDenoiseTile + kDenoiseReach;
    uint tileColumns = (launch.width + uint(kDenoiseTile) - 1u) / uint(kDenoiseTile);
    place.tile = uint(tile.y) * tileColumns + uint(tile.x);
    place.feature = (int(place.tile) * kDenoiseTileReach + inReach.y) * kDenoiseTileReach + inReach.x;
    return place;
}

vec4 radianceAt(Place place, ivec2 offset) {
    return launch.radiance.at[place.plane + offset.y * denoisePitch(launch.width) + offset.x];
}

// The normal equations of all bandwidths.
void sumUp(Place place, out Equations sums[kDenoiseBandwidths]) {
    [[unroll]] for (uint candidate = 0u; candidate < kDenoiseBandwidths; candidate++) {
        [[unroll]] for (int i = 0; i < kProducts; i++) sums[candidate].products[i] = 0.0f;
        [[unroll]] for (int i = 0; i < kDenoiseFeatures; i++) sums[candidate].radiance[i] = vec3(0.0f);
    }
    float weights[kDenoiseBandwidths];
    float features[kDenoiseFeatures];
    for (int first = 0; first < kOffsets; first += kAtOnce) {
        barrier(); // the sums of before have been read
        sumColumns(place.group, first, place.half_);
        barrier();
        for (int i = 0; i < min(kAtOnce, kOffsets - first); i++) {
            ivec2 offset = offsetInSquare(first + i, kReachSide);
            weigh(i, weights);
            if (hasWeight(weights)) {
                vec4 radiance = radianceAt(place, offset);
                loadFeatures(place.feature, offset, features);
                [[unroll]] for (uint candidate = 0u; candidate < kDenoiseBandwidths; candidate++)
                    add(sums[candidate], weights[candidate] * radiance.w, features, radiance.rgb);
            }
            if (offset.x < kDenoiseReach || offset.y == kDenoiseReach) continue;
            [[unroll]] for (uint candidate = 0u; candidate < kDenoiseBandwidths; candidate++)
                endRow(sums[candidate], offset.y);
        }
    }
    [[unroll]] for (uint candidate = 0u; candidate < kDenoiseBandwidths; candidate++) endRows(sums[candidate]);
}

bool isPartner(ivec2 offset, ivec2 pixel) {
    return (offset.x == 0 || offset.x == denoisePartner(1, pixel.x)) &&
           (offset.y == 0 || offset.y == denoisePartner(1, pixel.y));
}

// By which the other pixels of a square of 2x2 enter what is fitted, for each bandwidth.
void addPartners(Place place, float x[kDenoiseBandwidths][kDenoiseFeatures], inout vec2 factors[kDenoiseBandwidths]) {
    barrier();
    sumColumns(place.group, -1, place.half_);
    barrier();
    float weights[kDenoiseBandwidths];
    float features[kDenoiseFeatures];
    for (int i = 0; i < kAtOnce; i++) {
        ivec2 offset = neighbour(i);
        if (!isPartner(offset, place.pixel)) continue;
        weigh(i, weights);
        loadFeatures(place.feature, offset, features);
        float inside = radianceAt(place, offset).w;
        [[unroll]] for (uint candidate = 0u; candidate < kDenoiseBandwidths; candidate++)
            factors[candidate].y += inside * weights[candidate] * fitted(x[candidate], features);
    }
}

void main() {
    Place place = placeOf(gl_WorkGroupID, ivec2(gl_LocalInvocationID.xy));
    if (launch.axes.at[place.tile] + 3u != uint(kFitFeatures)) return;
    Equations sums[kDenoiseBandwidths];
    sumUp(place, sums);
    float own[kDenoiseFeatures];
    loadFeatures(place.feature, ivec2(0), own);
    float x[kDenoiseBandwidths][kDenoiseFeatures];
    vec2 factors[kDenoiseBandwidths];
    vec3 values[kDenoiseBandwidths];
    [[unroll]] for (uint candidate = 0u; candidate < kDenoiseBandwidths; candidate++) {
        solve(sums[candidate], own, x[candidate]);
        values[candidate] = vec3(0.0f);
        [[unroll]] for (int i = 0; i < kDenoiseFeatures; i++)
            if (i < kFitFeatures) values[candidate] += x[candidate][i] * sums[candidate].radiance[i];
        factors[candidate] = vec2(fitted(x[candidate], own), 0.0f); // the pixel's own weight is 1
    }
    if (launch.dependentSide != 1u) addPartners(place, x, factors);
    if (!isInside(place.pixel)) return;
    [[unroll]] for (uint candidate = 0u; candidate < kDenoiseBandwidths; candidate++) {
        uint at = (candidate * 2u + uint(place.half_)) * pixelCount() + pixelIndex(place.pixel);
        launch.filtered.at[at] =
            vec4(max(values[candidate], vec3(0.0f)), uintBitsToFloat(packHalf2x16(factors[candidate])));
    }
}
