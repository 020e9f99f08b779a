// Camera rays that are split where the edge of a light crosses a pixel (Silhouettes.h). In sight a light adds all of its
// radiance to a sample or nothing, and against that noise only camera rays help, a small part of what a path costs. So
// there RenderParams::edgeRays rays of the sample's own tell what is emitted at the first vertex and behind mirrors and
// glass, by their mean, and the path counts what comes after it. Where that vertex is a blurred mirror, they tell the
// light that it reflects as well. They are spread over the part of the pixel that holds the light; a path through the
// rest of it counts everything itself. Splitting: Arvo & Kirk, "Particle Transport and Image Synthesis", 1990.
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

// A part of a pixel, whose sides have the length 1; x to the right and y down.
struct PixelPart {
    vec2 begin;
    vec2 size;
};

// From LightEdges::parts, of a pixel that has one.
RT_FN PixelPart pixelPart(uint packed) {
    const float kStep = 1.0f / 255.0f;
    PixelPart part;
    part.begin = vec2(float(packed & 255u), float(packed >> 8u & 255u)) * kStep;
    part.size = vec2(float(packed >> 16u & 255u), float(packed >> 24u)) * kStep - part.begin;
    return part;
}

RT_FN bool isInPart(RT_IN(PixelPart) part, vec2 place) {
    vec2 u = place - part.begin;
    return u.x >= 0.0f && u.y >= 0.0f && u.x < part.size.x && u.y < part.size.y;
}

RT_FN vec2 placeInPart(RT_IN(PixelPart) part, vec2 u) {
    return part.begin + part.size * u;
}

// Of one of a sample's edge rays in this part.
RT_FN float edgeWeight(RT_IN(RenderParams) params, RT_IN(PixelPart) part) {
    return part.size.x * part.size.y / float(params.edgeRays);
}

// The path of an edge ray, which ends at its first vertex that is no mirror and no glass, or at the one behind a
// blurred mirror. `radiance` is what the sample has brought before.
RT_FN PathState startEdgeRay(RT_IN(RenderParams) params, RT_IN(PixelPart) part, RT_IN(Ray) ray, vec3 radiance) {
    PathState s = startPath(ray);
    s.throughput = vec3(edgeWeight(params, part));
    s.radiance = radiance;
    s.pdf = kEdgeRay;
    s.reuse = kReuseNone;
    return s;
}

RT_SHARED_END

#endif
