// What the shaders of the preview have in common: the scene, the ray of a pixel, and light without shadows.
#include "SceneAccess.glsl"
#include "Common/Shared/Path/PathStep.h"

layout(constant_id = kShapeId) const uint kShape = kSphere; // that a draw's primitives have

layout(push_constant, scalar) uniform Launch { PreviewLaunch launch; };

// Through a place on the image, in pixels, from the middle of the lens, when the shutter opens.
Ray previewRay(vec2 place) {
    uvec2 size = uvec2(constants.params.width, constants.params.height);
    vec2 pixel = floor(place);
    return generateCameraRay(kFeatures, constants.camera, uvec2(pixel), size, place - pixel, vec2(0.5f), 0.0f);
}

// What a light adds to the radiance of a white diffuse surface at `position`, were there nothing in between: the form
// factor of a disk of the light's area that is seen from its axis (Howell, "A Catalog of Radiation Heat Transfer
// Configuration Factors", B-13), times the cosines. A point in a medium, whose normal is zero, gets a quarter of what a
// surface gets that faces the light.
vec3 unshadowedLight(Light light, vec3 position, vec3 normal) {
    if (isPunctual(kFeatures, light)) {
        LightSample s = samplePunctualLight(light, position, normal);
        float cosine = isSurface(normal) ? dot(normal, s.wi) : 0.25f;
        return s.pdf > 0.0f ? s.radiance * (cosine * kInvPi) : vec3(0.0f);
    }
    vec3 middle = light.position;
    if (light.kind == kLightQuad) middle += 0.5f * (light.edgeU + light.edgeV);
    if (light.kind == kLightTriangle) middle += (light.edgeU + light.edgeV) / 3.0f;
    if (light.kind == kLightCylinder) middle += 0.5f * light.normal;
    vec3 toLight = middle - position;
    float squared = max(dot(toLight, toLight), 1.0e-30f);
    vec3 direction = toLight * inversesqrt(squared);
    float facing = isSurface(normal) ? max(dot(normal, direction), 0.0f) : 0.25f;
    bool isFlat = light.kind == kLightQuad || light.kind == kLightTriangle || light.kind == kLightDisk;
    if (!isFlat) return light.emission * (facing * min(light.radius * light.radius / squared, 1.0f));
    float leaving = -dot(light.normal, direction);
    float seen = light.area * (light.sides == kSidesBoth ? abs(leaving) : max(leaving, 0.0f));
    return light.emission * (facing * seen / (seen + kPi * squared));
}

// Of the sky, for a white diffuse surface: exact for a gradient, whose mean over the cosine is its value at 2/3 of the
// normal.
vec3 skyLight(SceneRef scene, vec3 normal) {
    if (!has(kFeatures, kFeatureSky)) return vec3(0.0f);
    if (has(kFeatures, kFeatureSkyImage) && has(kFeatures, kFeatureLights) && constants.globals.skyLight != kNone) {
        // Within the array whatever the condition says: see PreviewPass::listDraws().
        uint light = min(constants.globals.skyLight, constants.globals.lightCount - 1u);
        return loadLight(scene, light).emission; // its mean
    }
    return skyRadiance(kFeatures & ~kFeatureSkyImage, scene, normal * (2.0f / 3.0f));
}

// Radiance of a white diffuse surface that is seen from `wo`: the strongest lights, and what comes from all around,
// most of it from where the camera is, so that shapes show.
vec3 incidentLight(SceneRef scene, vec3 position, vec3 normal, vec3 wo) {
    vec3 sum = (launch.ambient + skyLight(scene, normal)) * (0.5f + 0.5f * dot(normal, wo));
    if (!has(kFeatures, kFeatureLights)) return sum;
    for (uint i = 0u; i < launch.lightCount; i++) {
        sum += unshadowedLight(loadLight(scene, launch.indices.at[i]), position, normal);
    }
    return sum;
}
