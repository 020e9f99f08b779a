// Camera rays that are split where the edge of a light crosses a pixel (Silhouettes.h). In sight a light adds all of its
// radiance to a sample or nothing, and against that noise only camera rays help, a small part of what a path costs. So
// there RenderParams::edgeRays rays of the sample's own tell what is emitted at the first vertex and behind mirrors and
// glass, by their mean, and the path counts what comes after it. Where that vertex is a glossy mirror, they tell the
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

// From Silhouettes::parts, of a pixel that has one.
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

// How the path of a camera ray begins: what it weighs, and how emission counts that it finds in sight.
struct CameraRole {
    float weight;
    uint emission;
};

// Where there are no edge rays.
RT_FN CameraRole wholePixel() {
    CameraRole role;
    role.weight = 1.0f;
    role.emission = kEmissionWeighed;
    return role;
}

// In a pixel with edge rays in this part: of one of these, whose place in the pixel is moved there, or of the sample's
// own ray, which leaves to them what it finds there.
RT_FN CameraRole roleInPart(RT_IN(RenderParams) params, RT_IN(PixelPart) part, bool isEdgeRay, RT_INOUT(vec2) place) {
    CameraRole role = wholePixel();
    if (isEdgeRay) {
        place = placeInPart(part, place);
        role.weight = edgeWeight(params, part);
        role.emission = kEmissionOfEdgeRay;
    } else if (isInPart(part, place)) {
        role.emission = kEmissionApart;
    }
    return role;
}

// That of an edge ray ends at its first vertex that is no mirror and no glass, or at the one behind a glossy mirror.
RT_FN PathState startInRole(RT_IN(Ray) ray, RT_IN(CameraRole) role) {
    PathState s = startPath(ray);
    s.throughput = vec3(role.weight, role.weight, role.weight);
    s.emission = role.emission;
    if (role.emission == kEmissionOfEdgeRay) s.reuse = kReuseNone;
    return s;
}

RT_SHARED_END

#endif
