// First-hit features of a pixel, averaged over its first samples. The includer provides traceRay().
#include "SceneAccess.glsl"
#include "Common/Shared/PathStep.h"

layout(push_constant, scalar) uniform Launch { AovLaunch launch; };

// What the invocation of one pixel of a launch does.
void writeFeatures(uint index) {
    if (index >= launch.pixels) return;
    SceneRef scene;
    scene.unused = 0u;
    RenderParams params = renderParams();
    uvec2 pixel = uvec2(index % params.width, launch.firstRow + index / params.width);
    Sampler smp = makeSampler(params, pixel.y * params.width + pixel.x, 0u, 0u);
    vec3 albedo = vec3(0.0f);
    vec3 normal = vec3(0.0f);
    float depth = 0.0f;
    for (; smp.index < launch.samples; smp.index++) {
        Ray ray = startPath(kFeatures, params, constants.camera, smp, pixel, randomPair(smp, kPairPixel)).ray;
        Hit hit = traceRay(ray, false, kInfinity);
        if (hit.t < 0.0f) continue;
        Surface surface = makeSurface(kFeatures, scene, ray, hit);
        Material material = loadMaterial(scene, surface.material);
        albedo += texturedAlbedo(kFeatures, scene, material.albedo, material.texture, surface.position, surface.uv);
        normal += dot(ray.direction, surface.normal) < 0.0f ? surface.shading : -surface.shading;
        depth += hit.t;
    }
    float scale = 1.0f / float(launch.samples);
    uint first = index * kAovValues;
    for (uint c = 0u; c < 3u; c++) {
        launch.values.at[first + c] = albedo[c] * scale;
        launch.values.at[first + 3u + c] = normal[c] * scale;
    }
    launch.values.at[first + 6u] = depth * scale;
}
