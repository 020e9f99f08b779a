// How the path of a sample and those of its edge rays share what they count, see EdgeRays.h: the path leaves emission in
// sight and behind mirrors and glass to the rays; at the first glossy mirror the rays sample the light that it reflects.
#ifndef RT_SHARED_EDGE_RAY_PATHS_H
#define RT_SHARED_EDGE_RAY_PATHS_H
#include "Common/Shared/Path/Vertex.h"

RT_SHARED_BEGIN

RT_FN bool isBehindGlossyHit(Features features, RT_IN(PathState) s) {
    return has(features, kMethodEdgeRays) && has(features, kFeatureFuzz) && s.emission == kEmissionApartBehindGlossy;
}

// Whether emission that the path finds is counted by its sample's edge rays.
RT_FN bool isCountedApart(Features features, RT_IN(PathState) s) {
    return has(features, kMethodEdgeRays) && (s.emission == kEmissionApart || isBehindGlossyHit(features, s));
}

RT_FN bool isEdgeRay(Features features, RT_IN(PathState) s) {
    return has(features, kMethodEdgeRays) && s.emission == kEmissionOfEdgeRay;
}

// Whether edge rays that reach v take a sample of the light that it reflects.
RT_FN bool splitsGlossyHit(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v) {
    return has(features, kMethodEdgeRays) && params.lightSampling >= kSampleMis && v.inMedium == 0u &&
           isMetal(features, v.bsdf) && isBlurredMirror(features, v.bsdf);
}

// Whether that light is left to edge rays by the path, which has reached v.
RT_FN bool leavesGlossyHit(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v, RT_IN(PathState) s) {
    return has(features, kMethodEdgeRays) && s.emission == kEmissionApart && splitsGlossyHit(features, params, v);
}

// Whether an edge ray has reached the vertex it was for. Rays that sample the light of a glossy mirror go on to the next.
RT_FN bool endsEdgeRay(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v, RT_IN(PathState) s) {
    return isEdgeRay(features, s) && !isDelta(features, v.bsdf) && !splitsGlossyHit(features, params, v);
}

// How emission counts behind v: what edge rays count, they count behind mirrors and glass, too, and behind the first
// glossy mirror.
RT_FN uint emissionBehind(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v, RT_IN(PathState) s) {
    if (!has(features, kMethodEdgeRays) || v.inMedium != 0u) return kEmissionWeighed;
    if (leavesGlossyHit(features, params, v, s)) return kEmissionApartBehindGlossy;
    bool isApart = s.emission == kEmissionApart || s.emission == kEmissionOfEdgeRay;
    return isApart && isDelta(features, v.bsdf) ? s.emission : kEmissionWeighed;
}

RT_SHARED_END

#endif
