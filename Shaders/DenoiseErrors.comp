// By how much each candidate seems to be off, in tones, of each pixel alone; and what tells which pixels are alike.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

float candidateError(uint candidate, ivec2 pixel) {
    DenoisedValue values[2][3];
    for (int half_ = 0; half_ < 2; half_++) {
        Candidate made = candidateOf(candidate, pixel, half_);
        vec4 radiance = launch.radiance.at[planeIndex(pixel, half_)];
        for (int channel = 0; channel < 3; channel++) {
            values[half_][channel].filtered = denoiseTone(made.filtered[channel]);
            values[half_][channel].raw = denoiseTone(radiance[channel]);
            values[half_][channel].ownFactor = made.factors.x;
            values[half_][channel].partnerFactor = made.factors.y;
        }
    }
    float error = 0.0f;
    for (int channel = 0; channel < 3; channel++) error += denoiseError(values[0][channel], values[1][channel], 0.0f);
    return error;
}

// Normal and depth, scaled.
vec4 shapeAt(ivec2 pixel) {
    uint at = pixelIndex(pixel) * kSurfaceValues + 3u;
    return vec4(denoiseNormal(launch.surfaces.at[at]), denoiseNormal(launch.surfaces.at[at + 1u]),
                denoiseNormal(launch.surfaces.at[at + 2u]),
                denoiseDepth(launch.surfaces.at[at + 3u], launch.usualDepth));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) return;
    vec4 errors = vec4(0.0f);
    for (uint candidate = 0u; candidate < launch.candidates; candidate++)
        errors[candidate] = candidateError(candidate, pixel);
    launch.values.at[pixelIndex(pixel)] = errors;
    launch.guides.at[planeIndex(pixel, 0)] = shapeAt(pixel);
}
