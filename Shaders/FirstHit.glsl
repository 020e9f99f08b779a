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

// What one sample of a pixel sees.
SeenSurfaces seenBy(RenderParams params, uvec2 pixel, Sampler smp, bool looksThrough) {
    SceneRef scene;
    scene.unused = 0u;
    SeenSurfaces seen = nothingSeen();
    PathState path = startPath(cameraRay(kFeatures, params, constants.camera, pixel, cameraSamples(kFeatures, smp)));
    float distance = 0.0f;
    bool goesOn = true;
    while (goesOn && isTraceable(path.ray, kInfinity)) {
        Hit hit = traceLayers(smp, 2u * path.vertex, path.ray, false, kInfinity);
        goesOn = seeSurface(kFeatures, scene, params, smp, hit, looksThrough, path, distance, seen);
    }
    seen.emission += path.radiance;
    return seen;
}

// Adds samples of a pixel and writes their means.
void writePixel(RenderParams params, uvec2 pixel, uint samples, inout SurfaceRange range) {
    bool looksThrough = launch.looksThrough != 0u;
    SeenSurfaces sums = nothingSeen();
    for (Sampler smp = samplerOf(pixel, kFeatureReplicate, 0u, params); smp.index < samples; smp.index++) {
        SeenSurfaces seen = seenBy(params, pixel, smp, looksThrough);
        extendRange(seen.first, range);
        addSeen(seen, sums);
    }
    float scale = 1.0f / float(samples);
    uint at = placeInLaunch(pixel, kSeenTogether, params) * aovValues(looksThrough);
    writeSurfaces(at + kFirstValues, sums.first, scale);
    if (!looksThrough) return;
    writeSurfaces(at + kWideValues, sums.wide, scale);
    writeVector(at + kEmissionValues, sums.emission * scale);
}

// What the invocation of one run does. Where the first samples differ it begins anew: to keep the sums of all pixels
// would take more registers than these samples take time.
void writeFeatures(uint invocation) {
    if (invocation >= launch.runs) return;
    RenderParams params = renderParams();
    uvec2 first = firstPixelOf(invocation, kSeenTogether, params);
    uint end = min(first.x + kSeenTogether, params.width);
    bool isAdaptive = launch.isAdaptive != 0u && launch.samples > kFirstSeenSamples;
    uint samples = isAdaptive ? kFirstSeenSamples : launch.samples;
    SurfaceRange range = emptyRange();
    bool isDone = false;
    while (!isDone) { // one call of what traces rays, as each takes compilers long
        for (uint x = first.x; x < end; x++) writePixel(params, uvec2(x, first.y), samples, range);
        isDone = samples == launch.samples || isNarrow(range);
        samples = launch.samples;
    }
}
