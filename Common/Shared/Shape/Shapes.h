// Intersection of a ray with one shape: the formulas of the GPU's own traversal, and the reference for the blocks of
// eight that the CPU tests at a time (Common/Accel/ShapeBlocks.h).
//
// A ray's parameter t counts lengths of its direction, which needs no unit length. Origins lie off their surface
// already, so every hit with 0 < t < tMax counts. No constant here has a unit of length: scaling a scene by a power of
// two changes no bit of a decision.
#ifndef RT_SHARED_SHAPES_H
#define RT_SHARED_SHAPES_H
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

struct ShapeHit {
    float t; // negative: missed
    float u; // as in Hit
    float v;
};

RT_FN ShapeHit missedShape() {
    ShapeHit hit;
    hit.t = -1.0f;
    hit.u = 0.0f;
    hit.v = 0.0f;
    return hit;
}

RT_FN vec3 sphereCenter(vec3 centerAtStart, vec3 motion, float time) {
    return centerAtStart + motion * time;
}

// The nearest t in (0, tMax) where the ray meets the sphere, or -1. Half the chord comes from the ray's distance to the
// centre, not from a difference of large squares, so a distant sphere loses no digits (Haines et al., "Precision
// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019). The error of t is a few roundings of the distance
// to the centre: that is what the origin of a ray that leaves the sphere is offset by. For near spheres, below, it is
// less. inverseSquaredLength: 1 / dot(direction, direction).
RT_FN float intersectSphere(Ray ray, float inverseSquaredLength, vec3 center, float radius, float tMax) {
    vec3 f = center - ray.origin;
    float middle = dot(f, ray.direction) * inverseSquaredLength;
    vec3 l = f - middle * ray.direction; // to the centre from the point of the line that is nearest to it
    float squaredHalf = (radius * radius - dot(l, l)) * inverseSquaredLength;
    if (!(squaredHalf >= 0.0f)) return -1.0f;
    float halfChord = sqrt(squaredHalf);
    float t = middle - halfChord > 0.0f ? middle - halfChord : middle + halfChord;
    return t > 0.0f && t < tMax ? t : -1.0f;
}

RT_FN float intersectSphere(Ray ray, vec3 center, float radius, float tMax) {
    return intersectSphere(ray, 1.0f / dot(ray.direction, ray.direction), center, radius, tMax);
}

// ---- near spheres --------------------------------------------------------------------------------------------------
//
// Those that rest and whose surface passes near the origin of coordinates, which is where the camera was at first: huge
// ones mostly, the ground say. Their coordinates would take the digits of all that stands on them. What is known of
// where the surface is, is the power of that origin with respect to the sphere, |center|^2 - radius^2, rounded once:
// that of any other point o follows as power + o . (o - 2 center), without a difference of large squares, so that
// errors grow with coordinates of the ray and the distance along it, and not with the radius.

// Whether the surface of a sphere is so near the origin of coordinates that the power of that is worth having.
RT_FN bool isNearSphere(float power, float radius) {
    return abs(power) < 0.75f * radius * radius;
}

// Whether a ray begins where the power tells more than the distance from the centre does.
RT_FN bool isInReach(vec3 origin, float radius) {
    return maxComponent(abs(origin)) < 4.0f * radius;
}

// As intersectSphere(), of a sphere with this power, or kInfinity if it is not a near one. The root of larger magnitude
// is a sum without cancellation, the other one follows from their product.
RT_FN float intersectSphere(Ray ray, float inverseSquaredLength, vec3 center, float radius, float power, float tMax) {
    if (!(power < kInfinity && isInReach(ray.origin, radius)))
        return intersectSphere(ray, inverseSquaredLength, center, radius, tMax);
    float middle = dot(center - ray.origin, ray.direction) * inverseSquaredLength;
    float product = (power + dot(ray.origin, ray.origin - 2.0f * center)) * inverseSquaredLength;
    float squaredHalf = middle * middle - product;
    if (!(squaredHalf >= 0.0f)) return -1.0f;
    float halfChord = sqrt(squaredHalf);
    float larger = middle < 0.0f ? middle - halfChord : middle + halfChord;
    float smaller = product / larger;
    float nearest = min(larger, smaller);
    float t = nearest > 0.0f ? nearest : max(larger, smaller);
    return t > 0.0f && t < tMax ? t : -1.0f;
}

// ---- points on spheres ---------------------------------------------------------------------------------------------

struct SpherePoint {
    vec3 position;
    vec3 normal; // unit, outwards
    float error; // bound of how far the position, and then a ray that leaves it, is off the sphere
};

// Where the ray meets the sphere, on the side that the hit at parameter t is on. The normal from the foot of the
// perpendicular, not from origin + t direction, whose error grows with t (Haines et al., Ray Tracing Gems, ch. 7). The
// direction is not unit in the space of an instance.
RT_FN SpherePoint spherePoint(Ray ray, vec3 center, float radius, float t) {
    vec3 f = ray.origin - center;
    float a = dot(ray.direction, ray.direction);
    float middle = -dot(f, ray.direction) / a;
    vec3 foot = f + ray.direction * middle;
    float halfChord = sqrt(max(0.0f, radius * radius - dot(foot, foot)) / a);
    SpherePoint point;
    point.normal = normalize(foot + ray.direction * (t < middle ? -halfChord : halfChord));
    point.position = center + point.normal * radius;
    point.error = 8.0f * kEpsilon * (maxComponent(abs(center)) + radius);
    return point;
}

// Bound of how far a point that is `way` from `origin` is off a near sphere, and a ray that leaves it is: the roundings
// of both tests and of the point. The second term is what a ray along the surface needs, whose cosine rounding may turn
// round: the square of that over twice the radius.
RT_FN float nearSphereError(vec3 origin, vec3 way, float radius) {
    return 16.0f * kEpsilon * (maxComponent(abs(origin)) + maxComponent(abs(way))) +
           32.0f * kEpsilon * kEpsilon * radius;
}

// The same of a sphere with this power, see above.
RT_FN SpherePoint spherePoint(Ray ray, vec3 center, float radius, float power, float t) {
    if (!(power < kInfinity)) return spherePoint(ray, center, radius, t);
    vec3 way = ray.direction * t;
    SpherePoint point;
    point.position = ray.origin + way;
    point.normal = normalize(point.position - center);
    point.error = nearSphereError(ray.origin, way, radius);
    return point;
}

// What the test of a quad needs to know of it; computed once, or per test where memory is dearer.
struct QuadFrame {
    vec3 normal; // along edgeU x edgeV, of any length
    vec3 dualU;  // dot(dualU, edgeU) = 1, dot(dualU, edgeV) = 0
    vec3 dualV;
    vec2 margin; // errors of u and v for a unit of t |direction|
};

// Bounds the rounding errors of u and v, relative to the terms they are sums of. Of rays aimed exactly at the edges of
// turned boxes one in 30 000 gets out; twice as much would stop that one too, but makes lamps larger: a strip as wide
// as 1/100 of its distance by 5e-5. Each direction has its own bound, since what a strip needs along its short side
// would lengthen it.
const float kQuadError = 2.0f * kEpsilon;

RT_FN QuadFrame quadFrame(vec3 edgeU, vec3 edgeV) {
    QuadFrame frame;
    vec3 n = cross(edgeU, edgeV);
    frame.normal = n / dot(n, n);
    frame.dualU = cross(edgeV, frame.normal);
    frame.dualV = cross(frame.normal, edgeU);
    frame.margin = kQuadError * vec2(length(frame.dualU), length(frame.dualV));
    return frame;
}

// The parallelogram is closed and widened by what rounding may take off its edges, so that quads which share an edge
// leave no gap. Only rays within the plane are rejected for their angle. rayLength: length(direction).
RT_FN ShapeHit intersectQuad(Ray ray, float rayLength, vec3 corner, QuadFrame frame, float tMax) {
    ShapeHit hit = missedShape();
    vec3 f = corner - ray.origin;
    float t = dot(frame.normal, f) / dot(frame.normal, ray.direction);
    if (!(t > 0.0f && t < tMax)) return hit; // not a number where the ray lies in the plane
    float u = t * dot(frame.dualU, ray.direction) - dot(frame.dualU, f);
    float v = t * dot(frame.dualV, ray.direction) - dot(frame.dualV, f);
    vec2 reach = t * rayLength * frame.margin + (0.5f + kQuadError);
    if (!(abs(u - 0.5f) <= reach.x && abs(v - 0.5f) <= reach.y)) return hit;
    hit.t = t;
    hit.u = clamp(u, 0.0f, 1.0f);
    hit.v = clamp(v, 0.0f, 1.0f);
    return hit;
}

RT_FN ShapeHit intersectQuad(Ray ray, vec3 corner, QuadFrame frame, float tMax) {
    return intersectQuad(ray, length(ray.direction), corner, frame, tMax);
}

// The t in (0, tMax) where the ray meets a rectangle perpendicular to an axis, or -1, in coordinates of which that axis
// is the last: `toCenter` from the ray's origin; `inverse` 1 / direction.z; `halfExtent` with what quadFrame() adds
// for errors, but for those of t: rayLength times t.
RT_FN float intersectAxisQuad(vec3 toCenter, vec2 halfExtent, vec3 direction, float inverse, float rayLength,
                              float tMax) {
    float t = toCenter.z * inverse; // not a number where the ray lies in the plane
    float reach = t * (kQuadError * rayLength);
    bool isWithin = abs(t * direction.x - toCenter.x) <= halfExtent.x + reach &&
                    abs(t * direction.y - toCenter.y) <= halfExtent.y + reach;
    return isWithin && t > 0.0f && t < tMax ? t : -1.0f;
}

// Below this a direction counts as parallel to a slab: its reciprocal stays finite, and no product with it is not a
// number.
const float kParallel = 1.0e-20f;

RT_FN float slabInverse(float d) {
    return 1.0f / (abs(d) < kParallel ? (d < 0.0f ? -kParallel : kParallel) : d);
}

// Of slabs given by their middle and half of their extent: what a ray's t may be off near a side, relative to that
// half. Three roundings: of the way to the middle, of its product and of the half's with the reciprocal. No more, so
// that rays that leave a face of a box (extentError()) begin outside of it.
const float kHalfExtentError = 3.0f * kEpsilon;

// What is left of the rounding of the slab test, of the reciprocal (2.5 ulp) and of the primitives' own tests, relative
// to where the ray leaves a box: all of it may only let more boxes in, after Ize, "Robust BVH Ray Traversal", JCGT
// 2(2), 2013.
const float kSlabMargin = 1.0f + 20.0f * kEpsilon;

// Where a ray enters and leaves a cuboid.
struct CuboidHit {
    float enter;    // t, negative: behind the origin
    float leave;    // less than `enter`: missed
    uint enterFace; // 0, 1, 2: on the negative side along x, y, z; 3, 4, 5: on the positive side
    uint leaveFace;
};

// In coordinates of which the cuboid reaches from -1 to 1 along each axis. Widened by what rounding may take off its
// edges, as quads are.
RT_FN CuboidHit intersectCuboid(vec3 toCenter, vec3 direction) {
    vec3 inverse = vec3(slabInverse(direction.x), slabInverse(direction.y), slabInverse(direction.z));
    vec3 middle = toCenter * inverse;
    vec3 reach = abs(inverse) * (1.0f + 2.0f * kQuadError);
    vec3 enter = middle - reach;
    vec3 leave = middle + reach;
    CuboidHit hit;
    hit.enter = max(enter.x, max(enter.y, enter.z));
    hit.leave = min(leave.x, min(leave.y, leave.z));
    uint x = inverse.x > 0.0f ? 0u : 3u; // the faces through which a ray of this direction enters
    uint y = inverse.y > 0.0f ? 1u : 4u;
    uint z = inverse.z > 0.0f ? 2u : 5u;
    hit.enterFace = enter.x == hit.enter ? x : (enter.y == hit.enter ? y : z);
    uint opposite = leave.x == hit.leave ? x : (leave.y == hit.leave ? y : z);
    hit.leaveFace = opposite < 3u ? opposite + 3u : opposite - 3u;
    return hit;
}

// u and v of the place where the ray meets a rectangle at parameter t.
RT_FN vec2 rectanglePlace(Ray ray, float t, vec3 corner, vec3 edgeU, vec3 edgeV) {
    vec3 place = t * ray.direction - (corner - ray.origin);
    vec2 uv = vec2(dot(place, edgeU) / dot(edgeU, edgeU), dot(place, edgeV) / dot(edgeV, edgeV));
    return clamp(uv, vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
}

// p.x q.y - p.y q.x, rounded alike for both directions of an edge, however a compiler fuses products with sums: the two
// triangles at an edge always agree on which side of it a ray passes.
RT_FN float edgeFunction(vec2 p, vec2 q) {
    bool swapped = p.x > q.x || (p.x == q.x && p.y > q.y);
    vec2 a = swapped ? q : p;
    vec2 b = swapped ? p : q;
    float e = a.x * b.y - a.y * b.x;
    return swapped ? -e : e;
}

RT_FN uint largestAxis(vec3 v) {
    vec3 m = abs(v);
    return m.x > m.y ? (m.x > m.z ? 0u : 2u) : (m.y > m.z ? 1u : 2u);
}

// What the tests of all triangles have in common for a ray: the axis that it mostly runs along, and the shear that
// makes it run along that axis exactly.
struct TriangleRay {
    uint axis;
    float shearX;
    float shearY;
    float along; // component of the direction on the axis
};

// The components in cyclic order, that of `axis` last.
RT_FN vec3 axisLast(vec3 v, uint axis) {
    if (axis == 2u) return v;
    return axis == 0u ? vec3(v.y, v.z, v.x) : vec3(v.z, v.x, v.y);
}

RT_FN TriangleRay makeTriangleRay(vec3 direction) {
    TriangleRay r;
    r.axis = largestAxis(direction);
    vec3 d = axisLast(direction, r.axis);
    r.shearX = d.x / d.z;
    r.shearY = d.y / d.z;
    r.along = d.z;
    return r;
}

// Woop, Benthin & Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013: shear space so that the ray runs along
// an axis, then ask on which side of the three edges it passes. Edges belong to both triangles that share them.
RT_FN ShapeHit intersectTriangle(vec3 origin, RT_IN(TriangleRay) ray, vec3 vertex0, vec3 vertex1, vec3 vertex2,
                                 float tMax) {
    ShapeHit hit = missedShape();
    vec3 a = axisLast(vertex0 - origin, ray.axis);
    vec3 b = axisLast(vertex1 - origin, ray.axis);
    vec3 c = axisLast(vertex2 - origin, ray.axis);
    vec2 a2 = vec2(a.x - ray.shearX * a.z, a.y - ray.shearY * a.z);
    vec2 b2 = vec2(b.x - ray.shearX * b.z, b.y - ray.shearY * b.z);
    vec2 c2 = vec2(c.x - ray.shearX * c.z, c.y - ray.shearY * c.z);

    float wa = edgeFunction(c2, b2);
    float wb = edgeFunction(a2, c2);
    float wc = edgeFunction(b2, a2);
    if (min(wa, min(wb, wc)) < 0.0f && max(wa, max(wb, wc)) > 0.0f) return hit;
    float sum = wa + wb + wc;
    float t = (wa * a.z + wb * b.z + wc * c.z) / (sum * ray.along);
    if (!(t > 0.0f && t < tMax)) return hit; // not a number where the triangle is seen edge-on
    hit.t = t;
    hit.u = wb / sum;
    hit.v = wc / sum;
    return hit;
}

RT_FN ShapeHit intersectTriangle(Ray ray, vec3 vertex0, vec3 vertex1, vec3 vertex2, float tMax) {
    return intersectTriangle(ray.origin, makeTriangleRay(ray.direction), vertex0, vertex1, vertex2, tMax);
}

RT_SHARED_END

#endif
