// Adds to the samples of a launch what the paths of their neighbours have found, see
// Common/Shared/Path/PathReuse.h: an invocation does so for the samples of one number of a group of pixels. The
// includer provides traceRay().
#extension GL_EXT_control_flow_attributes : require
#include "SceneAccess.glsl"
#include "SharedPaths.glsl"
#include "PixelEnd.glsl"

layout(push_constant, scalar) uniform Launch { PathLaunch launch; };

// The samples of one number of a group of pixels.
struct SampleGroup {
    uint slot;
    uint tilePixel; // the upper left one
    uint index;
    uint number;    // of the upper left pixel's sample in its launch
    uvec2 distance; // to the numbers of the next column and row
};

// False: it is beyond the last.
bool findGroup(uint invocation, out SampleGroup group) {
    const uint kGroups = kTilePixels / kReuseGroup;
    if (invocation * kReuseGroup >= launch.film.sampleCount) return false;
    // Of the upper left pixel's sample.
    uint place = invocation / kGroups * kTilePixels + groupedPixel(invocation % kGroups * kReuseGroup);
    group.number = place;
    group.distance = uvec2(1u, kTile);
    if ((launch.film.flags & kIsPlanned) != 0u) {
        PlannedSample planned = launch.planned.at[invocation * kReuseGroup];
        place = planned.place;
        group.number = planned.number;
        group.distance = uvec2(1u, kReuseSide);
    }
    uint inSlot;
    group.slot = launchSlot(launch.film, quotient(place / kTilePixels, launch.film.steps, inSlot));
    group.tilePixel = place % kTilePixels;
    if (group.slot >= launch.film.filmSlots) return false;
    group.index = launch.film.samples.at[group.slot] + inSlot;
    return true;
}

// Of the group's sample i.
uint numberInGroup(SampleGroup group, uint i) {
    return group.number + i / kReuseSide * group.distance.y + i % kReuseSide * group.distance.x;
}

// Whether there is such a sample: its pixel is in the image and has not got all of its samples.
bool existsSample(SampleGroup group, uint i) {
    uint replicate;
    uint tile = quotient(group.slot, launch.film.replicates, replicate);
    uint tilePixel = group.tilePixel + groupedPixel(i);
    uvec2 pixel = pixelInTile(launch.film.samples.at[launch.film.filmSlots + tile], tilePixel);
    if (pixel.x >= constants.params.width || pixel.y >= constants.params.height) return false;
    uint done = launch.film.samples.at[group.slot];
    uint end = samplesAfter(launch.film, replicate, done);
    return group.index < pixelEnd(launch.film, group.slot * kTilePixels + tilePixel, end);
}

// Density with which x could have drawn y; 0 where something is between them.
float densityFrom(SharedVertex x, SharedVertex y, bool isItself, inout uint rays) {
    float density = reuseDensity(x.position, x.normal, y.position, y.normal);
    if (isItself) return max(density, kMinReuseDensity);
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
    SampleGroup group;
    if (!findGroup(invocation, group)) return;
    uint sharing = 0u; // a bit a sample
    for (uint i = 0u; i < kReuseGroup; i++) {
        uint number = numberInGroup(group, i);
        if (existsSample(group, i) && sharesVertex(launch.sharedPaths.at[4u * number + 3u].w)) sharing |= 1u << i;
    }
    vec3 received[kReuseGroup]; // at the first vertices
    [[unroll]] for (uint k = 0u; k < kReuseGroup; k++) received[k] = vec3(0.0f);
    uint rays = 0u;
    for (uint j = 0u; j < kReuseGroup; j++) {
        uvec4 end = launch.sharedPaths.at[4u * numberInGroup(group, j) + 3u];
        vec3 radiance = uintBitsToFloat(end.xyz);
        if ((sharing >> j & 1u) == 0u || end.w != kReuseSuffix || !(maxComponent(radiance) > 0.0f)) continue;
        SharedVertex y = secondVertex(launch.sharedPaths, numberInGroup(group, j));
        vec4 densities = vec4(0.0f); // of scattering alone
        float sum = 0.0f;            // of those with which y was drawn
        for (uint k = 0u; k < kReuseGroup; k++) {
            if ((sharing >> k & 1u) == 0u) continue;
            uint number = numberInGroup(group, k);
            SharedVertex x = firstVertex(launch.sharedPaths, number);
            densities[k] = densityFrom(x, y, k == j, rays);
            sum += densities[k] * aimedRatioFrom(number, x, y.position);
        }
        [[unroll]] for (uint k = 0u; k < kReuseGroup; k++) received[k] += radiance * (densities[k] / sum);
    }
    [[unroll]] for (uint k = 0u; k < kReuseGroup; k++) {
        if ((sharing >> k & 1u) == 0u) continue;
        uint number = numberInGroup(group, k);
        launch.film.radiance.at[number] += uintBitsToFloat(launch.sharedPaths.at[4u * number + 1u].xyz) * received[k];
    }
    if (rays != 0u) atomicAdd(launch.progress.counters[counterLine(invocation) + kCounterReuse], rays);
}
