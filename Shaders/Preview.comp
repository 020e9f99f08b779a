// Finishes some rows of the preview: the sky where nothing was drawn, and media in front of what was. The last group
// reaches into the next rows, which are still to be drawn.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Preview.glsl"

layout(local_size_x = 64) in;

void main() {
    SceneRef scene;
    scene.unused = 0u;
    uint index = launch.firstPixel + gl_GlobalInvocationID.x;
    uint width = constants.params.width;
    if (index >= width * constants.params.height) return;
    Ray ray = previewRay(uvec2(index % width, index / width));
    vec4 pixel = launch.pixels.at[index];
    bool isDrawn = pixel.w > 0.0f;
    if (!isDrawn && has(kFeatures, kFeatureSky)) pixel.xyz = skyRadiance(kFeatures, scene, ray.direction);
    float depth = 0.0f; // optical, of all media together
    vec3 scattered = vec3(0.0f);
    uint count = has(kFeatures, kFeatureVolumes) ? constants.globals.mediumCount : 0u;
    for (uint i = 0u; i < count; i++) {
        Medium medium = loadMedium(scene, i);
        vec2 inside = mediumInterval(medium, ray.origin, ray.direction);
        float far = isDrawn ? pixel.w : kInfinity;
        float part = medium.extinction * lengthWithin(inside, far);
        if (!(part > 0.0f)) continue;
        vec3 middle = ray.origin + ray.direction * (0.5f * (max(inside.x, 0.0f) + min(inside.y, far)));
        vec3 albedo = texturedAlbedo(kFeatures, scene, medium.albedo, medium.texture, middle);
        scattered += part * albedo * incidentLight(scene, middle, vec3(0.0f), -ray.direction);
        depth += part;
    }
    if (depth > 0.0f) pixel.xyz = pixel.xyz * transmittance(depth) + scattered / depth * collisionProbability(depth);
    launch.pixels.at[index] = pixel;
}
