// Parallelograms and triangles by projected solid angle, the solid angle weighed by the cosine to the receiver's normal: an
// unoccluded diffuse receiver then sees no variance. What is below its horizon is cut off.
#ifndef RT_SHARED_PROJECTED_POLYGON_H
#define RT_SHARED_PROJECTED_POLYGON_H
#include "Common/Shared/Light/Projected/ProjectedFanFit.h"
#include "Common/Shared/Light/Projected/ProjectedQuery.h"

RT_SHARED_BEGIN

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
RT_FN void pickFan(RT_LARGE_INOUT(FanPick, pick) RT_IN(ProjectedFan) fan, float number, vec2 azimuth) {
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
        pickAround(RT_LARGE(pick) fan, number);
    } else if (fan.count > 1u) {
        pickSlice(RT_LARGE(pick) fan, number);
    }
}

// Density on the unit disk at the azimuth of a pick, whose slice has the mass `mass`.
RT_FN float pickDensity(RT_LARGE_IN(FanPick, pick) RT_IN(ProjectedFan) fan, float mass) {
    float place = clamp((pick.turn - pick.piece.start) / max(pick.piece.width, 1.0e-37f), 0.0f, 1.0f);
    return fanDensity(fan, pick.total, fan.around ? mass : fitValue(pick.piece, place), mass);
}

// Draws from the fan by two random numbers, or states the density at a direction that meets the light; the query's normal must
// be that of makeProjectedFan. One function, so that a GPU's compiler has the walk and the slice once for both.
RT_FN FanSample useProjectedFan(RT_LARGE_INOUT(FanPick, pick) RT_IN(ProjectedFan) fan, RT_IN(FanQuery) query) {
    FanSample result;
    result.density = 0.0f;
    result.uv = vec2(0.0f, 0.0f);
    bool draws = query.use == kProjectedDraw;
    Frame f = makeFrame(query.normal);
    vec2 azimuth = vec2(dot(query.given, f.tangent), dot(query.given, f.bitangent));
    pickFan(RT_LARGE(pick) fan, draws ? query.given.x : -1.0f, azimuth);
    if (!(pick.total > 0.0f)) return result;
    if (!draws && fan.around) { // all slices have this density
        result.density = pickDensity(RT_LARGE(pick) fan, 1.0f);
        return result;
    }
    FanSlice slice = fanSlice(fan, pick.sector, pick.turn);
    if (!(slice.mass > 0.0f)) return result;
    result.density = pickDensity(RT_LARGE(pick) fan, slice.mass);
    if (!draws) return result;
    vec2 uv = slice.uv + slice.uvSpan * slicePlace(slice, query.given.y);
    uv = vec2(clamp(uv.x, 0.0f, 1.0f), clamp(uv.y, 0.0f, 1.0f));
    if (fan.triangle) uv.y = min(uv.y, 1.0f - uv.x);
    result.uv = uv;
    return result;
}

RT_CALL FanSample useProjectedPolygon(RT_IN(FanQuery) query) {
    RT_LARGE_LOCAL(FanPick, pick)
    ProjectedFan fan = makeProjectedFan(query.corner, query.edgeU, query.edgeV, query.plane,
                                        query.kind == kLightTriangle, query.normal);
    return useProjectedFan(RT_LARGE(pick) fan, query);
}

RT_SHARED_END

#endif
