// Intersection of one ray with eight primitives of one kind at a time: the formulas of Common/Shared/Shapes.h, lane by
// lane. Lanes hit for t > 0; the caller compares with the far end of its interval.
#pragma once
#include "Common/Accel/AccelView.h"
#include "Common/Accel/Simd/Simd.h"
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Shape/Rounds.h"
#include "Common/Shared/Shape/Shapes.h"

namespace rt::accel {
namespace {

// A ray with what the tests of shapes derive from it. The direction needs no unit length.
struct ShapeRay {
    float origin[3];
    float direction[3];
    float time;
    float squaredLength;
    float inverseSquaredLength;
    float length;
    unsigned axis[3]; // permutation that makes axis[2] the direction's largest component
    float shear[3];   // direction[axis[0]] / direction[axis[2]], likewise axis[1]; 1 / direction[axis[2]]
};

RT_FN ShapeRay makeShapeRay(shared::Features features, const shared::Ray& ray, bool isUnit) {
    const shared::vec3 d = ray.direction;
    ShapeRay r{};
    for (int a = 0; a < 3; ++a) {
        r.origin[a] = ray.origin[a];
        r.direction[a] = d[a];
    }
    r.time = ray.time;
    if (shared::has(features, shared::kFeatureSpheres | shared::kFeatureMovingSpheres | shared::kFeatureQuads)) {
        r.squaredLength = isUnit ? 1.0f : shared::dot(d, d);
        r.inverseSquaredLength = 1.0f / r.squaredLength;
        r.length = shared::sqrt(r.squaredLength);
    }
    if (shared::has(features, shared::kFeatureTriangles)) {
        r.axis[2] = shared::largestAxis(d);
        r.axis[0] = r.axis[2] == 2 ? 0 : r.axis[2] + 1;
        r.axis[1] = r.axis[0] == 2 ? 0 : r.axis[0] + 1;
        r.shear[2] = 1.0f / r.direction[r.axis[2]];
        r.shear[0] = r.direction[r.axis[0]] / r.direction[r.axis[2]];
        r.shear[1] = r.direction[r.axis[1]] / r.direction[r.axis[2]];
    }
    return r;
}

struct Vector {
    Float8 x, y, z;
};

RT_FN Vector broadcast3(const float (&v)[3]) {
    return {broadcast(v[0]), broadcast(v[1]), broadcast(v[2])};
}

RT_FN Vector load3(const float (&v)[3][kWidth]) {
    return {load(v[0]), load(v[1]), load(v[2])};
}

RT_FN Vector operator-(Vector a, Vector b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

// c + a b
RT_FN Vector multiplyAdd(Vector a, Float8 b, Vector c) {
    return {multiplyAdd(a.x, b, c.x), multiplyAdd(a.y, b, c.y), multiplyAdd(a.z, b, c.z)};
}

RT_FN Float8 dot(Vector a, Vector b) {
    return multiplyAdd(a.z, b.z, multiplyAdd(a.y, b.y, a.x * b.x));
}

struct LaneHits {
    Mask8 mask;
    Float8 t, u, v; // meaningful where mask is set
};

// Of the ray's line and a sphere: the middle of the chord, and half of it, squared; negative beside the sphere.
struct SphereChord {
    Float8 middle, squaredHalf;
};

RT_FN SphereChord sphereChord(const ShapeRay& ray, Vector center, Float8 radius) {
    const Float8 inverseA = broadcast(ray.inverseSquaredLength);
    const Vector d = broadcast3(ray.direction);
    const Vector f = center - broadcast3(ray.origin);
    const Float8 middle = dot(f, d) * inverseA;
    const Float8 x = negateMultiplyAdd(middle, d.x, f.x);
    const Float8 y = negateMultiplyAdd(middle, d.y, f.y);
    const Float8 z = negateMultiplyAdd(middle, d.z, f.z);
    const Float8 squaredHalf = negateMultiplyAdd(x, x, radius * radius) - multiplyAdd(y, y, z * z);
    return {middle, squaredHalf * inverseA};
}

// The first of both places on the ray's line that lies ahead; none where they are no numbers.
RT_FN LaneHits firstAhead(Float8 lower, Float8 upper) {
    const Float8 zero = broadcast(0.0f);
    const Float8 t = select(zero < lower, lower, upper);
    return {zero < t, t, zero, zero};
}

RT_FN LaneHits intersectSpheres(const ShapeRay& ray, Vector center, Float8 radius) {
    const SphereChord chord = sphereChord(ray, center, radius);
    const Float8 half = squareRoot(chord.squaredHalf);
    return firstAhead(chord.middle - half, chord.middle + half);
}

RT_FN LaneHits intersectBlock(const ShapeRay& ray, const SphereBlock& block) {
    return intersectSpheres(ray, load3(block.center), load(block.radius));
}

// Lanes whose sphere is no near one, or the ray begins far away from, take what intersectSpheres() does.
RT_FN LaneHits intersectBlock(const ShapeRay& ray, const NearSphereBlock& block) {
    const Vector o = broadcast3(ray.origin);
    const Vector center = load3(block.center);
    const Float8 radius = load(block.radius), powerOfOrigin = load(block.power);
    const auto [middle, farSquaredHalf] = sphereChord(ray, center, radius);
    const Float8 reach = maximum(absolute(o.x), maximum(absolute(o.y), absolute(o.z)));
    const Mask8 isByPower = (reach < broadcast(4.0f) * radius) & (powerOfOrigin < broadcast(shared::kInfinity));
    const Float8 power = powerOfOrigin + dot(o, o - center - center);
    const Float8 product = power * broadcast(ray.inverseSquaredLength);
    const Float8 half = squareRoot(select(isByPower, multiplySubtract(middle, middle, product), farSquaredHalf));
    const Float8 lower = middle - half, upper = middle + half;
    const Float8 larger = select(middle < broadcast(0.0f), lower, upper);
    const Float8 smaller = product / larger;
    return firstAhead(select(isByPower, minimum(larger, smaller), lower),
                      select(isByPower, maximum(larger, smaller), upper));
}

RT_FN LaneHits intersectBlock(const ShapeRay& ray, const MovingSphereBlock& block) {
    const Vector center = multiplyAdd(load3(block.motion), broadcast(ray.time), load3(block.center));
    return intersectSpheres(ray, center, load(block.radius));
}

RT_FN LaneHits intersectBlock(const ShapeRay& ray, const QuadBlock& block) {
    const Float8 half = broadcast(0.5f);
    const Vector d = broadcast3(ray.direction);
    const Vector f = load3(block.corner) - broadcast3(ray.origin);
    const Vector normal = load3(block.normal);
    const Vector dualU = load3(block.dualU);
    const Vector dualV = load3(block.dualV);
    const Float8 t = dot(normal, f) / dot(normal, d);
    const Float8 u = multiplySubtract(t, dot(dualU, d), dot(dualU, f) + half); // from the middle of the quad
    const Float8 v = multiplySubtract(t, dot(dualV, d), dot(dualV, f) + half);
    const Float8 distance = t * broadcast(ray.length);
    const Float8 reach = broadcast(0.5f + shared::kQuadError);
    const Mask8 insideU = absolute(u) <= multiplyAdd(distance, load(block.margin[0]), reach);
    const Mask8 insideV = absolute(v) <= multiplyAdd(distance, load(block.margin[1]), reach);
    return {insideU & insideV & (broadcast(0.0f) < t), t, u + half, v + half};
}

// Disks and cylinders in their own coordinates: each lane takes what it is of both tests.
RT_FN LaneHits intersectBlock(const ShapeRay& ray, const RoundBlock& block) {
    const Float8 zero = broadcast(0.0f), one = broadcast(1.0f), half = broadcast(0.5f);
    const Float8 error = broadcast(shared::kRoundError), terms = broadcast(shared::kRimTerms);
    const Vector f = broadcast3(ray.origin) - load3(block.origin);
    const Vector d = broadcast3(ray.direction);
    const Vector rows[3] = {load3(block.dualU), load3(block.dualV), load3(block.dualW)};
    const Vector o = {dot(rows[0], f), dot(rows[1], f), dot(rows[2], f)};
    const Vector w = {dot(rows[0], d), dot(rows[1], d), dot(rows[2], d)};
    const Float8 hole = load(block.hole);

    const Float8 plane = (zero - o.z) / w.z;
    const Float8 u = multiplyAdd(plane, w.x, o.x), v = multiplyAdd(plane, w.y, o.y);
    const Float8 squared = multiplyAdd(u, u, v * v);
    const Float8 reach = multiplyAdd(error, terms + absolute(o.x) + absolute(o.y), one);
    const Mask8 isOnDisk = (zero <= hole) & (squared <= reach) & (hole * hole <= squared) & (zero < plane);

    const Float8 inverse = one / multiplyAdd(w.x, w.x, w.y * w.y);
    const Float8 middle = (zero - multiplyAdd(o.x, w.x, o.y * w.y)) * inverse;
    const Float8 x = multiplyAdd(middle, w.x, o.x), y = multiplyAdd(middle, w.y, o.y);
    const Float8 halfChord = squareRoot((one - multiplyAdd(x, x, y * y)) * inverse); // not a number beside it
    const Float8 height = multiplyAdd(error, terms + absolute(o.z), half);
    const Float8 near = middle - halfChord, far = middle + halfChord;
    const Float8 fromMiddle = o.z - half;
    const Mask8 isNear = (zero < near) & (absolute(multiplyAdd(near, w.z, fromMiddle)) <= height);
    const Mask8 isFar = (zero < far) & (absolute(multiplyAdd(far, w.z, fromMiddle)) <= height);
    const Mask8 isOnCylinder = (hole < zero) & (isNear | isFar);
    return {isOnDisk | isOnCylinder, select(isOnDisk, plane, select(isNear, near, far)), zero, zero};
}

// x of p times y of q minus y of p times x of q, for the three edges of triangles in the plane across the ray. Signs
// are those of the exact values (unless those underflow), so the two triangles at an edge always agree on which side of
// it the ray passes.
struct EdgeFunctions {
    Float8 a, b, c;
};

// With fused multiply-add the error of one product is added back: Jeannerod, Louvet & Muller, "Further analysis of
// Kahan's algorithm for the accurate computation of 2x2 determinants", 2013.
RT_FN Float8 fusedDifference(Float8 a, Float8 b, Float8 c, Float8 d) {
    const Float8 cd = c * d;
    return multiplySubtract(a, b, cd) - multiplySubtract(c, d, cd);
}

// Products of floats are exact in double.
[[maybe_unused]] static EdgeFunctions doubleEdgeFunctions(const Float8 (&x)[3], const Float8 (&y)[3]) {
    alignas(32) float xs[3][kWidth], ys[3][kWidth], edges[3][kWidth];
    for (int vertex = 0; vertex < 3; ++vertex) {
        store(xs[vertex], x[vertex]);
        store(ys[vertex], y[vertex]);
    }
    for (int edge = 0; edge < 3; ++edge) {
        const int p = (edge + 2) % 3, q = (edge + 1) % 3;
        for (int i = 0; i < static_cast<int>(kWidth); ++i) {
            const double e = double{xs[p][i]} * double{ys[q][i]} - double{ys[p][i]} * double{xs[q][i]};
            edges[edge][i] = static_cast<float>(e);
        }
    }
    return {load(edges[0]), load(edges[1]), load(edges[2])};
}

RT_FN EdgeFunctions edgeFunctions(const Float8 (&x)[3], const Float8 (&y)[3]) {
    if constexpr (kFusedMultiplyAdd) {
        return {fusedDifference(x[2], y[1], y[2], x[1]), fusedDifference(x[0], y[2], y[0], x[2]),
                fusedDifference(x[1], y[0], y[1], x[0])};
    } else {
        Float8 e[3];
        Mask8 doubtful = x[0] < x[0]; // none yet: what rounding may have given the wrong sign
        for (int edge = 0; edge < 3; ++edge) {
            const int p = (edge + 2) % 3, q = (edge + 1) % 3;
            const Float8 left = x[p] * y[q], right = y[p] * x[q];
            e[edge] = left - right;
            const Float8 bound = (absolute(left) + absolute(right)) * broadcast(2.0f * shared::kEpsilon);
            doubtful = doubtful | (absolute(e[edge]) <= bound);
        }
        if (bits(doubtful) == 0) return {e[0], e[1], e[2]};
        const EdgeFunctions exact = doubleEdgeFunctions(x, y);
        return {select(doubtful, exact.a, e[0]), select(doubtful, exact.b, e[1]), select(doubtful, exact.c, e[2])};
    }
}

RT_FN LaneHits intersectBlock(const ShapeRay& ray, const TriangleBlock& block) {
    const Float8 zero = broadcast(0.0f);
    Float8 x[3], y[3], z[3];
    for (int vertex = 0; vertex < 3; ++vertex) {
        z[vertex] = load(block.vertex[vertex][ray.axis[2]]) - broadcast(ray.origin[ray.axis[2]]);
        x[vertex] = load(block.vertex[vertex][ray.axis[0]]) - broadcast(ray.origin[ray.axis[0]]);
        y[vertex] = load(block.vertex[vertex][ray.axis[1]]) - broadcast(ray.origin[ray.axis[1]]);
        x[vertex] = negateMultiplyAdd(broadcast(ray.shear[0]), z[vertex], x[vertex]);
        y[vertex] = negateMultiplyAdd(broadcast(ray.shear[1]), z[vertex], y[vertex]);
    }
    const EdgeFunctions e = edgeFunctions(x, y);
    const Mask8 inside = (zero <= minimum(e.a, minimum(e.b, e.c))) | (maximum(e.a, maximum(e.b, e.c)) <= zero);
    const Float8 inverse = broadcast(1.0f) / (e.a + e.b + e.c);
    const Float8 depth = multiplyAdd(e.a, z[0], multiplyAdd(e.b, z[1], e.c * z[2]));
    const Float8 t = depth * broadcast(ray.shear[2]) * inverse;
    return {inside & (zero < t), t, e.b * inverse, e.c * inverse};
}

} // namespace
} // namespace rt::accel
