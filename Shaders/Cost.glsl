// What a pixel costs, averaged over its first samples: rays, camera, scattered and shadow, none for sharing paths; or
// with RT_TIME ticks of the shader clock, which count all that lanes of a group wait for each other. The includer
// provides traceRay().
#ifdef RT_TIME
#extension GL_ARB_shader_clock : require
#endif
#include "PixelPass.glsl"
#include "Edges.glsl"
#include "TraceStep.glsl"

// Rays of a path. Whether the light arrives makes no difference to how it goes on, but tracing that takes time.
uint tracePath(SceneRef scene, RenderParams params, Sampler smp, PathState path) {
    DirectLight direct = noDirectLight();
    SpecularConnection connection = noConnection();
    uint rays = 0u;
    uint nonfinite = 0u;
    bool goesOn = true;
    while (goesOn || isChecking(direct, connection)) {
        bool checking = isChecking(direct, connection);
        Hit hit = traceStep(smp, path, direct, connection, checking, nonfinite);
        rays++;
        if (checking) {
            endChecked(scene, hit, path, direct, connection);
        } else {
            SharedPart unusedPart;
            goesOn = stepPath(kFeatures, scene, params, smp, hit, path, unusedPart, direct, connection);
        }
    }
    return rays;
}

// Of a sample: of its own path, and of its edge rays.
uint traceSample(SceneRef scene, RenderParams params, PixelSamples samples) {
    uint rays = 0u;
    uint count = edgeRays(samples.pixel);
    for (uint i = 0u; i <= count; i++) {
        Sampler smp = samples.smp;
        if (i > 0u) smp = edgeSampler(params, smp, i - 1u);
        CameraSamples u = cameraSamples(kFeatures, smp);
        PixelPart part;
        if (count > 0u) part = pixelPart(packedPart(samples.pixel));
        if (i > 0u) u.pixel = placeInPart(part, u.pixel);
        Ray ray = cameraRay(kFeatures, params, constants.camera, samples.pixel, u);
        PathState path = startPath(ray);
        if (i > 0u) {
            path = startEdgeRay(params, part, ray, vec3(0.0f));
        } else if (count > 0u && isInPart(part, u.pixel)) {
            path.pdf = kCountedApart;
        }
        rays += tracePath(scene, params, smp, path);
    }
    return rays;
}

// What the invocation of one pixel of a launch does.
void writeCost(uint invocation) {
    SceneRef scene;
    scene.unused = 0u;
    RenderParams params = renderParams();
    PixelSamples samples;
    if (!beginPixel(invocation, params, samples)) return;
    uint cost = 0u;
#ifdef RT_TIME
    uint start = clock2x32ARB().x; // a launch is far shorter than the low word's turn
#endif
    for (; samples.smp.index < launch.samples; samples.smp.index++) cost += traceSample(scene, params, samples);
#ifdef RT_TIME
    cost = cost > 0u ? clock2x32ARB().x - start : 0u; // the paths must have been traced
#endif
    launch.values.at[invocation] = float(cost) / float(launch.samples);
}
