// Disks and open cylinders: the intersection of a ray, points on them, their texture coordinates.
#ifndef RT_SHARED_ROUNDS_H
#define RT_SHARED_ROUNDS_H
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

// The map from vectors of space to a disk's or cylinder's own coordinates: dot products with three vectors.
struct RoundFrame {
    vec3 dualU;
    vec3 dualV;
    vec3 dualW;
};

RT_FN RoundFrame roundFrame(vec3 edgeU, vec3 edgeV, vec3 axis) {
    vec3 n = cross(edgeU, edgeV);
    float inverse = 1.0f / dot(n, axis);
    RoundFrame frame;
    frame.dualU = cross(edgeV, axis) * inverse;
    frame.dualV = cross(axis, edgeU) * inverse;
    frame.dualW = n * inverse;
    return frame;
}

RT_FN vec3 toRound(RT_IN(RoundFrame) frame, vec3 v) {
    return vec3(dot(frame.dualU, v), dot(frame.dualV, v), dot(frame.dualW, v));
}

// How much rims are widened by, relative to the terms that coordinates are sums of, and kRimTerms times that: what
// rounding may take off them, those of the records included, so that a disk and the cylinder that it closes leave no
// gap.
const float kRoundError = 4.0f * kEpsilon;
const float kRimTerms = 4.0f;

// Whether w, of a ray from the coordinate `origin`, lies between base and top.
RT_FN bool isOnCylinder(float w, float origin) {
    return abs(w - 0.5f) <= 0.5f + kRoundError * (kRimTerms + abs(origin));
}

// The nearest t in (0, tMax) where the ray meets the disk or cylinder, or -1; in its own coordinates. Half the chord
// of a cylinder comes from the distance to its axis, as of spheres.
RT_FN float intersectRound(vec3 o, vec3 d, float hole, float tMax) {
    if (hole >= 0.0f) {
        float t = -o.z / d.z; // not a number where the ray lies in the plane
        float u = o.x + t * d.x;
        float v = o.y + t * d.y;
        float squared = u * u + v * v;
        bool isWithin = squared <= 1.0f + kRoundError * (kRimTerms + abs(o.x) + abs(o.y)) && squared >= hole * hole;
        return isWithin && t > 0.0f && t < tMax ? t : -1.0f;
    }
    float inverse = 1.0f / (d.x * d.x + d.y * d.y); // infinite along the axis: then nothing below is a number
    float middle = -(o.x * d.x + o.y * d.y) * inverse;
    float u = o.x + middle * d.x;
    float v = o.y + middle * d.y;
    float squaredHalf = (1.0f - (u * u + v * v)) * inverse;
    if (!(squaredHalf >= 0.0f)) return -1.0f;
    float halfChord = sqrt(squaredHalf);
    float near = middle - halfChord;
    float far = middle + halfChord;
    bool isNear = near > 0.0f && isOnCylinder(o.z + near * d.z, o.z);
    bool isFar = far > 0.0f && isOnCylinder(o.z + far * d.z, o.z);
    float t = isNear ? near : far;
    return (isNear || isFar) && t < tMax ? t : -1.0f;
}

RT_FN float intersectRound(Ray ray, vec3 origin, RT_IN(RoundFrame) frame, float hole, float tMax) {
    return intersectRound(toRound(frame, ray.origin - origin), toRound(frame, ray.direction), hole, tMax);
}

// ---- points --------------------------------------------------------------------------------------------------------

struct RoundPoint {
    vec3 position;
    vec3 normal; // unit, of the front
    vec3 place;  // in its own coordinates
    float error; // bound of how far the position, and then a ray that leaves it, is off the surface
};

// From the point in its own coordinates, which is on the surface.
RT_FN RoundPoint roundPoint(vec3 origin, vec3 edgeU, vec3 edgeV, vec3 axis, RT_IN(RoundFrame) frame, bool isDisk,
                            vec3 place) {
    RoundPoint point;
    point.place = place;
    vec3 across = edgeU * place.x + edgeV * place.y;
    vec3 along = isDisk ? vec3(0.0f) : axis * place.z;
    point.position = origin + across + along;
    point.normal = isDisk ? axis : normalize(frame.dualU * place.x + frame.dualV * place.y);
    // Of a slanted one coordinates are sums of larger terms.
    float slant =
        sqrt(max(dot(edgeU, edgeU) * dot(frame.dualU, frame.dualU), dot(edgeV, edgeV) * dot(frame.dualV, frame.dualV)));
    vec3 extent = abs(edgeU) + abs(edgeV) + (isDisk ? vec3(0.0f) : abs(axis));
    point.error = 16.0f * kEpsilon * slant * (maxComponent(abs(origin)) + maxComponent(extent));
    return point;
}

// Where the ray meets it, on the side that the hit at parameter t is on: of a cylinder by the foot of the
// perpendicular, as of spheres.
RT_FN RoundPoint roundPoint(RT_IN(Ray) ray, RT_IN(Round) r, float t) {
    RoundFrame frame = roundFrame(r.edgeU, r.edgeV, r.axis);
    vec3 o = toRound(frame, ray.origin - r.origin);
    vec3 d = toRound(frame, ray.direction);
    if (r.hole >= 0.0f) {
        vec3 place = vec3(o.x + t * d.x, o.y + t * d.y, 0.0f);
        return roundPoint(r.origin, r.edgeU, r.edgeV, r.axis, frame, true, place);
    }
    float inverse = 1.0f / (d.x * d.x + d.y * d.y);
    float middle = -(o.x * d.x + o.y * d.y) * inverse;
    vec2 foot = vec2(o.x + middle * d.x, o.y + middle * d.y);
    float halfChord = sqrt(max((1.0f - dot(foot, foot)) * inverse, 0.0f));
    float way = t < middle ? -halfChord : halfChord;
    vec2 rim = normalize(vec2(foot.x + way * d.x, foot.y + way * d.y));
    vec3 place = vec3(rim.x, rim.y, clamp(o.z + t * d.z, 0.0f, 1.0f));
    return roundPoint(r.origin, r.edgeU, r.edgeV, r.axis, frame, false, place);
}

// Texture coordinates: u once around from edgeU over edgeV, v of a disk from its rim to its middle or hole, of a
// cylinder from its base to its top.
RT_FN vec2 roundUv(vec3 place, float hole) {
    float turn = arcTan(place.y, place.x) * (0.5f * kInvPi);
    float u = min(turn < 0.0f ? turn + 1.0f : turn, 1.0f);
    if (hole < 0.0f) return vec2(u, place.z);
    float radius = sqrt(place.x * place.x + place.y * place.y);
    return vec2(u, clamp((1.0f - radius) / (1.0f - hole), 0.0f, 1.0f));
}

RT_SHARED_END

#endif
