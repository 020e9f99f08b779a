// Gives back a part of what the filter has taken away, in the mean of the pixels around each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"
#include "DenoiseCells.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

vec3 givenBack(vec3 filtered, vec3 residual) {
    return vec3(denoiseGivenBack(filtered.r, residual.r), denoiseGivenBack(filtered.g, residual.g),
                denoiseGivenBack(filtered.b, residual.b));
}

void main() {
    loadCells(kMixOfResidual);
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) return;
    float share = mixShare(pixel);
    uint index = pixelIndex(pixel);
    vec3 halves[2];
    for (uint half_ = 0u; half_ < 2u; half_++) {
        uint at = (half_ + 1u) * pixelCount() + index;
        halves[half_] = givenBack(launch.pictures.at[at], share * launch.filtered.at[half_ * pixelCount() + index].rgb);
        launch.pictures.at[at] = halves[half_];
    }
    launch.pictures.at[index] = 0.5f * (halves[0] + halves[1]);
}
