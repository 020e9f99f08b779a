// Halves of a picture as the denoiser reads them: radiance, tones, and the variance of a tone by the one pixel alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

vec4 tonesOf(vec4 radiance) {
    return vec4(denoiseTone(radiance.r), denoiseTone(radiance.g), denoiseTone(radiance.b), 0.0f);
}

vec4 radianceOf(ivec2 pixel, uint half_) {
    if (!isInside(pixel)) return vec4(0.0f);
    vec3 rendered = launch.halves.at[half_ * pixelCount() + pixelIndex(pixel)];
    return vec4(denoiseRadiance(rendered.r), denoiseRadiance(rendered.g), denoiseRadiance(rendered.b), 1.0f);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) - kDenoiseBorder;
    if (gl_GlobalInvocationID.x >= denoisePitch(launch.width) ||
        gl_GlobalInvocationID.y >= denoisePlaneRows(launch.height))
        return;
    vec4 tones[2];
    for (int half_ = 0; half_ < 2; half_++) {
        vec4 radiance = radianceOf(pixel, uint(half_));
        tones[half_] = tonesOf(radiance);
        launch.radiance.at[planeIndex(pixel, half_)] = radiance;
        // Where guides are made of the tones, they alone have no border yet.
        if (launch.use == kMeansOfTones) launch.filtered.at[planeIndex(pixel, half_)] = tones[half_];
        if (launch.use == kMeansToGuides || !isInside(pixel)) launch.guides.at[planeIndex(pixel, half_)] = tones[half_];
    }
    if (!isInside(pixel)) return;
    vec3 difference = tones[0].rgb - tones[1].rgb;
    launch.values.at[pixelIndex(pixel)] = vec4(0.5f * dot(difference, difference), vec3(0.0f));
}
