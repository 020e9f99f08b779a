// Paths. Every invocation takes one sample after the other, the next that nobody has, and starts its path in the very
// step in which the last one ended: no lane of a group waits for the longest path, and neighbours are at work at a
// time, whose rays are alike. When no sample is left, paths under way are put aside for the next launch: no launch
// waits for its longest path either.
//
// The includer provides traceRay() and, both found by measuring, see docs/measurements/gpu-engine.md:
//   kRaysPerStep   2: a step traces the path's ray and, if it leaves one, the shadow's; 1: whichever is next
//   tracesApart()  whether the program has two places that trace, one for each of the two rays of a step
#extension GL_KHR_memory_scope_semantics : require
#include "SceneAccess.glsl"
#include "Edges.glsl"
#include "SharedPaths.glsl"
#include "TraceStep.glsl"
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

// Of a sample that has been taken, or its next edge ray.
PathState beginPath(RenderParams params, Work work, bool isEdgeRay, vec3 radiance) {
    CameraSamples u = cameraSamples(kFeatures, work.smp);
    // In place of startEdgeRay(), which with what goes with it takes an H200 1.18 times as long in the glass box.
    float weight = 1.0f;
    uint emission = kEmissionWeighed;
    if (hasEdges() && work.edgeRays != 0u) {
        PixelPart part = pixelPart(packedPart(work.pixel));
        if (isEdgeRay) {
            u.pixel = placeInPart(part, u.pixel);
            weight = edgeWeight(params, part);
            emission = kEmissionOfEdgeRay;
        } else if (isInPart(part, u.pixel)) {
            emission = kEmissionApart;
        }
    }
    PathState path = startPath(cameraRay(kFeatures, params, constants.camera, work.pixel, u));
    path.throughput = vec3(weight);
    path.emission = emission;
    if (isEdgeRay) {
        path.radiance = radiance;
        path.reuse = kReuseNone;
    }
    return path;
}

// When its own path is to begin: tells whether edge rays follow, and counts them.
void expectEdgeRays(uint invocation, inout Work work) {
    uint rays = edgeRays(work.pixel);
    if (rays == 0u) return;
    work.edgeRays = rays + 1u;
    atomicAdd(launch.progress.counters[counterLine(invocation) + kCounterEdgeRays], rays);
}

void nextEdgeRay(RenderParams params, inout Work work) {
    work.edgeRays--;
    if (work.edgeRays == params.edgeRays)
        work.smp = edgeSampler(params, work.smp, 0u);
    else
        work.smp.index++;
}

// Goes on with the path of this number that the launch before left. False: there is none.
bool resumePath(uint number, RenderParams params, inout Work work, inout PathState path, inout DirectLight direct,
                inout TechniqueStep step, inout bool goesOn) {
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

// Takes the path a step further, given what its ray hits. False: it has ended.
bool stepAlong(SceneRef scene, RenderParams params, Work work, Hit hit, inout PathState path, inout DirectLight direct,
               inout TechniqueStep step) {
    uint before = path.reuse;
    bool goesOn = stepPath(kFeatures, scene, params, work.smp, hit, path, direct, step);
    if (reusesPaths(kFeatures, params) && path.reuse != before) keepVertex(work, path, step.part);
    return goesOn;
}

// What an invocation does; all invocations of a launch share its samples.
void tracePaths(uint invocation) {
    SceneRef scene;
    scene.unused = 0u;
    RenderParams params = renderParams();
    uint scattered = 0u;
    uint shadow = 0u;
    uint nonfinite = 0u;
    uint finished = 0u;
    Work work;
    work.edgeRays = 0u;
    work.isResumed = false;
    PathState path;
    DirectLight direct = noDirectLight();
    TechniqueStep step = beginTechniqueStep();
    bool goesOn = false; // the path has a next vertex
    bool begins = !resumePath(invocation, params, work, path, direct, step, goesOn);
    bool isSpent = false; // there is no sample to begin with
    for (;;) {
        // Read before it is needed: the time that it takes passes with the beginning of a path.
        bool isOver = samplesAreSpent();
        // Paths begin in one place: compilers round two copies of it differently, and it is the launch that decides
        // which samples an invocation begins with.
        if (begins) {
            bool isEdgeRay = work.edgeRays != 0u;
            if (isEdgeRay) {
                nextEdgeRay(params, work);
            } else {
                isSpent = !takeWork(work);
                if (!isSpent) expectEdgeRays(invocation, work);
            }
            if (!isSpent) path = beginPath(params, work, isEdgeRay, path.radiance);
        }
        if (isSpent) {
            tellSamplesAreSpent();
            break;
        }
        // A path goes on in the next launch, but not in a third one.
        if (isOver && !work.isResumed && launch.film.slotCount != 0u) break;
        if (tracesApart()) {
            Hit hit = traceStep(work.smp, path, direct, step, false, nonfinite);
            goesOn = stepAlong(scene, params, work, hit, path, direct, step);
            scattered += uint(goesOn);
            while (isChecking(direct, step)) {
                hit = traceStep(work.smp, path, direct, step, true, nonfinite);
                endChecked(scene, hit, path, direct, step);
                shadow++;
                if (!has(kFeatures, kMethodConnections)) break;
            }
        } else {
            for (uint i = 0u; i < kRaysPerStep; i++) {
                bool checking = isChecking(direct, step);
                if (i > 0u && !checking) break;
                Hit hit = traceStep(work.smp, path, direct, step, checking, nonfinite);
                if (checking) {
                    endChecked(scene, hit, path, direct, step);
                    shadow++;
                } else {
                    goesOn = stepAlong(scene, params, work, hit, path, direct, step);
                    scattered += uint(goesOn);
                }
            }
        }
        begins = !goesOn && !isChecking(direct, step);
        bool isOwn = work.edgeRays == 0u || work.edgeRays > params.edgeRays;
        if (begins && isOwn && isCutOff(params, path)) countCutOff(invocation, work, path);
        bool isKept = reusesPaths(kFeatures, params) && begins && isOwn && endShared(work, path, nonfinite);
        if (begins && work.edgeRays <= 1u) {
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
    if (!isSpent) leavePath(work, path, direct, step, goesOn);
    uint line = counterLine(invocation);
    atomicAdd(launch.progress.counters[line + kCounterFinished], finished);
    atomicAdd(launch.progress.counters[line + kCounterScattered], scattered);
    atomicAdd(launch.progress.counters[line + kCounterShadow], shadow);
    if (nonfinite != 0u) atomicAdd(launch.progress.counters[line + kCounterNonfinite], nonfinite);
}
