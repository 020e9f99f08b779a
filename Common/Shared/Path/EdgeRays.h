// Camera rays that are split where the edge of a light crosses a pixel (LightEdges.h). In sight a light adds all of its
// radiance to a sample or nothing, and against that noise only camera rays help, a small part of what a path costs. So
// there RenderParams::edgeRays rays of the sample's own tell what is emitted at the first vertex and behind mirrors and
// glass, by their mean, and the path counts what comes after it. Splitting: Arvo & Kirk, "Particle Transport and Image
// Synthesis", 1990.
#ifndef RT_SHARED_EDGE_RAYS_H
#define RT_SHARED_EDGE_RAYS_H
#include "Common/Shared/Path/PathStep.h"

RT_SHARED_BEGIN

const uint kEdgeKey = 0xed6e5a1du; // keeps the rays' numbers apart from those of paths

// Of edge ray i of the sample that s is the sampler of. The rays of all samples of the pixel are stratified together,
// and independent of the paths; beyond 2^32 rays of a pixel they begin again.
RT_FN Sampler edgeSampler(RT_IN(RenderParams) params, RT_IN(Sampler) s, uint i) {
    Sampler r = s;
    r.key = s.key ^ kEdgeKey;
    r.index = s.index * params.edgeRays + i;
    return r;
}

// The path of an edge ray, which ends at its first vertex that is no mirror and no glass. `radiance` is what the sample
// has brought before.
RT_FN PathState startEdgeRay(RT_IN(RenderParams) params, RT_IN(Ray) ray, vec3 radiance) {
    PathState s = startPath(ray);
    s.throughput = vec3(1.0f / float(params.edgeRays));
    s.radiance = radiance;
    s.pdf = kEdgeRay;
    s.reuse = kReuseNone;
    return s;
}

RT_SHARED_END

#endif
