// What the candidates make of a pixel together, and by how much that seems to be off.
#include "Denoise.glsl"

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

// Of a pixel, by the weight of each candidate.
struct BlendedPixel {
    Candidate a; // both halves
    Candidate b;
    vec3 rawA;
    vec3 rawB;
    vec3 mean;   // of the filtered halves
    vec3 noise;  // of the mean: half of theirs, squared
    vec3 errors; // of the mean, squared, as estimated
};
BlendedPixel blendedAt(vec4 shares, ivec2 pixel) {
    BlendedPixel result;
    result.a = blended(shares, pixel, 0);
    result.b = blended(shares, pixel, 1);
    result.rawA = rawAt(pixel, 0);
    result.rawB = rawAt(pixel, 1);
    vec3 difference = result.a.filtered - result.b.filtered;
    result.mean = 0.5f * (result.a.filtered + result.b.filtered);
    result.noise = 0.25f * difference * difference;
    vec3 partners = partnerNoise(pixel);
    for (int channel = 0; channel < 3; channel++)
        result.errors[channel] = denoiseError(valueOf(result.a, result.rawA, channel),
                                              valueOf(result.b, result.rawB, channel), partners[channel]);
    result.errors -= result.noise;
    return result;
}
