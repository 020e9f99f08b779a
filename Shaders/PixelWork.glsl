// Where the paths of PathLoop.glsl come from when a pixel's cost is asked for: each invocation goes through the first
// samples of a pixel, whose light nobody keeps. The cost is an average over them: of rays, camera, scattered and
// shadow, none for sharing paths; or with RT_TIME of ticks of the shader clock, which count all that lanes of a group
// wait for each other.
#ifdef RT_TIME
#extension GL_ARB_shader_clock : require
#endif
#include "PixelPass.glsl"
#include "Edges.glsl"

struct Work {
    uvec2 pixel;
    Sampler smp;   // of the path that is under way
    uint edgeRays; // as in FilmWork.glsl
    Sampler next;  // of the sample that is to come
    uint begun;    // camera rays
#ifdef RT_TIME
    uint start; // a launch is far shorter than the turn of the clock's low word
#endif
};

// There is no path to go on with.
bool resumePath(uint invocation, RenderParams params, inout Work work, inout PathState path, inout DirectLight direct,
                inout TechniqueStep step, inout bool goesOn) {
    work.pixel = firstPixelOf(invocation, 1u, params);
    work.next = samplerOf(work.pixel, 0u, 0u, params);
    if (invocation >= launch.runs) work.next.index = launch.samples;
    work.begun = 0u;
#ifdef RT_TIME
    work.start = clock2x32ARB().x;
#endif
    return false;
}

bool takeWork(inout Work work) {
    if (work.next.index >= launch.samples) return false;
    work.smp = work.next;
    work.next.index++;
    work.begun++;
    return true;
}

void countEdgeRays(uint invocation, inout Work work, uint rays) {
    work.begun += rays;
}

bool samplesAreSpent() {
    return false; // as other invocations see it
}

void tellSamplesAreSpent() {}

bool mayLeave(Work work) {
    return false;
}

void leavePath(Work work, PathState path, DirectLight direct, TechniqueStep step, bool goesOn) {}

void keepVertex(Work work, PathState path, SharedPart part) {}

void endPath(bool ends, uint invocation, RenderParams params, inout Work work, inout PathState path,
             inout uint nonfinite, inout uint finished) {
    if (ends && work.edgeRays <= 1u) work.edgeRays = 0u;
}

void endWork(uint invocation, Work work, uint finished, uint scattered, uint shadow, uint nonfinite) {
    if (invocation >= launch.runs) return;
    uint cost = work.begun + scattered + shadow;
#ifdef RT_TIME
    cost = cost > 0u ? clock2x32ARB().x - work.start : 0u; // the paths must have been traced
#endif
    launch.values.at[invocation] = float(cost) / float(launch.samples);
}
