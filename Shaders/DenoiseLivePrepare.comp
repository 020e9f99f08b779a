// Halves of a picture and features of surfaces as the levels of live quality read them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Common/Shared/Denoise/DenoiseLive.h"
#include "DenoiseRecords.h"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;
layout(push_constant, scalar) uniform Launch { LiveLaunch launch; };

void prepareSurface(uint pixel, uint pixels) {
    uint at = pixel * kSurfaceValues;
    vec3 albedo;
    vec3 normal;
    for (int i = 0; i < 3; i++) {
        albedo[i] = kLiveAlbedoScale * denoiseBounded(launch.surfaces.at[at + i], 0.0f);
        normal[i] = kLiveNormalScale * denoiseBounded(launch.surfaces.at[at + 3 + i], -2.0f);
    }
    float depth = launch.surfaces.at[at + 6];
    launch.features.at[pixel] = vec4(albedo, liveDepthFeature(isFinite(depth) ? depth : 0.0f));
    launch.features.at[pixels + pixel] = vec4(normal, 0.0f);
}

void main() {
    if (gl_GlobalInvocationID.x >= launch.width || gl_GlobalInvocationID.y >= launch.height) return;
    uint pixel = gl_GlobalInvocationID.y * launch.width + gl_GlobalInvocationID.x;
    uint pixels = launch.width * launch.height;
    vec3 tones[2];
    for (uint half_ = 0u; half_ < 2u; half_++) {
        vec3 radiance = launch.halves.at[half_ * pixels + pixel];
        for (int channel = 0; channel < 3; channel++) {
            radiance[channel] = max(denoiseRadiance(radiance[channel]), 0.0f);
            tones[half_][channel] = denoiseTone(radiance[channel]);
        }
        launch.radiance.at[(1u - half_) * pixels + pixel] = vec4(radiance, 0.0f);
        launch.tones.at[half_ * pixels + pixel] = vec4(tones[half_], 0.0f);
    }
    vec3 difference = tones[0] - tones[1];
    launch.values.at[pixel] = vec4(0.5f * dot(difference, difference), vec3(0.0f));
    prepareSurface(pixel, pixels);
}
