// Finishes a band of the preview: the sky where nothing was drawn, and media in front of what was, for each sample of a
// pixel; then their mean. The last group reaches beyond the band.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "Preview.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = kPreviewDrawnBinding) uniform texture2DMS drawn; // radiance, distance: 0 for nothing

// What is seen of the media and of what lies behind them.
vec3 throughMedia(SceneRef scene, Ray ray, vec3 behind, float far) {
    float depth = 0.0f; // optical, of all media together
    vec3 scattered = vec3(0.0f);
    for (uint i = 0u; i < constants.globals.mediumCount; i++) {
        Medium medium = loadMedium(scene, i);
        vec2 inside = mediumInterval(medium, ray.origin, ray.direction);
        float part = medium.extinction * lengthWithin(inside, far);
        if (!(part > 0.0f)) continue;
        vec3 middle = ray.origin + ray.direction * (0.5f * (max(inside.x, 0.0f) + min(inside.y, far)));
        vec3 albedo = texturedAlbedo(kFeatures, scene, medium.albedo, medium.texture, middle);
        scattered += part * albedo * incidentLight(scene, middle, vec3(0.0f), -ray.direction);
        depth += part;
    }
    if (!(depth > 0.0f)) return behind;
    return behind * transmittance(depth) + scattered / depth * collisionProbability(depth);
}

// A sample as it is seen. Sky and media are taken along the ray through the pixel's middle, which for them is near
// enough to the sample's own.
vec3 finished(SceneRef scene, Ray ray, vec4 seen) {
    bool isDrawn = seen.w > 0.0f;
    vec3 radiance = seen.xyz;
    if (!isDrawn && has(kFeatures, kFeatureSky)) radiance = skyRadiance(kFeatures, scene, ray.direction);
    if (!has(kFeatures, kFeatureVolumes)) return radiance;
    return throughMedia(scene, ray, radiance, isDrawn ? seen.w : kInfinity);
}

void main() {
    SceneRef scene;
    scene.unused = 0u;
    uint index = gl_GlobalInvocationID.x;
    uint width = constants.params.width;
    if (index >= width * launch.rowCount) return;
    ivec2 place = ivec2(index % width, index / width);
    Ray ray = previewRay(vec2(place) + vec2(0.5f, float(launch.firstRow) + 0.5f));
    vec4 seen = vec4(0.0f);
    vec3 radiance = vec3(0.0f), sum = vec3(0.0f);
    float nearest = 0.0f;
    for (int i = 0; i < kPreviewSamples; i++) {
        vec4 next = texelFetch(drawn, place, i);
        if (i == 0 || next != seen) radiance = finished(scene, ray, next); // most pixels show one thing
        seen = next;
        sum += radiance;
        if (seen.w > 0.0f && (nearest == 0.0f || seen.w < nearest)) nearest = seen.w;
    }
    launch.pixels.at[index + launch.firstRow * width] = vec4(sum / float(kPreviewSamples), nearest);
}
