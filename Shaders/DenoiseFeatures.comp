// Which features of a tile are worth a dimension of the regression: the principal components of what surfaces vary by
// there. A work group finds them for one tile, as FeatureSpace.h does, and writes their coordinates for all pixels that
// are in reach of the tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"

const uint kGroupSize = 128u;
const uint kSide = uint(kDenoiseSurfaceValues);
const uint kProducts = kSide * (kSide + 1u) / 2u; // of a symmetric matrix
const uint kSweeps = 8u;                          // with which Jacobi's method is done in floats

layout(local_size_x = kGroupSize) in;

shared float sums[kGroupSize * kProducts]; // of each invocation
shared float mean[kSide];
shared float covariance[kSide * kSide]; // in the end with the eigenvalues on its diagonal
shared float vectors[kSide * kSide];    // eigenvectors, in columns
shared uint axes[kDenoiseSurfaceFeatures];
shared uint axisCount;

void loadSurface(ivec2 pixel, out float values[kSide]) {
    uint at = pixelIndex(pixel) * kSurfaceValues;
    for (uint i = 0u; i < 3u; i++) {
        values[i] = denoiseAlbedo(launch.surfaces.at[at + i]);
        values[3u + i] = denoiseNormal(launch.surfaces.at[at + 3u + i]);
    }
    values[6] = denoiseDepth(launch.surfaces.at[at + 6u], launch.usualDepth);
}

// The corners of what is in the image of a tile with its border.
ivec4 borderedTile(ivec2 tile) {
    ivec2 first = max(tile * kDenoiseTile - kDenoiseBorder, ivec2(0));
    ivec2 end = min((tile + 1) * kDenoiseTile + kDenoiseBorder, ivec2(launch.width, launch.height));
    return ivec4(first, end);
}

// Of an invocation's pixels of a tile: every kGroupSize-th.
ivec2 pixelOf(ivec4 tile, int i) {
    int columns = tile.z - tile.x;
    return tile.xy + ivec2(i % columns, i / columns);
}
int pixelsOf(ivec4 tile) {
    return (tile.z - tile.x) * (tile.w - tile.y);
}

// Adds up what the invocations have in `sums`, `count` values each, into those of the first.
void addUp(uint count) {
    barrier();
    uint value = gl_LocalInvocationIndex;
    if (value < count) {
        float sum = 0.0f;
        for (uint from = 0u; from < kGroupSize; from++) sum += sums[from * count + value];
        sums[value] = sum; // of all invocations, only this one reads it before the next barrier
    }
    barrier();
}

void findMean(ivec4 tile) {
    uint lane = gl_LocalInvocationIndex;
    float own[kSide];
    for (uint i = 0u; i < kSide; i++) own[i] = 0.0f;
    for (int i = int(lane); i < pixelsOf(tile); i += int(kGroupSize)) {
        float values[kSide];
        loadSurface(pixelOf(tile, i), values);
        for (uint k = 0u; k < kSide; k++) own[k] += values[k];
    }
    for (uint i = 0u; i < kSide; i++) sums[lane * kSide + i] = own[i];
    addUp(kSide);
    if (lane < kSide) mean[lane] = sums[lane] / float(pixelsOf(tile));
    barrier();
}

void findCovariance(ivec4 tile) {
    uint lane = gl_LocalInvocationIndex;
    float own[kProducts];
    for (uint i = 0u; i < kProducts; i++) own[i] = 0.0f;
    for (int i = int(lane); i < pixelsOf(tile); i += int(kGroupSize)) {
        float values[kSide];
        loadSurface(pixelOf(tile, i), values);
        for (uint k = 0u; k < kSide; k++) values[k] -= mean[k];
        uint product = 0u;
        for (uint row = 0u; row < kSide; row++)
            for (uint column = 0u; column <= row; column++) own[product++] += values[row] * values[column];
    }
    for (uint i = 0u; i < kProducts; i++) sums[lane * kProducts + i] = own[i];
    addUp(kProducts);
    if (lane < kSide * kSide) {
        uint row = max(lane / kSide, lane % kSide);
        uint column = min(lane / kSide, lane % kSide);
        covariance[lane] = sums[row * (row + 1u) / 2u + column] / float(pixelsOf(tile));
        vectors[lane] = row == column ? 1.0f : 0.0f;
    }
    barrier();
}

vec2 turned(float x, float y, vec2 rotation) {
    return vec2(rotation.x * x - rotation.y * y, rotation.y * x + rotation.x * y);
}

// Makes the covariance of axes p and q zero by a rotation (cosine, sine), of which each invocation takes a row and a
// column.
void rotate(uint p, uint q, vec2 rotation) {
    uint k = gl_LocalInvocationIndex;
    if (k < kSide) {
        vec2 row = turned(covariance[k * kSide + p], covariance[k * kSide + q], rotation);
        covariance[k * kSide + p] = row.x;
        covariance[k * kSide + q] = row.y;
    }
    barrier();
    if (k < kSide) {
        vec2 column = turned(covariance[p * kSide + k], covariance[q * kSide + k], rotation);
        covariance[p * kSide + k] = column.x;
        covariance[q * kSide + k] = column.y;
        vec2 vector = turned(vectors[k * kSide + p], vectors[k * kSide + q], rotation);
        vectors[k * kSide + p] = vector.x;
        vectors[k * kSide + q] = vector.y;
    }
    barrier();
}

// Jacobi's method.
void diagonalize() {
    const float kNegligible = 1.0e-9f; // beside kDenoiseFeatureNoise
    for (uint sweep = 0u; sweep < kSweeps; sweep++) {
        for (uint p = 0u; p < kSide; p++) {
            for (uint q = p + 1u; q < kSide; q++) {
                float both = covariance[p * kSide + q];
                float theta = (covariance[q * kSide + q] - covariance[p * kSide + p]) / (2.0f * both);
                barrier(); // all have read them
                if (abs(both) <= kNegligible) continue;
                float tangent = signOf(theta) / (abs(theta) + sqrt(theta * theta + 1.0f));
                float cosine = inversesqrt(tangent * tangent + 1.0f);
                rotate(p, q, vec2(cosine, tangent * cosine));
            }
        }
    }
}

// The axes along which most varies, by falling variance.
void chooseAxes() {
    bool taken[kSide];
    for (uint i = 0u; i < kSide; i++) taken[i] = false;
    axisCount = 0u;
    for (uint n = 0u; n < kDenoiseSurfaceFeatures; n++) {
        uint best = kSide;
        float most = kDenoiseFeatureNoise;
        for (uint i = 0u; i < kSide; i++) {
            if (taken[i] || !(covariance[i * kSide + i] > most)) continue;
            best = i;
            most = covariance[i * kSide + i];
        }
        if (best == kSide) break;
        taken[best] = true;
        axes[n] = best;
        axisCount = n + 1u;
    }
}

vec4 coordinates(ivec2 pixel) {
    vec4 result = vec4(0.0f);
    if (!isInside(pixel)) return result;
    float values[kSide];
    loadSurface(pixel, values);
    for (uint axis = 0u; axis < axisCount; axis++)
        for (uint i = 0u; i < kSide; i++) result[axis] += vectors[i * kSide + axes[axis]] * (values[i] - mean[i]);
    return result;
}

void main() {
    ivec2 tile = ivec2(gl_WorkGroupID.xy);
    uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    ivec4 bordered = borderedTile(tile);
    findMean(bordered);
    findCovariance(bordered);
    diagonalize();
    if (gl_LocalInvocationIndex == 0u) {
        chooseAxes();
        launch.axes.at[number] = axisCount;
    }
    barrier();
    if (axisCount == 0u) return;
    const uint kPixels = uint(kDenoiseTileReach * kDenoiseTileReach);
    for (uint i = gl_LocalInvocationIndex; i < kPixels; i += kGroupSize) {
        ivec2 inReach = ivec2(i % kDenoiseTileReach, i / kDenoiseTileReach) - kDenoiseReach;
        launch.features.at[number * kPixels + i] = coordinates(tile * kDenoiseTile + inReach);
    }
}
