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
RT_FN float slicePlace(RT_IN(FanSlice) s, float part) {
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
RT_FN float fanDensity(RT_IN(ProjectedFan) fan, float total, float fit, float mass) {
    float own = mass * fan.height;
    float density = fit / max(total, 1.0e-37f) / max(own, 1.0e-37f);
    return own > 1.0e-37f && density < 1.0e30f ? density : 0.0f;
}

// A piece of the fan by a number in [0,1) or, if that is negative, the one at an azimuth.
RT_FN FanPick pickFan(RT_IN(ProjectedFan) fan, float number, vec2 azimuth) {
    FanPick pick;
    pick.byNumber = number >= 0.0f;
    pick.azimuth = azimuth;
    pick.least = 1.0e30f;
    pick.turn = 0.0f;
    pick.total = 0.0f;
    pick.pieces = 0u;
    pick.sectors = 0u;
    pick.piece.form = kFitLinear;
    pick.piece.a = 0.0f;
    pick.piece.b = 0.0f;
    pick.piece.start = 0.0f;
    pick.piece.width = 0.0f;
    if (fan.around) {
        pickAround(fan, pick, number);
    } else if (fan.count > 1u) {
        pickSlice(fan, pick, number);
    }
    return pick;
}

// Density on the unit disk at the azimuth of a pick, whose slice has the mass `mass`.
RT_FN float pickDensity(RT_IN(ProjectedFan) fan, RT_IN(FanPick) pick, float mass) {
    float place = clamp((pick.turn - pick.piece.start) / max(pick.piece.width, 1.0e-37f), 0.0f, 1.0f);
    return fanDensity(fan, pick.total, fan.around ? mass : fitValue(pick.piece, place), mass);
}

RT_FN FanSample sampleProjectedFan(RT_IN(ProjectedFan) fan, vec2 u) {
    FanSample result;
    result.density = 0.0f;
    result.uv = vec2(0.0f, 0.0f);
    FanPick pick = pickFan(fan, u.x, vec2(0.0f, 0.0f));
    if (!(pick.total > 0.0f)) return result;
    FanSlice slice = fanSlice(fan, pick.sector, pick.turn);
    if (!(slice.mass > 0.0f)) return result;
    vec2 uv = slice.uv + slice.uvSpan * slicePlace(slice, u.y);
    uv = vec2(clamp(uv.x, 0.0f, 1.0f), clamp(uv.y, 0.0f, 1.0f));
    if (fan.triangle) uv.y = min(uv.y, 1.0f - uv.x);
    result.uv = uv;
    result.density = pickDensity(fan, pick, slice.mass);
    return result;
}

// Density on the unit disk at a direction that meets the light; `normal` must be that of makeProjectedFan.
RT_FN float projectedFanDensity(RT_IN(ProjectedFan) fan, vec3 wi, vec3 normal) {
    Frame f = makeFrame(normal);
    FanPick pick = pickFan(fan, -1.0f, vec2(dot(wi, f.tangent), dot(wi, f.bitangent)));
    if (!(pick.total > 0.0f)) return 0.0f;
    float mass = fan.around ? 1.0f : fanSlice(fan, pick.sector, pick.turn).mass;
    return pickDensity(fan, pick, mass);
}

RT_SHARED_END

#endif
