// A disk as seen from a point: what directions it fills is a spherical ellipse (Guillen, Urena, King, Fajardo,
// Georgiev, Lopez-Moreno and Jarabo, "Area-Preserving Parameterizations for Spherical Ellipses", 2017). This is the
// radial one of the paper's maps: an azimuth, then the angle from the middle.
//
// With half axes of sines a, b and cosines A, B the outline is (a cos x, b sin x, P(x)), P = sqrt(A^2 cos^2 x + B^2
// sin^2 x): unit vectors, since A^2 = 1 - a^2. Between the azimuths of x and x + dx lies the solid angle
//     (1 - P) d(azimuth) = a b / (1 + P) dx,
// which varies by a factor of two at most, however long the ellipse is. So x is drawn from a density that is linear
// between some of its values, and the angle from the middle uniformly in its cosine: nearly uniform in solid angle, and
// the density of what is drawn is known exactly.
//
// For a receiver both follow its cosine. Along each way from the middle to the rim the density is linear between the
// cosines at three places of what is above the horizon, and an azimuth weighs as much as the integral of that: where
// all ways meet, all have the same density, so that neighbours in the square keep about the same contribution, and
// strata what they gain.
#ifndef RT_SHARED_SPHERICAL_ELLIPSE_H
#define RT_SHARED_SPHERICAL_ELLIPSE_H
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

struct SphericalEllipse {
    vec3 x; // directions of the half axes, and of the middle
    vec3 y;
    vec3 z;
    vec2 sines; // of the half axes along x and y
    vec2 cosines;
    // Of the disk, in coordinates in which the point is the origin: along `aside` and across it in the disk's plane,
    // which is at `height`.
    vec3 aside;
    vec3 down;    // unit, towards the plane
    float offset; // of the disk's centre along `aside`
    float height;
    float radius;
    float hole; // radius over that of the disk
    vec2 tilt;  // of the middle: its components along `aside` and `down`
};

// Seen from the origin. 2 a and 2 A are the angle between the nearest and the farthest point of the rim, at distances n
// and f. With k = n f, g = offset^2 + height^2 - radius^2 and s = offset^2 + height^2 + radius^2, tan 2a = 2 radius
// height / g, and the largest sine across is b^2 = 2 radius^2 / (s + k). Sums and products in place of differences.
RT_FN SphericalEllipse makeSphericalEllipse(vec3 toCenter, vec3 normal, float radius, float hole) {
    SphericalEllipse e;
    float side = dot(toCenter, normal);
    e.down = side < 0.0f ? -normal : normal;
    e.height = abs(side);
    e.radius = radius;
    e.hole = hole;
    vec3 lateral = toCenter - normal * side;
    e.offset = length(lateral);
    e.aside = e.offset > 1.0e-6f * radius ? lateral * (1.0f / e.offset) : makeFrame(normal).tangent;
    vec2 nearest = vec2(e.offset - radius, e.height);
    vec2 farthest = vec2(e.offset + radius, e.height);
    float n = length(nearest);
    float f = length(farthest);
    float k = n * f;
    float g = nearest.x * farthest.x + e.height * e.height;
    float product = 2.0f * radius * e.height;
    float sum = g >= 0.0f ? k + g : product * (product / (k - g));
    float rest = g >= 0.0f ? product * (product / (k + g)) : k - g;
    float s = e.offset * e.offset + e.height * e.height + radius * radius + k;
    e.sines = vec2(sqrt(0.5f * rest / k), radius * sqrt(2.0f / s));
    e.cosines = vec2(sqrt(0.5f * sum / k), sqrt(sum / s));
    vec2 a = nearest * (1.0f / n);
    vec2 b = farthest * (1.0f / f);
    vec2 apart = b - a;
    e.tilt = normalize(g >= 0.0f ? a + b : vec2(-apart.y, apart.x));
    e.z = e.aside * e.tilt.x + e.down * e.tilt.y;
    e.x = e.aside * e.tilt.y - e.down * e.tilt.x;
    e.y = cross(e.z, e.x);
    return e;
}

// ---- holes ---------------------------------------------------------------------------------------------------------

// What the hole takes of the way from the middle to the rim, both ends as parts of the rim's 1 - cosine; empty: (1, 1).
RT_FN vec2 holeOnWay(RT_IN(SphericalEllipse) e, vec2 cs, float rim) {
    if (e.hole == 0.0f) return vec2(1.0f, 1.0f);
    vec2 onRim = vec2(cs.x * e.sines.x, cs.y * e.sines.y);
    float sine = length(onRim);
    // The way is the line in the disk's plane from the point that the middle is the direction of to the rim.
    float toMiddle = e.height / e.tilt.y;
    float toRim = e.height / (e.tilt.y * rim - e.tilt.x * onRim.x);
    vec2 from = vec2(toMiddle * e.tilt.x - e.offset, 0.0f);
    vec2 way = vec2(toRim * (e.tilt.x * rim + e.tilt.y * onRim.x) - e.offset, toRim * onRim.y) - from;
    float inverse = 1.0f / dot(way, way);
    float nearest = -dot(from, way) * inverse;
    vec2 foot = from + way * nearest;
    float squaredHalf = (square(e.hole * e.radius) - dot(foot, foot)) * inverse;
    if (!(squaredHalf > 0.0f)) return vec2(1.0f, 1.0f);
    float halfChord = sqrt(squaredHalf);
    vec2 ends = clamp(vec2(nearest - halfChord, nearest + halfChord), vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
    vec2 across = ends * (toRim * sine);
    vec2 along = ends * (toRim * rim - toMiddle) + toMiddle;
    vec2 lengths = vec2(length(vec2(across.x, along.x)), length(vec2(across.y, along.y)));
    vec2 versines = across * across / (lengths * (lengths + along)) * ((1.0f + rim) / (sine * sine));
    return clamp(versines, vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
}

// ---- density along the way from the middle to the rim --------------------------------------------------------------

const float kEllipseBend = 0.16f;     // of the span, where the density along a way may change its slope
const float kUnseenDensity = 1.0e-6f; // so that what is seen between steps alone is found, by all of them

struct EllipseWay {
    float rim;         // cosine of the angle from the middle to the rim
    float squaredSine; // of that angle
    // What the receiver may see of the way, from the middle, as parts of the rim's 1 - cosine, and the density, linear
    // from one to the next, at the span's ends and its bend. It is not normalized.
    vec2 span;
    vec3 density;
    vec2 beforeHole; // its integral up to where a hole begins and where it ends
    float integral;  // without the hole
};

// Integral of the density up to a part of the way.
RT_FN float integralTo(RT_IN(EllipseWay) way, float part) {
    float size = way.span.y - way.span.x;
    float x = clamp((part - way.span.x) / size, 0.0f, 1.0f);
    float first = min(x * (1.0f / kEllipseBend), 1.0f);
    float second = max(x - kEllipseBend, 0.0f) * (1.0f / (1.0f - kEllipseBend));
    float upToBend = kEllipseBend * first * mix(way.density.x, way.density.y, 0.5f * first);
    float fromBend = (1.0f - kEllipseBend) * second * mix(way.density.y, way.density.z, 0.5f * second);
    return size * (upToBend + fromBend);
}

// Where that is `integral`.
RT_FN float partAt(RT_IN(EllipseWay) way, float integral) {
    float size = way.span.y - way.span.x;
    float left = integral / size;
    float upToBend = 0.5f * kEllipseBend * (way.density.x + way.density.y);
    bool isFirst = left < upToBend;
    float begin = isFirst ? 0.0f : kEllipseBend;
    float extent = isFirst ? kEllipseBend : 1.0f - kEllipseBend;
    left = (isFirst ? left : left - upToBend) / extent;
    vec2 ends = select(isFirst, vec2(way.density.x, way.density.y), vec2(way.density.y, way.density.z));
    return way.span.x + size * (begin + extent * invertLinear(ends.x, ends.y, left));
}

RT_FN float densityAt(RT_IN(EllipseWay) way, float part) {
    const float kRounding = 1.0e-4f; // of what the receiver may see
    float x = (part - way.span.x) / (way.span.y - way.span.x);
    if (!(abs(x - 0.5f) <= 0.5f + kRounding)) return 0.0f;
    float first = clamp(x * (1.0f / kEllipseBend), 0.0f, 1.0f);
    float second = clamp((x - kEllipseBend) * (1.0f / (1.0f - kEllipseBend)), 0.0f, 1.0f);
    return x < kEllipseBend ? mix(way.density.x, way.density.y, first) : mix(way.density.y, way.density.z, second);
}

// The receiver's cosine, lateral sin + normal.z cos, of the angle that is at a part of the way, or 0 below the horizon.
RT_FN float cosineAt(float height, float lateral, float versine) {
    return max(height * (1.0f - versine) + lateral * sqrt(versine * (2.0f - versine)), 0.0f);
}

// At the azimuth of (cos x, sin x). `normal`: the receiver's, in the frame of the ellipse. Its cosine is what the
// density follows, from the horizon on; without a receiver, with a normal of zero, it is uniform.
RT_FN EllipseWay ellipseWay(RT_IN(SphericalEllipse) e, vec3 normal, vec2 cs) {
    EllipseWay way;
    way.rim = sqrt(square(e.cosines.x * cs.x) + square(e.cosines.y * cs.y));
    vec2 onRim = vec2(cs.x * e.sines.x, cs.y * e.sines.y);
    way.squaredSine = dot(onRim, onRim);
    way.span = vec2(0.0f, 1.0f);
    way.density = vec3(1.0f);
    vec2 hole = holeOnWay(e, cs, way.rim);
    if (dot(normal, normal) > 0.0f) {
        float versine = way.squaredSine / (1.0f + way.rim); // of the rim
        float sine = sqrt(way.squaredSine);
        float lateral = (normal.x * onRim.x + normal.y * onRim.y) / sine;
        bool isMiddleAbove = normal.z > 0.0f;
        bool isRimAbove = normal.z * way.rim + lateral * sine > 0.0f;
        if (isMiddleAbove != isRimAbove) {
            float whole = sqrt(normal.z * normal.z + lateral * lateral);
            float horizon = normal.z * normal.z / (whole * (whole + abs(lateral)) * versine);
            way.span = isMiddleAbove ? vec2(0.0f, min(horizon, 1.0f)) : vec2(min(horizon, 1.0f), 1.0f);
        }
        if (hole.x <= way.span.x) way.span.x = max(way.span.x, hole.y);
        if (hole.y >= way.span.y) way.span.y = min(way.span.y, hole.x);
        float size = way.span.y - way.span.x;
        bool isSeen = (isMiddleAbove || isRimAbove) && size > 1.0e-6f;
        if (!isSeen) way.span = vec2(0.0f, 1.0f);
        vec3 parts = vec3(way.span.x, way.span.x + kEllipseBend * size, way.span.y) * versine;
        way.density = vec3(cosineAt(normal.z, lateral, parts.x), cosineAt(normal.z, lateral, parts.y),
                           cosineAt(normal.z, lateral, parts.z));
        // Not so low at the horizon that what glossy surfaces reflect from there weighs much more than the rest.
        float minimum = max(0.05f * maxComponent(way.density), kUnseenDensity);
        way.density = isSeen ? max(way.density, vec3(minimum)) : vec3(kUnseenDensity);
    }
    float entire = integralTo(way, 1.0f);
    way.beforeHole = vec2(entire);
    if (hole.x < hole.y) way.beforeHole = vec2(integralTo(way, hole.x), integralTo(way, hole.y));
    way.integral = max(entire - (way.beforeHole.y - way.beforeHole.x), 1.0e-3f * entire);
    return way;
}

// ---- density of the azimuth ----------------------------------------------------------------------------------------

const uint kEllipseSteps = 16u; // around the ellipse

RT_FN float ellipseWeight(RT_IN(SphericalEllipse) e, vec3 normal, uint step) {
    vec2 sc = sinCos2Pi(float(step & (kEllipseSteps - 1u)) * (1.0f / float(kEllipseSteps)));
    EllipseWay way = ellipseWay(e, normal, vec2(sc.y, sc.x));
    return way.integral / (1.0f + way.rim);
}

// Sum of the weights of all steps: the integral is that times the length of a step.
RT_FN float ellipseTotal(RT_IN(SphericalEllipse) e, vec3 normal) {
    float total = 0.0f;
    for (uint i = 0u; i < kEllipseSteps; i++) total += ellipseWeight(e, normal, i);
    return total;
}

// Per steradian, at a part of a way, where the weights are `weight` between steps.
RT_FN float ellipseDensity(RT_IN(SphericalEllipse) e, RT_IN(EllipseWay) way, float total, float weight, float part) {
    const float kStep = 6.28318531f / float(kEllipseSteps);
    float azimuth = weight * (1.0f + way.rim) / (kStep * total * e.sines.x * e.sines.y);
    return azimuth * densityAt(way, part) / way.integral;
}

// ---- sampling ------------------------------------------------------------------------------------------------------

struct EllipseSample {
    vec2 place; // in the disk's plane, from its centre, along `aside` and across; of a unit disk
    float pdf;  // per steradian
};

// In the frame of the ellipse.
RT_FN vec3 toEllipse(RT_IN(SphericalEllipse) e, vec3 v) {
    return vec3(dot(v, e.x), dot(v, e.y), dot(v, e.z));
}

// `normal`: of a receiver whose cosine counts, in the frame of the ellipse, or zero.
RT_FN EllipseSample sampleSphericalEllipse(RT_IN(SphericalEllipse) e, vec3 normal, vec2 u) {
    float weights[kEllipseSteps];
    float total = 0.0f;
    for (uint i = 0u; i < kEllipseSteps; i++) {
        weights[i] = ellipseWeight(e, normal, i);
        total += weights[i];
    }
    float left = u.x * total;
    float begin = weights[0];
    float end = weights[0];
    float area = 0.0f;
    uint step = 0u;
    for (uint i = 0u; i < kEllipseSteps; i++) {
        begin = end;
        end = i + 1u < kEllipseSteps ? weights[i + 1u] : weights[0];
        area = 0.5f * (begin + end);
        step = i;
        if (left < area || i + 1u == kEllipseSteps) break;
        left -= area;
    }
    float within = invertLinear(begin, end, clamp(left / area, 0.0f, 1.0f) * area);
    vec2 sc = sinCos2Pi((float(step) + within) * (1.0f / float(kEllipseSteps)));
    vec2 cs = vec2(sc.y, sc.x);
    EllipseWay way = ellipseWay(e, normal, cs);
    float reached = u.y * way.integral;
    if (reached >= way.beforeHole.x) reached += way.beforeHole.y - way.beforeHole.x;
    float part = min(partAt(way, reached), way.span.y);
    float versine = part * way.squaredSine / (1.0f + way.rim);
    vec2 across = vec2(cs.x * e.sines.x, cs.y * e.sines.y) * sqrt(versine * (2.0f - versine) / way.squaredSine);
    float along = 1.0f - versine;
    // In the plane, where rays that run along it meet it with all digits.
    float towards = e.tilt.y * along - e.tilt.x * across.x;
    float away = e.height / towards;
    vec2 place = vec2(away * (e.tilt.x * along + e.tilt.y * across.x) - e.offset, away * across.y);
    place *= 1.0f / e.radius;
    EllipseSample s;
    s.place = place * min(1.0f, inversesqrt(max(dot(place, place), 1.0e-37f)));
    s.pdf = towards > 0.0f ? ellipseDensity(e, way, total, mix(begin, end, within), part) : 0.0f;
    return s;
}

// Density of a direction of the ellipse.
RT_FN float sphericalEllipsePdf(RT_IN(SphericalEllipse) e, vec3 normal, vec3 direction) {
    vec3 w = toEllipse(e, direction);
    // (cos x, sin x) is in proportion to the components over the sines.
    vec2 cs = vec2(w.x * e.sines.y, w.y * e.sines.x);
    float squared = dot(cs, cs);
    cs = squared > 1.0e-30f ? cs * inversesqrt(squared) : vec2(1.0f, 0.0f);
    float turn = arcTan(cs.y, cs.x) * (float(kEllipseSteps) * 0.159154943f);
    turn = turn < 0.0f ? turn + float(kEllipseSteps) : turn;
    uint step = min(uint(turn), kEllipseSteps - 1u);
    float weight = mix(ellipseWeight(e, normal, step), ellipseWeight(e, normal, step + 1u), turn - float(step));
    EllipseWay way = ellipseWay(e, normal, cs);
    float part = (w.x * w.x + w.y * w.y) * (1.0f + way.rim) / ((1.0f + w.z) * way.squaredSine);
    return ellipseDensity(e, way, ellipseTotal(e, normal), weight, min(part, 1.0f));
}

RT_SHARED_END

#endif
