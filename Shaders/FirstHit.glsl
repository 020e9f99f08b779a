// Features of the surfaces that a pixel sees, averaged over samples of their own. The includer provides traceRay().
#include "PixelPass.glsl"
#include "TraceStep.glsl"
#include "Common/Shared/Path/SeenSurfaces.h"

void writeVector(uint at, vec3 value) {
    for (uint c = 0u; c < 3u; c++) launch.values.at[at + c] = value[c];
}

void writeSurfaces(uint at, SurfaceSums sums, float scale) {
    writeVector(at, sums.albedo * scale);
    writeVector(at + 3u, sums.normal * scale);
    launch.values.at[at + 6u] = meanDepth(sums);
}

// What the invocation of one pixel of a launch does.
void writeFeatures(uint invocation) {
    SceneRef scene;
    scene.unused = 0u;
    RenderParams params = renderParams();
    PixelSamples samples;
    if (!beginPixel(invocation, kFeatureReplicate, params, samples)) return;
    bool looksThrough = launch.looksThrough != 0u;
    SeenSurfaces seen = nothingSeen();
    for (; samples.smp.index < launch.samples; samples.smp.index++) {
        CameraSamples u = cameraSamples(kFeatures, samples.smp);
        PathState path = startPath(cameraRay(kFeatures, params, constants.camera, samples.pixel, u));
        float distance = 0.0f;
        bool goesOn = true;
        while (goesOn && isTraceable(path.ray, kInfinity)) {
            Hit hit = traceLayers(samples.smp, 2u * path.vertex, path.ray, false, kInfinity);
            goesOn = seeSurface(kFeatures, scene, params, samples.smp, hit, looksThrough, path, distance, seen);
        }
        seen.emission += path.radiance;
    }
    float scale = 1.0f / float(launch.samples);
    uint first = invocation * aovValues(looksThrough);
    writeSurfaces(first + kFirstValues, seen.first, scale);
    if (!looksThrough) return;
    writeSurfaces(first + kWideValues, seen.wide, scale);
    writeVector(first + kEmissionValues, seen.emission * scale);
}
