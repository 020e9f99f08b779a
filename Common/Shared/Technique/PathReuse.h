// Path reuse: pixels that are neighbours share what their paths bring from the second vertex on.
//
//   camera ---- x1 ------ y1 ---> L1          x  first vertex that is no mirror and no glass
//                 \ ... /                     y  the next one, a place on a diffuse surface
//   camera ---- x2 ------ y2 ---> L2          L  radiance that y sends out, the same to all sides, as its path finds it
//
// Each y of a group of pixels tells each of their x what it receives from there, if nothing is in between. One of them
// has drawn y, but all that see it could have: the balance heuristic weighs by the sum of their densities, so the mean
// stays what it was, and indirect light has the noise of as many paths as the group has pixels.
// Bekaert, Sbert & Halton, "Accelerating Path Tracing by Re-Using Paths", 2002.
#ifndef RT_SHARED_PATH_REUSE_H
#define RT_SHARED_PATH_REUSE_H
#include "Common/Shared/Path/DirectLight.h"
#include "Common/Shared/Path/Vertex.h"
#include "Common/Shared/Technique/Methods.h"

RT_SHARED_BEGIN

// Of the roulette behind y, where throughput begins anew: paths get about as long as those that are not shared.
const float kReuseSurvival = 0.6f;

// Of the vertex that has drawn y, where rounding leaves none.
const float kMinReuseDensity = 1.0e-37f;

RT_FN bool reusesPaths(Features features, RT_IN(RenderParams) params) {
    return uses(features, params, kMethodReuse);
}

RT_FN SharedPart nothingShared() {
    SharedPart part;
    part.prefix = vec3(0.0f, 0.0f, 0.0f);
    part.throughput = vec3(0.0f, 0.0f, 0.0f);
    part.aimed = 0.0f;
    return part;
}

// Follows a path to v, on this surface. Where v is its second vertex, s goes on as the path of what v sends out, and
// `prefix` is what it had brought before.
RT_FN void followReuse(Features features, RT_IN(Surface) surface, RT_IN(Vertex) v, RT_INOUT(PathState) s,
                       RT_INOUT(vec3) prefix) {
    // Where normals are interpolated, how v scatters depends on where it is seen from.
    bool isPlain = scattersEvenly(features, v.bsdf) && surface.shading == surface.normal;
    if (s.reuse == kReuseBefore) {
        bool scatters = maxComponent(s.throughput * v.bsdf.albedo) > 0.0f;
        if (!isDelta(features, v.bsdf)) s.reuse = isPlain && scatters ? kReuseFirst : kReuseNone;
    } else if (s.reuse == kReuseFirst) {
        s.reuse = isPlain ? kReuseSuffix : kReuseEnded;
        if (isPlain) {
            prefix = s.radiance;
            s.radiance = vec3(0.0f, 0.0f, 0.0f);
            s.throughput = vec3(1.0f, 1.0f, 1.0f);
        }
    }
}

// Whether a path that has ended like this shares its first vertex.
RT_FN bool sharesVertex(uint reuse) {
    return reuse == kReuseFirst || reuse == kReuseSuffix || reuse == kReuseEnded;
}

// Density of y to be drawn from x by a diffuse surface, over area, but for what is the same for all x. 0: one is
// behind the other. `n` and `nY` are the normals of the sides that see each other.
RT_FN float reuseDensity(vec3 x, vec3 n, vec3 y, vec3 nY) {
    vec3 d = y - x;
    float squared = dot(d, d);
    float cosine = dot(d, n);
    bool sees = cosine > 0.0f && dot(d, nY) < 0.0f && squared > kMinReuseDensity;
    return sees ? cosine / sqrt(squared) / squared : 0.0f;
}

// From x to y, as far as nothing may be in its way.
RT_FN Ray reuseRay(vec3 x, vec3 y, RT_INOUT(float) tMax) {
    float distance = length(y - x);
    tMax = distance * (1.0f - kShadowMargin);
    Ray ray;
    ray.origin = x;
    ray.direction = (y - x) / distance;
    ray.time = 0.0f;
    return ray;
}

RT_SHARED_END

#endif
