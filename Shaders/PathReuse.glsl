// Adds to the samples of a launch what the paths of their neighbours have found, see
// Common/Shared/Path/PathReuse.h: an invocation does so for the samples of one number of a group of pixels. The
// includer provides traceRay().
#extension GL_EXT_control_flow_attributes : require
#include "SceneAccess.glsl"
#include "SharedPaths.glsl"
#include "PixelEnd.glsl"

layout(push_constant, scalar) uniform Launch { FilmLaunch launch; };

// Whether a number stands for a sample: it has a pixel, which has not got all of its samples. To look up once what a
// group's samples have in common took the third book's box 1.02 times as long on an H200, and others as long as this.
bool existsSample(uint number) {
    uint step = number / kTilePixels;
    uint inSlot, replicate;
    uint slot = launchSlot(launch, quotient(step, launch.steps, inSlot));
    if (slot >= launch.activeSlots) return false;
    uint tilePixel = number % kTilePixels;
    uint tile = quotient(slot, launch.replicates, replicate);
    uvec2 pixel = pixelInTile(launch.samples.at[launch.filmSlots + tile], tilePixel);
    if (pixel.x >= constants.params.width || pixel.y >= constants.params.height) return false;
    uint done = launch.samples.at[slot];
    uint end = pixelEnd(launch, slot * kTilePixels + tilePixel, samplesAfter(launch, replicate, done));
    return done + inSlot < end;
}

// Number of the first sample, in the upper left pixel, of those that an invocation adds to.
uint firstOfGroup(uint step, uint group) {
    const uint kColumns = kTile / kReuseSide;
    return step * kTilePixels + group / kColumns * kReuseSide * kTile + group % kColumns * kReuseSide;
}

// Of the group's sample i.
uint numberInGroup(uint first, uint i) {
    return first + i / kReuseSide * kTile + i % kReuseSide;
}

// Density with which x could have drawn y; 0 where something is between them.
float densityFrom(SharedVertex x, SharedVertex y, bool isItself, inout uint rays) {
    float density = reuseDensity(x.position, x.normal, y.position, y.normal);
    if (isItself) return max(density, kLeastReuseDensity);
    if (density == 0.0f) return 0.0f;
    rays++;
    float tMax;
    Ray ray = reuseRay(x.position, y.position, tMax);
    return traceRay(ray, true, tMax).t < 0.0f ? density : 0.0f;
}

// Of the density with which the first vertex x of the sample of this number draws y to that of scattering alone.
float aimedRatioFrom(uint number, SharedVertex x, vec3 y) {
    if (!aimsPaths(kFeatures, renderParams())) return 1.0f;
    float aimed = uintBitsToFloat(launch.sharedPaths.at[4u * number + 1u].w);
    return aimedRatioTowards(constants.globals.aimed, x.position, x.normal, aimed, y);
}

void sharePaths(uint invocation) {
    const uint kGroups = kTilePixels / kReuseGroup;
    uint step = invocation / kGroups; // counted through all slots
    if (step >= launch.slotCount * launch.steps) return;
    uint first = firstOfGroup(step, invocation % kGroups);
    uint sharing = 0u; // a bit a sample
    for (uint i = 0u; i < kReuseGroup; i++) {
        uint number = numberInGroup(first, i);
        if (existsSample(number) && sharesVertex(launch.sharedPaths.at[4u * number + 3u].w)) sharing |= 1u << i;
    }
    vec3 received[kReuseGroup]; // at the first vertices
    [[unroll]] for (uint k = 0u; k < kReuseGroup; k++) received[k] = vec3(0.0f);
    uint rays = 0u;
    for (uint j = 0u; j < kReuseGroup; j++) {
        uvec4 end = launch.sharedPaths.at[4u * numberInGroup(first, j) + 3u];
        vec3 radiance = uintBitsToFloat(end.xyz);
        if ((sharing >> j & 1u) == 0u || end.w != kReuseSuffix || !(maxComponent(radiance) > 0.0f)) continue;
        SharedVertex y = secondVertex(launch.sharedPaths, numberInGroup(first, j));
        vec4 densities = vec4(0.0f); // of scattering alone
        float sum = 0.0f;            // of those with which y was drawn
        for (uint k = 0u; k < kReuseGroup; k++) {
            if ((sharing >> k & 1u) == 0u) continue;
            uint number = numberInGroup(first, k);
            SharedVertex x = firstVertex(launch.sharedPaths, number);
            densities[k] = densityFrom(x, y, k == j, rays);
            sum += densities[k] * aimedRatioFrom(number, x, y.position);
        }
        [[unroll]] for (uint k = 0u; k < kReuseGroup; k++) received[k] += radiance * (densities[k] / sum);
    }
    [[unroll]] for (uint k = 0u; k < kReuseGroup; k++) {
        if ((sharing >> k & 1u) == 0u) continue;
        uint number = numberInGroup(first, k);
        launch.radiance.at[number] += uintBitsToFloat(launch.sharedPaths.at[4u * number + 1u].xyz) * received[k];
    }
    if (rays != 0u) atomicAdd(launch.progress.counters[counterLine(invocation) + kCounterReuse], rays);
}
