// Adds to the samples of a launch what the paths of their neighbours have found, see
// Common/Shared/Path/PathReuse.h: an invocation does so for the samples of one number of a group of pixels. The
// includer provides traceRay().
#extension GL_EXT_control_flow_attributes : require
#include "SceneAccess.glsl"
#include "SharedPaths.glsl"
#include "PixelEnd.glsl"

layout(push_constant, scalar) uniform Launch { FilmLaunch launch; };

// A step of a launch: a sample of each pixel of a slot.
struct Step {
    uint slot;
    uint tile;  // as pixelInTile() has it
    uint index; // of the samples
    uint end;   // that samples of the slot's pixels have not reached
};

// False: there is no such step.
bool findStep(uint number, out Step step) {
    uint inSlot, replicate;
    step.slot = launchSlot(launch, quotient(number, launch.steps, inSlot));
    if (step.slot >= launch.activeSlots) return false;
    step.tile = launch.samples.at[launch.filmSlots + quotient(step.slot, launch.replicates, replicate)];
    uint done = launch.samples.at[step.slot];
    step.index = done + inSlot;
    step.end = samplesAfter(launch, replicate, done);
    return true;
}

// Whether the step has a sample of this pixel of the tile: it is in the image, and has not got all of its samples.
bool existsSample(Step step, uint tilePixel) {
    uvec2 pixel = pixelInTile(step.tile, tilePixel);
    if (pixel.x >= constants.params.width || pixel.y >= constants.params.height) return false;
    return step.index < pixelEnd(launch, step.slot * kTilePixels + tilePixel, step.end);
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

void sharePaths(uint invocation) {
    const uint kGroups = kTilePixels / kReuseGroup;
    uint number = invocation / kGroups; // of the step, counted through all slots
    Step step;
    if (number >= launch.slotCount * launch.steps || !findStep(number, step)) return;
    uint first = firstOfGroup(number, invocation % kGroups);
    uint sharing = 0u; // a bit a sample
    for (uint i = 0u; i < kReuseGroup; i++) {
        uint member = numberInGroup(first, i);
        if (existsSample(step, member % kTilePixels) && sharesVertex(launch.sharedPaths.at[4u * member + 3u].w))
            sharing |= 1u << i;
    }
    vec3 received[kReuseGroup]; // at the first vertices
    [[unroll]] for (uint k = 0u; k < kReuseGroup; k++) received[k] = vec3(0.0f);
    uint rays = 0u;
    for (uint j = 0u; j < kReuseGroup; j++) {
        uvec4 end = launch.sharedPaths.at[4u * numberInGroup(first, j) + 3u];
        vec3 radiance = uintBitsToFloat(end.xyz);
        if ((sharing >> j & 1u) == 0u || end.w != kReuseSuffix || !(maxComponent(radiance) > 0.0f)) continue;
        SharedVertex y = secondVertex(launch.sharedPaths, numberInGroup(first, j));
        vec4 densities = vec4(0.0f);
        for (uint k = 0u; k < kReuseGroup; k++) {
            if ((sharing >> k & 1u) == 0u) continue;
            SharedVertex x = firstVertex(launch.sharedPaths, numberInGroup(first, k));
            densities[k] = densityFrom(x, y, k == j, rays);
        }
        float sum = densities.x + densities.y + densities.z + densities.w;
        [[unroll]] for (uint k = 0u; k < kReuseGroup; k++) received[k] += radiance * (densities[k] / sum);
    }
    [[unroll]] for (uint k = 0u; k < kReuseGroup; k++) {
        if ((sharing >> k & 1u) == 0u) continue;
        uint member = numberInGroup(first, k);
        launch.radiance.at[member] += uintBitsToFloat(launch.sharedPaths.at[4u * member + 1u].xyz) * received[k];
    }
    if (rays != 0u) atomicAdd(launch.progress.counters[counterLine(invocation) + kCounterReuse], rays);
}
