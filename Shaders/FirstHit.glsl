// First-hit features of a pixel, averaged over its first samples. The includer provides traceRay().
#include "PixelPass.glsl"
#include "TraceStep.glsl"

// What the invocation of one pixel of a launch does.
void writeFeatures(uint invocation) {
    SceneRef scene;
    scene.unused = 0u;
    RenderParams params = renderParams();
    PixelSamples samples;
    if (!beginPixel(invocation, params, samples)) return;
    vec3 albedo = vec3(0.0f);
    vec3 normal = vec3(0.0f);
    float depth = 0.0f;
    uint hits = 0u;
    for (; samples.smp.index < launch.samples; samples.smp.index++) {
        CameraSamples u = cameraSamples(kFeatures, samples.smp);
        Ray ray = cameraRay(kFeatures, params, constants.camera, samples.pixel, u);
        Hit hit = traceLayers(samples.smp, 0u, ray, false, kInfinity);
        if (hit.t < 0.0f) continue;
        Surface surface = makeSurface(kFeatures, scene, ray, hit);
        Material material = loadMaterial(scene, surface.material);
        albedo += surfaceAlbedo(kFeatures, scene, material, surface);
        normal += dot(ray.direction, surface.normal) < 0.0f ? surface.shading : -surface.shading;
        depth += hit.t;
        hits++;
    }
    float scale = 1.0f / float(launch.samples);
    uint first = invocation * kAovValues;
    for (uint c = 0u; c < 3u; c++) {
        launch.values.at[first + c] = albedo[c] * scale;
        launch.values.at[first + 3u + c] = normal[c] * scale;
    }
    launch.values.at[first + 6u] = hits > 0u ? depth / float(hits) : 0.0f;
}
