// An ellipsoid, which is what the affine map x' = M x + centre makes of the unit sphere, as light sampling sees it:
// directions are drawn towards the sphere, from where the inverse map takes the shading point, and taken back by M.
//
// Directions w from the point that fill the solid angle dw cut a cone of the volume dw / 3 out of the unit ball around
// it. M makes |det M| times that of it, and of a radius w one of length |M w|. Hence the density of a direction v in
// the world is
//     p(v) = p(w) |M w|^3 / |det M| = p(w) / (|det M| |M^-1 v|^3)      with w along M^-1 v,
// and likewise for every linear map of directions.
#ifndef RT_SHARED_ELLIPSOIDS_H
#define RT_SHARED_ELLIPSOIDS_H
#include "Common/Shared/Shape/Shapes.h"
#include "Common/Shared/Shape/SphericalShapes.h"

RT_SHARED_BEGIN

struct Ellipsoid {
    vec3 axisX; // columns of M
    vec3 axisY;
    vec3 axisZ;
    vec3 rowX; // rows of its inverse
    vec3 rowY;
    vec3 rowZ;
    float volume; // |det M|
};

// A negative determinant mirrors the sphere, whose image is the same.
RT_FN Ellipsoid makeEllipsoid(vec3 axisX, vec3 axisY, vec3 axisZ) {
    Ellipsoid e;
    e.axisX = axisX;
    e.axisY = axisY;
    e.axisZ = axisZ;
    vec3 across = cross(axisY, axisZ);
    float determinant = dot(axisX, across);
    float inverse = 1.0f / determinant;
    e.rowX = across * inverse;
    e.rowY = cross(axisZ, axisX) * inverse;
    e.rowZ = cross(axisX, axisY) * inverse;
    e.volume = abs(determinant);
    return e;
}

// Vectors of the sphere's own space to the world and back.
RT_FN vec3 fromSphere(RT_IN(Ellipsoid) e, vec3 v) {
    return e.axisX * v.x + e.axisY * v.y + e.axisZ * v.z;
}
RT_FN vec3 toSphere(RT_IN(Ellipsoid) e, vec3 v) {
    return vec3(dot(e.rowX, v), dot(e.rowY, v), dot(e.rowZ, v));
}

// The unit outward normal of the ellipsoid where the sphere's is n.
RT_FN vec3 ellipsoidNormal(RT_IN(Ellipsoid) e, vec3 n) {
    return normalize(e.rowX * n.x + e.rowY * n.y + e.rowZ * n.z);
}
// The other way: along n where the ellipsoid's unit normal is `normal`, and as long as the ellipsoid reaches that way.
RT_FN vec3 normalReach(vec3 axisX, vec3 axisY, vec3 axisZ, vec3 normal) {
    return vec3(dot(axisX, normal), dot(axisY, normal), dot(axisZ, normal));
}

// ---- the cone of directions ----------------------------------------------------------------------------------------

// The directions to an ellipsoid from a point outside. In the sphere's space they fill a circular cone, and after a
// stretch along its axis another one. The stretch is such that M and its inverse together keep solid angles around the
// axis: directions uniform in that cone are nearly uniform in the world, and exactly if the ellipsoid looks round.
struct EllipsoidCone {
    vec3 axis;            // unit, towards the centre, in the sphere's space
    float distance;       // to the centre, there
    float tangent2;       // of the half angle there, squared
    float stretch;        // along the axis
    float cosine;         // of the half angle when stretched
    float oneMinusCosine; // of that angle; solid angle / (2 pi)
};

// `center`: from the point, in the sphere's space, longer than 1.
RT_FN EllipsoidCone makeEllipsoidCone(RT_IN(Ellipsoid) e, vec3 center) {
    EllipsoidCone c;
    c.distance = length(center);
    c.axis = center * (1.0f / c.distance);
    c.tangent2 = 1.0f / max((c.distance - 1.0f) * (c.distance + 1.0f), 1.0e-37f);
    float along = length(fromSphere(e, c.axis));
    c.stretch = along * sqrt(along / e.volume);
    float whole = c.stretch * c.stretch + c.tangent2;
    c.cosine = c.stretch / sqrt(whole);
    c.oneMinusCosine = c.tangent2 / (whole * (1.0f + c.cosine));
    return c;
}

// Of the world's direction wi, drawn by sampleEllipsoidCone.
RT_FN float ellipsoidConePdf(RT_IN(Ellipsoid) e, RT_IN(EllipsoidCone) c, vec3 wi) {
    vec3 w = toSphere(e, wi);
    float along = dot(w, c.axis);
    vec3 across = w - c.axis * along;
    float length2 = dot(across, across) + square(c.stretch * along);
    return c.stretch / (2.0f * kPi * c.oneMinusCosine * (e.volume * length2 * sqrt(length2)));
}

// A point of the near side in the sphere's space, and the way there from where it is seen.
struct EllipsoidConeSample {
    vec3 onSphere;
    vec3 toPoint;
};

RT_FN EllipsoidConeSample sampleEllipsoidCone(RT_IN(EllipsoidCone) c, vec2 u) {
    float q = u.x * c.oneMinusCosine; // when stretched, 1 - cos of the angle to the axis
    float cosine2 = (1.0f - q) * (1.0f - q);
    float factor = 1.0f / (cosine2 * (1.0f + c.cosine));
    // The squared tangent of that angle over that of the whole, which the stretch does not change, and what it lacks to
    // 1.
    float part = u.x * (2.0f - q) * (c.cosine * c.cosine) * factor;
    float rest = (1.0f - u.x) * (1.0f - q + c.cosine) * factor;
    float tangent2 = part * c.tangent2;
    float cosine = 1.0f / sqrt(1.0f + tangent2);
    float halfChord = sqrt(max(rest, 0.0f)) * cosine;
    float sine = sqrt(tangent2) * cosine;
    vec2 sc = sinCos2Pi(u.y);
    Frame f = makeFrame(c.axis);
    vec3 around = f.tangent * sc.y + f.bitangent * sc.x;
    float distance = (c.distance - 1.0f) * (c.distance + 1.0f) / (c.distance * cosine + halfChord);
    EllipsoidConeSample s;
    s.onSphere = around * (distance * sine) - c.axis * (c.distance * sine * sine + cosine * halfChord);
    s.toPoint = (around * sine + c.axis * cosine) * distance;
    return s;
}

// ---- points --------------------------------------------------------------------------------------------------------

// Density of the direction wi to the image, where the normal is `normal`, of a point drawn uniformly from the unit
// sphere. The far half is hidden by the near one.
RT_FN float ellipsoidAreaPdf(RT_IN(Ellipsoid) e, vec3 normal, vec3 wi, float distance) {
    float cosine = -dot(normal, wi);
    float reach = length(normalReach(e.axisX, e.axisY, e.axisZ, normal));
    return cosine > 0.0f ? areaPdf(4.0f * kPi * e.volume / reach, distance, cosine) : 0.0f;
}

// Where a ray meets an ellipsoid.
struct EllipsoidHit {
    float distance; // negative: nowhere, nothing else is defined
    vec3 onSphere;  // that point in the sphere's space
};

// `center`: from the ray's origin, in the sphere's space; wi in the world. From inside, the far side.
RT_FN EllipsoidHit intersectEllipsoid(RT_IN(Ellipsoid) e, vec3 center, vec3 wi) {
    Ray ray;
    ray.origin = -center;
    ray.direction = toSphere(e, wi);
    ray.time = 0.0f;
    vec3 middle = vec3(0.0f);
    EllipsoidHit hit;
    hit.distance = intersectSphere(ray, middle, 1.0f, kInfinity);
    hit.onSphere = spherePoint(ray, middle, 1.0f, hit.distance).normal;
    return hit;
}

// Times the sum of the terms of a coordinate that is taken to the sphere's space and back: bound of what rounding adds
// up to, in the map as well as in the engines' intersection.
const float kEllipsoidError = 32.0f * kEpsilon;

// Bound of the error per axis of points of the ellipsoid around `center`, each of whose coordinates in the sphere's
// space comes from several in the world.
RT_FN vec3 ellipsoidError(RT_IN(Ellipsoid) e, vec3 center) {
    vec3 reach = abs(center) + abs(e.axisX) + abs(e.axisY) + abs(e.axisZ);
    vec3 within = vec3(dot(abs(e.rowX), reach), dot(abs(e.rowY), reach), dot(abs(e.rowZ), reach));
    return kEllipsoidError * (abs(e.axisX) * within.x + abs(e.axisY) * within.y + abs(e.axisZ) * within.z);
}

RT_SHARED_END

#endif
