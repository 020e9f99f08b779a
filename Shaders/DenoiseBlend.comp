// Blends the candidates by what the pixels around chose, and estimates the error of what comes out.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

const uint kGroupSize = uint(kDenoiseColumns * kDenoiseRows);

// Of each invocation, then of all: relative errors, the least that these can be, their squares; how many chose each
// candidate.
shared vec4 sharedErrors[kGroupSize];
shared vec4 sharedChoices[kGroupSize];

// The candidate of the least error.
uint choiceAt(ivec2 pixel) {
    vec4 errors = launch.means.at[pixelIndex(pixel)];
    uint best = 0u;
    for (uint candidate = 1u; candidate < launch.candidates; candidate++)
        if (errors[candidate] < errors[best]) best = candidate;
    return best;
}

vec4 oneOf(uint candidate) {
    return vec4(equal(uvec4(candidate), uvec4(0u, 1u, 2u, 3u)));
}

// Of each candidate: the share of the pixels around that chose it.
vec4 shareOfChoices(ivec2 pixel) {
    ivec2 first = max(pixel - kDenoiseBlendReach, ivec2(0));
    ivec2 last = min(pixel + kDenoiseBlendReach, ivec2(launch.width, launch.height) - 1);
    vec4 sum = vec4(0.0f);
    for (int y = first.y; y <= last.y; y++)
        for (int x = first.x; x <= last.x; x++) sum += oneOf(choiceAt(ivec2(x, y)));
    ivec2 size = last - first + 1;
    return sum / float(size.x * size.y);
}

Candidate blended(vec4 shares, ivec2 pixel, int half_) {
    Candidate sum;
    sum.filtered = vec3(0.0f);
    sum.factors = vec2(0.0f);
    for (uint candidate = 0u; candidate < launch.candidates; candidate++) {
        Candidate made = candidateOf(candidate, pixel, half_);
        sum.filtered += shares[candidate] * made.filtered;
        sum.factors += shares[candidate] * made.factors;
    }
    return sum;
}

vec3 rawAt(ivec2 pixel, int half_) {
    return launch.radiance.at[planeIndex(pixel, half_)].rgb;
}

// The mean difference of the raw halves of the other pixels of a square of 2x2.
vec3 partnerNoise(ivec2 pixel) {
    vec3 sum = vec3(0.0f);
    if (launch.dependentSide == 1u) return sum;
    float count = 0.0f;
    for (int i = 1; i < 4; i++) {
        ivec2 other = pixel + ivec2(denoisePartner(i & 1, pixel.x), denoisePartner(i & 2, pixel.y));
        if (!isInside(other)) continue;
        sum += rawAt(other, 0) - rawAt(other, 1);
        count += 1.0f;
    }
    return sum / max(count, 1.0f);
}

DenoisedValue valueOf(Candidate candidate, vec3 raw, int channel) {
    DenoisedValue value;
    value.filtered = candidate.filtered[channel];
    value.raw = raw[channel];
    value.ownFactor = candidate.factors.x;
    value.partnerFactor = candidate.factors.y;
    return value;
}

// Writes what a pixel becomes; returns its share of the sums.
vec4 finish(ivec2 pixel) {
    vec4 shares = shareOfChoices(pixel);
    Candidate a = blended(shares, pixel, 0);
    Candidate b = blended(shares, pixel, 1);
    vec3 mean = 0.5f * (a.filtered + b.filtered);
    vec3 difference = a.filtered - b.filtered;
    vec3 noise = 0.25f * difference * difference; // of the mean of both halves: half of theirs
    vec3 partners = partnerNoise(pixel);
    vec3 rawA = rawAt(pixel, 0);
    vec3 rawB = rawAt(pixel, 1);
    vec3 errors;
    for (int channel = 0; channel < 3; channel++)
        errors[channel] = denoiseError(valueOf(a, rawA, channel), valueOf(b, rawB, channel), partners[channel]);
    errors -= noise;
    uint index = pixelIndex(pixel);
    launch.pictures.at[index] = mean;
    launch.pictures.at[pixelCount() + index] = a.filtered;
    launch.pictures.at[2u * pixelCount() + index] = b.filtered;
    launch.kept.at[index] = dot(shares, vec4(0.0f, 1.0f, 2.0f, 3.0f));
    launch.values.at[index] = vec4(errors, 0.0f);
    vec3 unit = 1.0f / (mean * mean + kDenoiseRelativeFloor);
    float error = dot(errors, unit);
    return vec4(error, dot(noise, unit), error * error, 0.0f);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    uint lane = gl_LocalInvocationIndex;
    sharedErrors[lane] = isInside(pixel) ? finish(pixel) : vec4(0.0f);
    sharedChoices[lane] = isInside(pixel) ? oneOf(choiceAt(pixel)) : vec4(0.0f);
    for (uint other = kGroupSize / 2u; other > 0u; other /= 2u) {
        barrier();
        if (lane >= other) continue;
        sharedErrors[lane] += sharedErrors[lane + other];
        sharedChoices[lane] += sharedChoices[lane + other];
    }
    if (lane != 0u) return;
    uint at = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kDenoiseSums;
    for (int i = 0; i < 4; i++) {
        launch.sums.at[at + i] = sharedErrors[0][i];
        launch.sums.at[at + 4 + i] = sharedChoices[0][i];
    }
}
