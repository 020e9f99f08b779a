// Parallelograms and triangles by projected solid angle, the solid angle weighed by the cosine to the receiver's
// normal: an unoccluded diffuse receiver then sees no variance. What is below its horizon is cut off.
//
// The azimuth cdf is known in closed form and inverted by iteration (Peters, "BRDF Importance Sampling for Polygonal
// Lights", SIGGRAPH 2021). What lies between two slices of a sector is bounded by two arcs of great circles, since the
// slices themselves point to the zenith; Lambert's formula makes its projected solid angle a difference of two terms,
// an arc's length times the cosine of its plane to the horizon. Of thin and small lights nothing would be left of it in
// single precision: here it is rearranged so that only differences appear that slices know by themselves.
#ifndef RT_SHARED_PROJECTED_POLYGON_H
#define RT_SHARED_PROJECTED_POLYGON_H
#include "Common/Shared/Light/Projected/ProjectedOutline.h"

RT_SHARED_BEGIN

struct ProjectedPolygon {
    ProjectedOutline outline;
    float mass[kOutlineSectors]; // projected solid angle of the sectors
    float total;                 // of all; 0: nothing is visible
};

// ---- azimuth cdf ---------------------------------------------------------------------------------------------------

// Sines and cosines of the elevations of both ends of a slice, and differences that may be far smaller.
struct SliceElevations {
    vec2 low; // (cosine, sine)
    vec2 high;
    vec2 closing; // (low.x - high.x, high.y - low.y), none negative
};

RT_FN SliceElevations sliceElevations(RT_IN(OutlineSlice) slice) {
    SliceElevations e;
    vec2 q = max(slice.p + slice.span, vec2(0.0f));
    e.low = slice.p * (1.0f / max(length(slice.p), 1.0e-37f));
    e.high = q * (1.0f / max(length(q), 1.0e-37f));
    // A sum is never smaller than a difference, hence than the root of their product, but for rounding.
    vec2 sum = max(e.low + e.high, vec2(sqrt(slice.rise) + 1.0e-37f));
    e.closing = slice.rise / sum;
    return e;
}

// Sine and cosine of the arc between two directions at elevations e and f (cosine, sine), and the azimuths' difference.
RT_FN vec2 arcBetween(vec2 e, vec2 f, vec2 turn) {
    float across = f.x * turn.x;
    float along = e.y * f.x * turn.y - e.x * f.y;
    return vec2(sqrt(across * across + along * along), e.x * f.x * turn.y + e.y * f.y);
}

// An arc's angle over its sine.
RT_FN float arcRatio(vec2 arc) {
    return arc.x > 0.0f ? arcTan(arc.x, arc.y) / arc.x : 1.0f;
}

// arcRatio of a minus that of b, where `closer` is b's cosine minus a's.
RT_FN float arcRatioDifference(vec2 a, vec2 b, float ratioB, float closer) {
    float x = 1.0f - a.y;
    float y = 1.0f - b.y;
    if (max(x, y) < 0.2f) {
        // arcRatio is 1 + x/3 + 2x^2/15 + 2x^3/35 + 8x^4/315 + 8x^5/693 + 16x^6/3003 ... in x = 1 - cosine.
        float q5 = 0.00532800533f;
        float q4 = 0.0115440115f + x * q5;
        float q3 = 0.0253968254f + x * q4;
        float q2 = 0.0571428571f + x * q3;
        float q1 = 0.133333333f + x * q2;
        return closer * (0.333333333f + x * q1 + y * (q1 + y * (q2 + y * (q3 + y * (q4 + y * q5)))));
    }
    float sines = a.x + b.x;
    return (2.0f * arcTan(closer, sines) - ratioB * closer * (a.y + b.y) / sines) / max(a.x, 1.0e-37f);
}

// Projected solid angle between two slices of a sector, given the sine and cosine of the angle between them.
RT_FN float massBetween(RT_IN(SliceElevations) a, RT_IN(SliceElevations) b, vec2 turn) {
    vec2 low = arcBetween(a.low, b.low, turn);
    vec2 high = arcBetween(a.high, b.high, turn);
    // Differences, low minus high, of the products of both slices' cosines, and high minus low of the sines.
    float cosines = a.closing.x * b.low.x + a.high.x * b.closing.x;
    float sines = a.closing.y * b.high.y + a.low.y * b.closing.y;
    float ratios = arcRatioDifference(low, high, arcRatio(high), sines - cosines * turn.y);
    return max(0.5f * turn.x * (arcRatio(low) * cosines + ratios * a.high.x * b.high.x), 0.0f);
}

// ---- around the zenith ---------------------------------------------------------------------------------------------

// The angle between two points as seen by the receiver, and the cosine of the plane through both and it to the horizon.
RT_FN vec2 edgeArc(vec3 p, vec3 q) {
    vec3 across = cross(p, q - p);
    float sine = length(across);
    return vec2(arcTan(sine, dot(p, q)), abs(across.z) / max(sine, 1.0e-37f));
}

// Azimuth, as the sine and cosine of the angle from p, up to which the edge from p to q has a share of its projected
// solid angle, that is, of its arc.
RT_FN vec2 turnAlongEdge(vec3 p, vec3 q, float share) {
    float angle = edgeArc(p, q).x * (0.5f * kInvPi);
    float toP = sinCos2Pi((1.0f - share) * angle).x / max(length(p), 1.0e-37f);
    float toQ = sinCos2Pi(share * angle).x / max(length(q), 1.0e-37f);
    vec2 d = horizontal(p) * toP + horizontal(q) * toQ;
    vec2 turn = vec2(max(cross2(horizontal(p), d), 0.0f), dot(horizontal(p), d));
    float scale = length(turn);
    return scale > 0.0f ? turn * (1.0f / scale) : vec2(0.0f, 1.0f);
}

// ---- sampling ------------------------------------------------------------------------------------------------------

const uint kAzimuthIterations = 16u;     // two or three are usual
const float kAzimuthTolerance = 2.5e-7f; // of the number that is inverted, at first: numbers come in steps of 6e-8

RT_FN vec2 turnBy(float angle) {
    return sinCos2Pi(min(angle * (0.5f * kInvPi), 1.0f));
}

RT_FN void measureCentralSectors(RT_INOUT(ProjectedPolygon) polygon) {
    for (uint i = 0u; i < polygon.outline.sectors; i++) {
        uvec4 vertex = polygon.outline.sector[i];
        vec2 arc = edgeArc(outlinePoint(polygon.outline, polygon.outline.uv[vertex.x]),
                           outlinePoint(polygon.outline, polygon.outline.uv[vertex.y]));
        polygon.mass[i] = 0.5f * arc.x * arc.y;
        polygon.total += polygon.mass[i];
    }
}

RT_FN void measureSectors(RT_INOUT(ProjectedPolygon) polygon) {
    OutlineSector sector;
    SliceElevations start;
    vec2 turn = vec2(0.0f, 1.0f);
    for (uint i = 0u; i <= polygon.outline.sectors; i++) {
        // A sector ends with the first slice of the next one, which is exact also where an edge lies in it.
        vec2 at = turn;
        if (i < polygon.outline.sectors) {
            sector = outlineSector(polygon.outline, i);
            at = vec2(0.0f, 1.0f);
        }
        SliceElevations slice = sliceElevations(outlineSlice(polygon.outline, sector, at));
        if (i > 0u) {
            polygon.mass[i - 1u] = massBetween(start, slice, turn);
            polygon.total += polygon.mass[i - 1u];
        }
        start = slice;
        turn = turnBy(sector.angle);
    }
}

// `corner` relative to the receiver, edges of the light (a triangle is half of the parallelogram), unit normals of the
// light's plane and of the receiver.
RT_FN ProjectedPolygon makeProjectedPolygon(vec3 corner, vec3 edgeU, vec3 edgeV, vec3 plane, bool triangle,
                                            vec3 normal) {
    ProjectedPolygon polygon;
    polygon.outline = makeProjectedOutline(corner, edgeU, edgeV, plane, triangle, normal);
    polygon.total = 0.0f;
    if (polygon.outline.central) {
        measureCentralSectors(polygon);
    } else if (polygon.outline.sectors > 0u) {
        measureSectors(polygon);
    }
    if (!(polygon.total > 1.0e-30f)) polygon.total = 0.0f; // so that densities stay finite
    return polygon;
}

// The slice before which a sector has a share of its projected solid angle `mass`: Newton's method, guarded by
// bisection. In thin lights rounding is coarser than numbers are, so each step is content with half the precision of
// the one before.
RT_FN OutlineSlice findSlice(RT_IN(ProjectedOutline) outline, RT_IN(OutlineSector) sector, float share, float mass,
                             float total) {
    OutlineSlice slice = outlineSlice(outline, sector, vec2(0.0f, 1.0f));
    SliceElevations start = sliceElevations(slice);
    float tolerance = kAzimuthTolerance * total;
    float low = 0.0f;
    float high = sector.angle;
    // To begin with, slices are taken to grow at a constant rate.
    float lastRise = max(4.0f * mass / max(sector.angle, 1.0e-37f) - slice.rise, 0.0f);
    float angle = high * invertLinear(slice.rise, lastRise, 0.5f * share * (slice.rise + lastRise));
    for (uint i = 0u; i < kAzimuthIterations; i++) {
        vec2 turn = turnBy(angle);
        slice = outlineSlice(outline, sector, turn);
        float beyond = massBetween(start, sliceElevations(slice), turn) - share * mass;
        if (abs(beyond) <= tolerance) break;
        tolerance *= 2.0f;
        low = beyond < 0.0f ? angle : low;
        high = beyond < 0.0f ? high : angle;
        float next = angle - 2.0f * beyond / max(slice.rise, 1.0e-37f);
        angle = next > low && next < high ? next : 0.5f * (low + high);
    }
    return slice;
}

// Fraction of the slice's way up at which `part` of its projected solid angle lies below.
RT_FN float slicePlace(RT_IN(OutlineSlice) s, float part) {
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

// A point of what is visible, as (u, v) on the light; its density on the unit disk of the tangent plane is 1 / total.
RT_FN vec2 sampleProjectedPolygon(RT_IN(ProjectedPolygon) polygon, vec2 u) {
    float rest = u.x * polygon.total;
    uint i = 0u;
    while (i + 1u < polygon.outline.sectors && rest >= polygon.mass[i]) rest -= polygon.mass[i++];
    float share = min(rest / max(polygon.mass[i], 1.0e-37f), 1.0f);
    OutlineSector sector = outlineSector(polygon.outline, i);
    OutlineSlice slice;
    if (polygon.outline.central) {
        uvec4 vertex = polygon.outline.sector[i];
        vec2 turn = turnAlongEdge(outlinePoint(polygon.outline, polygon.outline.uv[vertex.x]),
                                  outlinePoint(polygon.outline, polygon.outline.uv[vertex.y]), share);
        slice = outlineSlice(polygon.outline, sector, turn);
    } else {
        slice = findSlice(polygon.outline, sector, share, polygon.mass[i], polygon.total);
    }
    vec2 uv = clamp(slice.uv + slice.uvSpan * slicePlace(slice, u.y), vec2(0.0f), vec2(1.0f));
    if (polygon.outline.triangle) uv.y = min(uv.y, 1.0f - uv.x);
    return uv;
}

RT_SHARED_END

#endif
