// Light that reaches a point x from a point y through a sphere of glass, refracted where it enters and where it leaves.
//
// Such a path lies in the plane of x, y and the centre C, and passes C at the same distance on both sides. With i and r
// the angles of incidence and refraction, a and b the angles at x and y between the path and the line to C, it turns by
//     turn(i) = 2 (i - r) - a - b,   sin r = sin i / eta,  sin a = sin i R / |xC|,  sin b = sin i R / |yC|,
// more than a straight line through C. It connects x with y where turn = -bend (it passes C on the side of y) or
// turn = +bend (on the other side), where bend is the angle between xC and Cy. `turn` is convex in i, as each of its
// terms is where eta > 1, and 0 for i = 0: at most one path turns by +bend and at most two by -bend, on either side of
// the minimum. Newton's method that begins where the function is positive stays on that side of the root, and needs no
// bracket. Angles are kept as rotations, so that no arc function is evaluated. Without a branch, for loops over lanes.
//
// A path that crosses the sphere m times, and is reflected inside in between, turns by
//     turn(i) = 2 i - 2 m r - a - b
// more than m straight lines through C, which lead back to x where m is even: bend is the angle between Cx and Cy then,
// and +bend the side of y. All of the above holds for m = 2, for whichever eta turn stays within (-pi, pi). For m = 0,
// reflection on the outside, there is one path, which turns by +bend.
#ifndef RT_SHARED_SPHERE_REFRACTION_H
#define RT_SHARED_SPHERE_REFRACTION_H
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

// Cosine and sine of an angle.
RT_FN vec2 turnedBy(vec2 a, vec2 b) {
    return vec2(a.x * b.x - a.y * b.y, a.y * b.x + a.x * b.y);
}
RT_FN vec2 turnedBack(vec2 a, vec2 b) {
    return vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
}

RT_FN vec2 angleOfSine(float sine) {
    return vec2(sqrt(max((1.0f - sine) * (1.0f + sine), 0.0f)), sine);
}

// 1 where light goes on to the other side of the sphere, -1 where it goes back to the side that it comes from.
RT_FN float sideAfter(uint crossings) {
    return crossings == kRefracted ? 1.0f : -1.0f;
}

// Of the light that meets the sphere, what goes on after its crossings where this fraction is reflected.
RT_FN float fractionAfter(uint crossings, float reflected) {
    float crossed = crossings == kReflectedOutside ? 1.0f : square(1.0f - reflected);
    return crossings == kRefracted ? crossed : crossed * reflected;
}

// What the paths from x to y depend on.
struct RefractionPair {
    float inverseEta; // index outside over inside, < 1
    uint crossings;   // kReflectedOutside...
    float nearX;      // R / |xC|, < 1
    float nearY;      // R / |yC|, < 1
    vec2 bend;        // cosine and sine of the angle, in [0, pi]
};

// One angle of incidence, and how the path turns there.
struct Refraction {
    vec2 incident;
    vec2 refracted;
    vec2 atX;
    vec2 atY;
    vec2 turn;
    float slope; // of the turn, by the angle of incidence
};

// The angle of refraction times the number of crossings.
RT_FN vec2 crossingAngle(uint crossings, vec2 refracted) {
    vec2 again = select(crossings == kRefracted, refracted, turnedBy(refracted, refracted));
    return select(crossings == kReflectedOutside, vec2(1.0f, 0.0f), again);
}

RT_FN Refraction refractionAt(RT_IN(RefractionPair) p, vec2 incident) {
    Refraction r;
    r.incident = incident;
    r.refracted = angleOfSine(incident.y * p.inverseEta);
    r.atX = angleOfSine(incident.y * p.nearX);
    r.atY = angleOfSine(incident.y * p.nearY);
    vec2 deviation = turnedBack(incident, crossingAngle(p.crossings, r.refracted));
    r.turn = turnedBack(turnedBy(deviation, deviation), turnedBy(r.atX, r.atY));
    r.slope = 2.0f - incident.x * (2.0f * float(p.crossings) * p.inverseEta / r.refracted.x +
                                   p.nearX / max(r.atX.x, 1.0e-6f) + p.nearY / max(r.atY.x, 1.0e-6f));
    return r;
}

// The angle turned by a small one, to third order.
RT_FN vec2 turnedBySmall(vec2 a, float angle) {
    float h = 0.5f * angle;
    float scale = 1.0f / (1.0f + h * h);
    return turnedBy(a, vec2((1.0f - h * h) * scale, 2.0f * h * scale));
}

// Sine of a - b, both in (-pi, pi), or +-1 where the difference is beyond a right angle.
RT_FN float clampedSineOfDifference(vec2 a, vec2 b) {
    // 1 - cos with the sign of the sine rises with the angle; it differs by less than 2 within a right angle, by at
    // least 3 beyond three of them.
    float riseA = a.y < 0.0f ? a.x - 1.0f : 1.0f - a.x;
    float riseB = b.y < 0.0f ? b.x - 1.0f : 1.0f - b.x;
    float rise = riseA - riseB;
    vec2 d = turnedBack(a, b);
    float beyond = rise < 0.0f ? -1.0f : 1.0f;
    return abs(rise) < 2.0f ? (d.x > 0.0f ? d.y : beyond) : beyond;
}

const uint kMinSteps = 10u;
const uint kRootSteps = 8u;

// The angle whose half has this tangent, in [0, 1].
RT_FN vec2 angleOfHalfTangent(float t) {
    float scale = 1.0f / (1.0f + t * t);
    return vec2((1.0f - t) * (1.0f + t) * scale, 2.0f * t * scale);
}

// The angle of incidence of least turn; 0 where the turn rises throughout. The turn is level there, so that halving the
// interval a few times gives its least value to a part in a million. Tangents of half angles, from (0, 1) on: halved
// kMinSteps times the interval is that of the angle.
RT_FN vec2 halvedMin(RT_IN(RefractionPair) p, vec2 interval) {
    float t = 0.5f * (interval.x + interval.y);
    bool falls = refractionAt(p, angleOfHalfTangent(t)).slope < 0.0f;
    return vec2(falls ? t : interval.x, falls ? interval.y : t);
}

// Whether the turn rises from the first angle on; the interval does not matter then.
RT_FN bool risesThroughout(RT_IN(RefractionPair) p) {
    return 2.0f - 2.0f * float(p.crossings) * p.inverseEta - p.nearX - p.nearY >= 0.0f;
}

RT_FN vec2 minWithin(RT_IN(RefractionPair) p, vec2 interval) {
    return angleOfHalfTangent(risesThroughout(p) ? 0.0f : 0.5f * (interval.x + interval.y));
}

RT_FN vec2 minTurn(RT_IN(RefractionPair) p) {
    vec2 interval = vec2(0.0f, 1.0f);
    if (risesThroughout(p)) return minWithin(p, interval);
    for (uint k = 0u; k < kMinSteps; k++) interval = halvedMin(p, interval);
    return minWithin(p, interval);
}

// How many paths there are: beyond the minimum that turn by +bend and by -bend, and before it that turn by -bend.
struct RefractionRoots {
    uint count;
    uint opposite; // 1: +bend
    uint beyond;   // 1: -bend beyond the minimum
    uint before;   // 1: -bend before the minimum
};

RT_FN RefractionRoots refractionRoots(RT_IN(RefractionPair) p, vec2 minimum) {
    vec2 grazing = refractionAt(p, vec2(0.0f, 1.0f)).turn;
    vec2 lowest = refractionAt(p, minimum).turn;
    vec2 back = vec2(p.bend.x, -p.bend.y);
    RefractionRoots n;
    n.opposite = clampedSineOfDifference(grazing, p.bend) > 0.0f ? 1u : 0u;
    uint reached = clampedSineOfDifference(lowest, back) < 0.0f ? 1u : 0u;
    n.before = reached;
    n.beyond = clampedSineOfDifference(grazing, back) > 0.0f ? reached : 0u;
    n.count = n.opposite + n.beyond + n.before;
    return n;
}

// Density of solid angle at x over area at y across the path, for R = 1.
RT_FN float refractionDensity(RT_IN(RefractionPair) p, RT_IN(Refraction) r) {
    float sine = max(abs(r.turn.y), 1.0e-12f);
    return square(p.nearX * p.nearY) * r.incident.x * max(r.incident.y, 1.0e-12f) /
           max(r.atX.x * r.atY.x * sine * abs(r.slope), 1.0e-30f);
}

const uint kRefractedPaths = 3u; // kinds of them
const uint kOppositePath = 0u;   // turns by +bend
const uint kBeyondPath = 1u;     // by -bend, beyond the minimum
const uint kBeforePath = 2u;     // by -bend, before it

RT_FN bool hasPath(RT_IN(RefractionRoots) n, uint kind) {
    return kind == kOppositePath ? n.opposite != 0u : kind == kBeyondPath ? n.beyond != 0u : n.before != 0u;
}

// Angles of incidence of a path of this kind, which there is: after kRootSteps steps it is known.
RT_FN vec2 firstAngle(uint kind) {
    return kind == kBeforePath ? vec2(1.0f, 0.0f) : vec2(0.0f, 1.0f);
}

RT_FN vec2 nextAngle(RT_IN(RefractionPair) p, uint kind, vec2 angle) {
    bool isBefore = kind == kBeforePath;
    Refraction r = refractionAt(p, angle);
    float f = clampedSineOfDifference(r.turn, vec2(p.bend.x, kind == kOppositePath ? p.bend.y : -p.bend.y));
    float slope = isBefore ? min(r.slope, -1.0e-3f) : max(r.slope, 1.0e-3f);
    vec2 next = turnedBySmall(angle, clamp(-f / slope, -1.0f, 1.0f));
    return vec2(max(next.x, 0.0f), clamp(next.y, 0.0f, 1.0f));
}

// Where a path of this kind, which there is, is refracted.
RT_FN Refraction refractedPath(RT_IN(RefractionPair) p, uint kind) {
    vec2 angle = firstAngle(kind);
    for (uint k = 0u; k < kRootSteps; k++) angle = nextAngle(p, kind, angle);
    return refractionAt(p, angle);
}

// Where a path runs: its direction at x, and the outward normals where it enters, where it is reflected inside, and
// where it leaves. `along` is the unit direction from x to C, `aside` the one across it towards y, or away from y where
// the number of crossings is even.
struct RefractedPlaces {
    vec3 atX;
    vec3 entry;
    vec3 bounce;
    vec3 leave;
};

// A place on the sphere by the angle about C from the direction to x.
RT_FN vec3 placeAt(vec2 angle, vec3 along, vec3 e) {
    return e * angle.y - along * angle.x;
}

RT_FN RefractedPlaces refractedPlaces(RT_IN(Refraction) r, uint crossings, uint kind, vec3 along, vec3 aside) {
    vec3 e = aside * (kind == kOppositePath ? -1.0f : 1.0f);
    // Angles about C from the direction to x: i - a, and then pi - 2 r more with every crossing.
    vec2 twice = turnedBy(r.refracted, r.refracted);
    vec2 entry = turnedBack(r.incident, r.atX);
    vec2 across = turnedBack(vec2(-entry.x, -entry.y), twice);
    vec2 back = turnedBack(vec2(-across.x, -across.y), twice);
    vec2 leave = select(crossings == kReflectedOutside, entry, select(crossings == kRefracted, across, back));
    RefractedPlaces places;
    places.atX = along * r.atX.x + e * r.atX.y;
    places.entry = placeAt(entry, along, e);
    places.bounce = placeAt(across, along, e);
    places.leave = placeAt(leave, along, e);
    return places;
}

RT_SHARED_END

#endif
