// Parallelograms and triangles by projected solid angle, the solid angle weighed by the cosine to the receiver's normal: an unoccluded diffuse
// receiver then sees no variance. What is below its horizon is cut off.
#ifndef RT_SHARED_PROJECTED_POLYGON_H
#define RT_SHARED_PROJECTED_POLYGON_H
#include "ProjectedFanFit.h"

RT_SHARED_BEGIN

// A point of the light with the density of its direction on the unit disk of the tangent plane.
struct FanSample {
    vec2 uv;
    float density; // 0: nothing is visible
};

// Fraction of the slice's way up at which `part` of its projected solid angle lies below.
RT_FN float fanPlace(RT_IN(FanSlice) s, float part) {
    vec2 q = s.p + s.span;
    float p0 = dot(s.p, s.p);
    float p1 = dot(s.p, s.span);
    float p2 = dot(s.span, s.span);
    float sum0 = 2.0f * s.p.x * s.p.y;
    float sum1 = s.p.x * s.span.y + s.p.y * s.span.x;
    float whole = sum0 + sum1;
    float top = dot(q, q);
    float a = sum1 * top - part * whole * p2;
    float b = sum0 * top - 2.0f * part * whole * p1;
    float c = part * whole * p0;
    float root = sqrt(max(b * b + 4.0f * a * c, 0.0f));
    float place = b >= 0.0f ? 2.0f * c / max(b + root, 1.0e-37f) : (root - b) / (2.0f * max(a, 1.0e-37f));
    return clamp(place, 0.0f, 1.0f);
}

// Density on the unit disk where the fit has the value `fit` and the slice the mass `mass`. What fills less than 1e-30 of
// the disk counts as invisible.
RT_FN float fanDensity(RT_IN(ProjectedFan) fan, float fit, float mass) {
    float own = mass * fan.height;
    float density = fit / max(fan.total, 1.0e-37f) / max(own, 1.0e-37f);
    return own > 1.0e-37f && density < 1.0e30f ? density : 0.0f;
}

RT_FN FanSample sampleProjectedFan(RT_IN(ProjectedFan) fan, vec2 u) {
    FanSample result;
    result.density = 0.0f;
    result.uv = vec2(0.0f, 0.0f);
    if (!(fan.total > 0.0f)) return result;
    float rest = u.x * fan.total;
    uint j = 0u;
    uint k = 0u;
    FitPiece s = fanPiece(fan, 0u, 0u);
    float part = fitMass(s);
    while (rest >= part && !(j + 1u == fan.sectors && k == fan.count[j])) {
        rest -= part;
        k++;
        if (k > fan.count[j]) {
            k = 0u;
            j++;
        }
        s = fanPiece(fan, j, k);
        part = fitMass(s);
    }
    float place = fitPlace(s, min(rest, part));
    FanSlice slice = fanSlice(fan, j, s.start + place * s.width);
    if (!(slice.mass > 0.0f)) return result;
    vec2 uv = slice.uv + slice.uvSpan * fanPlace(slice, u.y);
    uv = vec2(clamp(uv.x, 0.0f, 1.0f), clamp(uv.y, 0.0f, 1.0f));
    if (fan.triangle) uv.y = min(uv.y, 1.0f - uv.x);
    result.uv = uv;
    result.density = fanDensity(fan, fitValue(s, place), slice.mass);
    return result;
}

// Density on the unit disk at a direction that meets the light; `local` in any frame about the normal is not enough:
// `normal` must be that of makeProjectedFan.
RT_FN float projectedFanDensity(RT_IN(ProjectedFan) fan, vec3 wi, vec3 normal) {
    if (!(fan.total > 0.0f)) return 0.0f;
    Frame f = makeFrame(normal);
    vec2 d = vec2(dot(wi, f.tangent), dot(wi, f.bitangent));
    // The sector that the azimuth is in, or is out of by the least.
    uint j = 0u;
    float turn = 0.0f;
    float least = 1.0e30f;
    for (uint i = 0u; i < fan.sectors; i++) {
        float angle = arcTan(cross2(fan.start[i], d), dot(fan.start[i], d));
        float beyond = max(-angle, angle - fan.angle[i]);
        if (beyond < least) {
            least = beyond;
            j = i;
            turn = clamp(angle, 0.0f, fan.angle[i]);
        }
    }
    uint k = 0u;
    while (k < fan.count[j] && fan.turn[fan.first[j] + k] < turn) k++;
    FitPiece s = fanPiece(fan, j, k);
    float place = clamp((turn - s.start) / max(s.width, 1.0e-37f), 0.0f, 1.0f);
    float mass = fanSlice(fan, j, turn).mass;
    return fanDensity(fan, fitValue(s, place), mass);
}

RT_SHARED_END

#endif
