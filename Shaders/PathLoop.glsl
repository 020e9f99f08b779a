// Paths. Every invocation takes one sample after the other and starts its path in the very step in which the last one
// ended: no lane of a group waits for the longest path, and neighbours are at work at a time, whose rays are alike. A
// vertex of a path goes through the stages of Common/Shared/Path/PathStep.h once its ray has been traced.
//
// Where samples come from and where they go, Work says: FilmWork.glsl of a film, PixelWork.glsl of heat maps.
//
// The includer provides traceRay() and, both found by measuring, see docs/measurements/gpu-engine.md:
//   kRaysPerStep   2: a step traces the path's ray and, if it leaves one, the shadow's; 1: whichever is next
//   tracesApart()  whether the program has two places that trace, one for each of the two rays of a step
#if defined(RT_RAYS) || defined(RT_TIME)
#include "PixelWork.glsl"
#else
#include "FilmWork.glsl"
#endif
#include "TraceStep.glsl"

// Of a sample that has been taken, or its next edge ray.
PathState beginPath(RenderParams params, Work work, bool isEdgeRay, vec3 radiance) {
    CameraSamples u = cameraSamples(kFeatures, work.smp);
    CameraRole role = wholePixel();
    if (hasEdges() && work.edgeRays != 0u)
        role = roleInPart(params, pixelPart(packedPart(work.pixel)), isEdgeRay, u.pixel);
    PathState path = startInRole(cameraRay(kFeatures, params, constants.camera, work.pixel, u), role);
    if (isEdgeRay) path.radiance = radiance;
    return path;
}

// When its own path is to begin: tells whether edge rays follow, and counts them.
void expectEdgeRays(uint invocation, inout Work work) {
    uint rays = edgeRays(work.pixel);
    if (rays == 0u) return;
    work.edgeRays = rays + 1u;
    countEdgeRays(invocation, work, rays);
}

void nextEdgeRay(RenderParams params, inout Work work) {
    work.edgeRays--;
    if (work.edgeRays == params.edgeRays)
        work.smp = edgeSampler(params, work.smp, 0u);
    else
        work.smp.index++;
}

// Takes the path a step further, given what its ray hits. False: it has ended.
bool stepAlong(SceneRef scene, RenderParams params, Work work, Hit hit, inout PathState path, inout DirectLight direct,
               inout TechniqueStep step) {
    uint before = path.reuse;
    bool goesOn = stepPath(kFeatures, scene, params, work.smp, hit, path, direct, step);
    if (reusesPaths(kFeatures, params) && path.reuse != before) keepVertex(work, path, step.part);
    return goesOn;
}

// Traces a ray of the step and deals with what it meets: that of the path, or when `checking` that of the light at its
// vertex. No function, as drivers are slower with all that it would be given and give back.
#define RT_TRACE(checking)                                                            \
    {                                                                                 \
        Hit hit = traceStep(work.smp, path, direct, step, checking, nonfinite);       \
        if (checking) {                                                               \
            endChecked(scene, hit, path, direct, step);                               \
            shadow++;                                                                 \
        } else {                                                                      \
            goesOn = stepAlong(scene, params, work, hit, path, direct, step);         \
            scattered += uint(goesOn);                                                \
        }                                                                             \
    }

// What an invocation does.
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
        if (isOver && mayLeave(work)) break;
        if (tracesApart()) {
            RT_TRACE(false)
            while (isChecking(direct, step)) {
                RT_TRACE(true)
                if (!has(kFeatures, kMethodConnections)) break;
            }
        } else {
            for (uint i = 0u; i < kRaysPerStep; i++) {
                bool checking = isChecking(direct, step);
                if (i > 0u && !checking) break;
                RT_TRACE(checking)
            }
        }
        begins = !goesOn && !isChecking(direct, step);
        endPath(begins, invocation, params, work, path, nonfinite, finished);
    }
    if (!isSpent) leavePath(work, path, direct, step, goesOn);
    endWork(invocation, work, finished, scattered, shadow, nonfinite);
}
