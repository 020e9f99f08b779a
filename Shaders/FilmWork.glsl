// Where the paths of PathLoop.glsl come from and go to when a film is rendered. All invocations of a launch share its
// samples: each takes the next that nobody has. When no sample is left, paths under way are put aside for the next
// launch: no launch waits for its longest path.
#extension GL_KHR_memory_scope_semantics : require
#include "SceneAccess.glsl"
#include "Edges.glsl"
#include "SharedPaths.glsl"
#include "PixelEnd.glsl"

layout(push_constant, scalar) uniform Launch { PathLaunch launch; };

struct Work {
    uint number; // of the sample in its launch
    uvec2 pixel;
    Sampler smp;    // of the path that is under way
    uint edgeRays;  // of the sample that have not ended; one more while its own path, which comes first, is under way
    bool isResumed; // the launch before began it
};

// Finds the sample of this number. False: there is no such pixel or sample. What it has in common with PathReuse.glsl
// is spelled out: as a function it makes One Weekend take an H200 1.04 times as long.
bool findWork(inout Work work) {
    uint place = work.number;
    if ((launch.film.flags & kIsPlanned) != 0u) {
        PlannedSample planned = launch.planned.at[work.number];
        place = planned.place;
        work.number = planned.number;
    }
    uint step = place / kTilePixels;
    uint inSlot;
    uint slot = launchSlot(launch.film, quotient(step, launch.film.steps, inSlot));
    if (slot >= launch.film.filmSlots) return false;
    uint tilePixel = place % kTilePixels;
    uint replicate;
    uint tile = quotient(slot, launch.film.replicates, replicate);
    work.pixel = pixelInTile(launch.film.samples.at[launch.film.filmSlots + tile], tilePixel);
    if (work.pixel.x >= constants.params.width || work.pixel.y >= constants.params.height) return false;
    uint done = launch.film.samples.at[slot];
    uint index = done + inSlot;
    uint pixelIndex = work.pixel.y * constants.params.width + work.pixel.x;
    work.smp = makeSampler(renderParams(), pixelIndex, replicate, index);
    return index <
           pixelEnd(launch.film, slot * kTilePixels + tilePixel, samplesAfter(launch.film, replicate, done));
}

// False: all have been taken.
bool takeWork(inout Work work) {
    uint samples = launch.film.sampleCount;
    work.isResumed = false;
    for (;;) {
        work.number = atomicAdd(launch.progress.counters[kCounterWork], 1u);
        if (work.number >= samples) return false;
        if (findWork(work)) return true;
    }
}

void countEdgeRays(uint invocation, inout Work work, uint rays) {
    atomicAdd(launch.progress.counters[counterLine(invocation) + kCounterEdgeRays], rays);
}

// Goes on with the path of this number that the launch before left. False: there is none.
bool resumePath(uint number, RenderParams params, inout Work work, inout PathState path, inout DirectLight direct,
                inout TechniqueStep step, inout bool goesOn) {
    work.isResumed = false;
    if (number >= launch.progressBefore.counters[kCounterLeft]) return false;
    UnfinishedPath unfinished = launch.progressBefore.left[number];
    work.number = unfinished.number;
    work.smp = makeSampler(params, 0u, 0u, 0u);
    work.smp.key = unfinished.key;
    work.smp.index = unfinished.index;
    work.smp.base = unfinished.base;
    work.pixel = unfinished.pixel;
    if (hasEdges()) work.edgeRays = unfinished.edgeRays;
    work.isResumed = true;
    path = unfinished.path;
    if (!has(kFeatures, kFeatureMovingSpheres)) path.ray.time = 0.0f; // as the compiler is to know
    direct = unfinished.direct;
    if (has(kFeatures, kMethodConnections)) step.connection = unfinished.connection;
    goesOn = unfinished.goesOn != 0u;
    return true;
}

void leavePath(Work work, PathState path, DirectLight direct, TechniqueStep step, bool goesOn) {
    UnfinishedPath unfinished;
    unfinished.number = work.number;
    unfinished.key = work.smp.key;
    unfinished.index = work.smp.index;
    unfinished.base = work.smp.base;
    unfinished.pixel = work.pixel;
    unfinished.edgeRays = work.edgeRays;
    unfinished.goesOn = goesOn ? 1u : 0u;
    unfinished.path = path;
    unfinished.direct = direct;
    if (has(kFeatures, kMethodConnections)) unfinished.connection = step.connection;
    launch.progress.left[atomicAdd(launch.progress.counters[kCounterLeft], 1u)] = unfinished;
}

// What the samples of this path's launch bring, and what they share.
MutableVectorArray radiancesOf(Work work) {
    MutableVectorArray radiance = launch.film.radiance;
    if (work.isResumed) radiance = launch.radianceBefore;
    return radiance;
}

SharedPathArray sharedPathsOf(Work work) {
    SharedPathArray paths = launch.sharedPaths;
    if (work.isResumed) paths = launch.sharedPathsBefore;
    return paths;
}

// The path has stepped to the first or the second vertex that is shared.
void keepVertex(Work work, PathState path, SharedPart part) {
    SharedPathArray paths = sharedPathsOf(work);
    if (path.reuse == kReuseFirst) {
        vec3 throughput = aimsPaths(kFeatures, renderParams()) ? part.throughput : path.throughput;
        keepFirst(paths, work.number, path.last.position, path.last.normal, throughput, part.aimed);
    }
    if (path.reuse == kReuseSuffix) {
        keepSecond(paths, work.number, path.last.position, path.last.normal);
        radiancesOf(work).at[work.number] = part.prefix;
    }
}

// The sample's own path has ended. What its second vertex sends out is shared: then true. What it had brought before
// is where keepVertex() has put it, or comes back for edge rays to add to.
bool endShared(Work work, inout PathState path, inout uint nonfinite) {
    if (path.reuse == kReuseSuffix && !isFinite(path.radiance)) {
        path.radiance = vec3(0.0f);
        nonfinite++;
    }
    keepEnd(sharedPathsOf(work), work.number, path.radiance, path.reuse);
    if (path.reuse != kReuseSuffix) return false;
    if (hasEdges() && work.edgeRays > 1u) path.radiance = radiancesOf(work).at[work.number];
    return true;
}

// Max depth has cut off the sample's own path. Counted at once: that is rare, and a sum of the invocation's own would
// take a register throughout.
void countCutOff(uint invocation, Work work, PathState path) {
    vec3 before = vec3(1.0f);
    if (reusesPaths(kFeatures, renderParams()) && path.reuse == kReuseSuffix)
        before = uintBitsToFloat(sharedPathsOf(work).at[4u * work.number + 1u].xyz);
    float units = clamp(cutOffThroughput(path, before), 0.0f, 64.0f) / kCutOffUnit;
    atomicAdd(launch.progress.counters[counterLine(invocation) + kCounterCutOff], uint(units + 0.5f));
}

// Whether an invocation has found no sample any more.
bool samplesAreSpent() {
    return atomicLoad(launch.progress.counters[kSpent], gl_ScopeDevice, gl_StorageSemanticsNone,
                      gl_SemanticsRelaxed) != 0u;
}

void tellSamplesAreSpent() {
    atomicStore(launch.progress.counters[kSpent], 1u, gl_ScopeDevice, gl_StorageSemanticsNone, gl_SemanticsRelaxed);
}

// Whether a path under way is left to the next launch. It goes on there, but not in a third one.
bool mayLeave(Work work) {
    return !work.isResumed && launch.film.slotCount != 0u;
}

// The sample's own path has ended, or one of its edge rays; the last of these ends the sample.
void endPath(bool ends, uint invocation, RenderParams params, inout Work work, inout PathState path,
             inout uint nonfinite, inout uint finished) {
    bool isOwn = work.edgeRays == 0u || work.edgeRays > params.edgeRays;
    if (ends && isOwn && isCutOff(params, path)) countCutOff(invocation, work, path);
    bool isKept = reusesPaths(kFeatures, params) && ends && isOwn && endShared(work, path, nonfinite);
    if (ends && work.edgeRays <= 1u) {
        work.edgeRays = 0u;
        // A sample that is not a number is dropped and counted, and stays in the divisor.
        if (!isFinite(path.radiance)) {
            path.radiance = vec3(0.0f);
            nonfinite++;
        }
        if (!isKept) radiancesOf(work).at[work.number] = path.radiance;
        finished++;
    }
}

void endWork(uint invocation, Work work, uint finished, uint scattered, uint shadow, uint nonfinite) {
    uint line = counterLine(invocation);
    atomicAdd(launch.progress.counters[line + kCounterFinished], finished);
    atomicAdd(launch.progress.counters[line + kCounterScattered], scattered);
    atomicAdd(launch.progress.counters[line + kCounterShadow], shadow);
    if (nonfinite != 0u) atomicAdd(launch.progress.counters[line + kCounterNonfinite], nonfinite);
}
