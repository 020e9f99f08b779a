// Paths. Every invocation takes one sample after the other, the next that nobody has, and starts its path in the very step in which
// the last one ended: no lane of a group waits for the longest path, neighbours are at work at a time, whose rays are alike, and the
// invocations of a launch end within one path. Each step traces one ray, of the path or of a shadow, in one place: lanes with a
// shadow ray do not hold up those without, and the program keeps little alive across the trace. Measured against two places, that
// makes light sampling 1.25 to 1.5 times as fast.
//
// The includer provides traceRay().
#include "SceneAccess.glsl"
#include "Common/Shared/PathStep.h"
#include "TraceStep.glsl"

layout(push_constant, scalar) uniform Launch { FilmLaunch launch; };

struct Work {
    uint number; // of the sample in the launch
    uvec2 pixel;
    Sampler smp; // its index is that of the sample in the pixel, or `end` when that is done
    uint end;
};

// Finds the sample of this number. False: there is no such pixel or sample.
bool findWork(inout Work work) {
    uint step = work.number / kTilePixels;
    uint slot = launchSlot(launch, step / launch.steps);
    work.pixel = slotPixel(launch, slot, work.number % kTilePixels);
    if (work.pixel.x >= constants.params.width || work.pixel.y >= constants.params.height) return false;
    uint done = launch.samples.at[slot];
    uint index = done + step % launch.steps;
    work.smp = makeSampler(renderParams(), work.pixel.y * constants.params.width + work.pixel.x, slot % launch.replicates,
                           index);
    work.end = index + 1u;
    return index < samplesAfter(launch, slot, done);
}

// False: all have been taken.
bool takeWork(inout Work work) {
    uint samples = launchSamples(launch);
    for (;;) {
        work.number = atomicAdd(launch.counters.at[kCounterWork], 1u);
        if (work.number >= samples) return false;
        if (findWork(work)) return true;
    }
}

PathState beginPath(RenderParams params, Work work) {
    return startPath(kFeatures, params, constants.camera, work.smp, work.pixel, randomPair(work.smp, kPairPixel));
}

// What an invocation does; all invocations of a launch share its samples.
void tracePaths(uint invocation) {
    SceneRef scene;
    scene.unused = 0u;
    RenderParams params = renderParams();
    uint line = invocation % kCounterLines * kCounters;
    uint scattered = 0u;
    uint shadow = 0u;
    uint nonfinite = 0u;
    uint finished = 0u;
    Work work;
    work.smp.index = 0u;
    work.end = 0u;
    PathState path;
    DirectLight direct = noDirectLight();
    bool begins = true;
    bool goesOn = false; // the path has a next vertex
    for (;;) {
        // Paths begin in one place: compilers round two copies of it differently, and it is the launch that decides which samples
        // an invocation begins with.
        if (begins) {
            // The sample is always done here; without the question LLVM 15 crashes, with which Mesa compiles for processors.
            if (work.smp.index == work.end && !takeWork(work)) break;
            path = beginPath(params, work);
        }
        bool checking = direct.distance > 0.0f;
        Hit hit = traceStep(path, direct, checking, nonfinite);
        if (checking) {
            shadow++;
            if (hit.t < 0.0f) addDirectLight(kFeatures, scene, direct, path);
            direct.distance = 0.0f;
        } else {
            goesOn = pathVertex(kFeatures, scene, params, work.smp, vertexNumbers(work.smp, path.vertex), hit, path,
                                direct);
        }
        begins = !goesOn && !(direct.distance > 0.0f);
        if (begins) {
            scattered += path.vertex - 1u;
            // A sample that is not a number is dropped and counted, and stays in the divisor.
            if (!isFinite(path.radiance)) {
                path.radiance = vec3(0.0f);
                nonfinite++;
            }
            launch.radiance.at[work.number] = path.radiance;
            finished++;
            work.smp.index++;
        }
    }
    atomicAdd(launch.counters.at[line + kCounterFinished], finished);
    atomicAdd(launch.counters.at[line + kCounterScattered], scattered);
    atomicAdd(launch.counters.at[line + kCounterShadow], shadow);
    if (nonfinite != 0u) atomicAdd(launch.counters.at[line + kCounterNonfinite], nonfinite);
}
