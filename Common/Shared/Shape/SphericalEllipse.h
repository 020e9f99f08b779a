// A disk as seen from a point: what directions it fills is a spherical ellipse (Guillen, Urena, King, Fajardo,
// Georgiev, Lopez-Moreno and Jarabo, "Area-Preserving Parameterizations for Spherical Ellipses", 2017). This is the
// radial one of the paper's maps: an azimuth, then the angle from the middle.
//
// With half axes of sines a, b and cosines A, B the outline is (a cos x, b sin x, P(x)), P = sqrt(A^2 cos^2 x + B^2
// sin^2 x): unit vectors, since A^2 = 1 - a^2. Between the azimuths of x and x + dx lies the solid angle
//     (1 - P) d(azimuth) = a b / (1 + P) dx,
// which varies by a factor of two at most, however long the ellipse is. So x is drawn from a density that is linear
// between some of its values, and the angle from the middle uniformly in its cosine: nearly uniform in solid angle, and
// the density of what is drawn is known exactly. The weights of those values may follow the receiver's cosine as well.
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

// What is left of the way.
RT_FN float leftByHole(vec2 hole) {
    return max(1.0f - (hole.y - hole.x), 1.0e-3f);
}

// ---- density of the azimuth ----------------------------------------------------------------------------------------

const uint kEllipseSteps = 16u; // around the ellipse

// Cosine and sine of x at step i.
RT_FN vec2 ellipseStep(uint i) {
    vec2 sc = sinCos2Pi(float(i & (kEllipseSteps - 1u)) * (1.0f / float(kEllipseSteps)));
    return vec2(sc.y, sc.x);
}

// P for the cosine and sine of x.
RT_FN float ellipseRim(RT_IN(SphericalEllipse) e, vec2 cs) {
    return sqrt(square(e.cosines.x * cs.x) + square(e.cosines.y * cs.y));
}

// Of a receiver: what its cosine is within the ellipse. A normal of zero: it has none.
struct EllipseReceiver {
    vec3 normal;   // in the frame of the ellipse
    float minimum; // cosine that counts for lower ones, so that nothing above the horizon is left out
};

RT_FN EllipseReceiver ellipseReceiver(RT_IN(SphericalEllipse) e, vec3 normal) {
    EllipseReceiver r;
    r.normal = vec3(dot(normal, e.x), dot(normal, e.y), dot(normal, e.z));
    float across = length(vec2(r.normal.x * e.sines.x, r.normal.y * e.sines.y));
    r.minimum = 0.08f * max(r.normal.z + across, 0.1f);
    return r;
}

// Mean of the cosines at the rim and at two thirds of the way there, about where the mean of a sector is: what only
// the rim of is above the horizon counts, too.
RT_FN float ellipseCosine(RT_IN(SphericalEllipse) e, RT_IN(EllipseReceiver) r, vec2 cs, float rim) {
    if (dot(r.normal, r.normal) == 0.0f) return 1.0f;
    vec3 onRim = vec3(cs.x * e.sines.x, cs.y * e.sines.y, rim);
    vec3 within = vec3(onRim.x, onRim.y, 0.5f + rim);
    float atRim = max(dot(r.normal, onRim), 0.0f);
    return max(0.5f * (atRim + max(dot(r.normal, within) / length(within), 0.0f)), r.minimum);
}

RT_FN float ellipseWeight(RT_IN(SphericalEllipse) e, RT_IN(EllipseReceiver) r, uint i) {
    vec2 cs = ellipseStep(i);
    float rim = ellipseRim(e, cs);
    return ellipseCosine(e, r, cs, rim) * leftByHole(holeOnWay(e, cs, rim)) / (1.0f + rim);
}

// Sum of the weights of all steps: the integral is that times the length of a step.
RT_FN float ellipseTotal(RT_IN(SphericalEllipse) e, RT_IN(EllipseReceiver) r) {
    float total = 0.0f;
    for (uint i = 0u; i < kEllipseSteps; i++) total += ellipseWeight(e, r, i);
    return total;
}

// Per steradian, of directions at x, where the weights are `weight` between steps and a hole leaves `left`.
RT_FN float ellipseDensity(RT_IN(SphericalEllipse) e, float total, float weight, float rim, float left) {
    const float kStep = 6.28318531f / float(kEllipseSteps);
    return weight * (1.0f + rim) / (kStep * total * e.sines.x * e.sines.y * left);
}

// ---- sampling ------------------------------------------------------------------------------------------------------

struct EllipseSample {
    vec2 place; // in the disk's plane, from its centre, along `aside` and across; of a unit disk
    float pdf;  // per steradian
};

RT_FN EllipseSample sampleSphericalEllipse(RT_IN(SphericalEllipse) e, RT_IN(EllipseReceiver) r, vec2 u) {
    float total = ellipseTotal(e, r);
    float left = u.x * total;
    float first = ellipseWeight(e, r, 0u);
    float begin = first;
    float end = first;
    float area = 0.0f;
    uint step = 0u;
    for (uint i = 0u; i < kEllipseSteps; i++) {
        begin = end;
        end = i + 1u < kEllipseSteps ? ellipseWeight(e, r, i + 1u) : first;
        area = 0.5f * (begin + end);
        step = i;
        if (left < area || i + 1u == kEllipseSteps) break;
        left -= area;
    }
    float part = clamp(left / area, 0.0f, 1.0f);
    float within = invertLinear(begin, end, part * 0.5f * (begin + end));
    vec2 sc = sinCos2Pi((float(step) + within) * (1.0f / float(kEllipseSteps)));
    vec2 cs = vec2(sc.y, sc.x);
    float rim = ellipseRim(e, cs);
    vec2 onRim = vec2(cs.x * e.sines.x, cs.y * e.sines.y);
    float squaredSine = dot(onRim, onRim);
    // 1 - cosine of the angle from the middle, uniform up to that of the rim but for the hole.
    vec2 hole = holeOnWay(e, cs, rim);
    float free = leftByHole(hole);
    float reached = u.y * free;
    if (reached >= hole.x) reached = min(reached + (hole.y - hole.x), 1.0f);
    float versine = reached * squaredSine / (1.0f + rim);
    vec2 across = onRim * sqrt(versine * (2.0f - versine) / squaredSine);
    float along = 1.0f - versine;
    // In the plane, where rays that run along it meet it with all digits.
    float towards = e.tilt.y * along - e.tilt.x * across.x;
    float way = e.height / towards;
    vec2 place = vec2(way * (e.tilt.x * along + e.tilt.y * across.x) - e.offset, way * across.y) * (1.0f / e.radius);
    EllipseSample s;
    s.place = place * min(1.0f, inversesqrt(max(dot(place, place), 1.0e-37f)));
    s.pdf = towards > 0.0f ? ellipseDensity(e, total, mix(begin, end, within), rim, free) : 0.0f;
    return s;
}

// Density of a direction of the ellipse.
RT_FN float sphericalEllipsePdf(RT_IN(SphericalEllipse) e, RT_IN(EllipseReceiver) r, vec3 direction) {
    // (cos x, sin x) is in proportion to the components over the sines.
    vec2 cs = vec2(dot(direction, e.x) * e.sines.y, dot(direction, e.y) * e.sines.x);
    float squared = dot(cs, cs);
    cs = squared > 1.0e-30f ? cs * inversesqrt(squared) : vec2(1.0f, 0.0f);
    float turn = arcTan(cs.y, cs.x) * (float(kEllipseSteps) * 0.159154943f);
    turn = turn < 0.0f ? turn + float(kEllipseSteps) : turn;
    uint step = min(uint(turn), kEllipseSteps - 1u);
    float weight = mix(ellipseWeight(e, r, step), ellipseWeight(e, r, step + 1u), turn - float(step));
    float rim = ellipseRim(e, cs);
    return ellipseDensity(e, ellipseTotal(e, r), weight, rim, leftByHole(holeOnWay(e, cs, rim)));
}

RT_SHARED_END

#endif
