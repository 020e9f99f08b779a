// Intersection of one ray with N primitives of one kind at a time: the formulas of Common/Shared/Shapes.h, lane by
// lane. Lanes hit for t > 0; the caller compares with the far end of its interval.
#pragma once
#include "Common/Accel/AccelView.h"
#include "Common/Accel/Simd.h"
#include "Common/Shared/Features.h"
#include "Common/Shared/Shapes.h"

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

RT_FN ShapeRay makeShapeRay(shared::uint features, const shared::Ray& ray, bool isUnit) {
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

template <int N>
struct Vector {
    Float<N> x, y, z;
};

template <int N>
RT_FN Vector<N> broadcast3(const float (&v)[3]) {
    return {broadcast<N>(v[0]), broadcast<N>(v[1]), broadcast<N>(v[2])};
}

// Lanes `first` to `first` + N - 1 of three components.
template <int N, std::uint32_t B>
RT_FN Vector<N> load3(const float (&v)[3][B], unsigned first) {
    return {load<N>(v[0] + first), load<N>(v[1] + first), load<N>(v[2] + first)};
}

template <int N>
RT_FN Vector<N> operator-(Vector<N> a, Vector<N> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

// c + a b
template <int N>
RT_FN Vector<N> multiplyAdd(Vector<N> a, Float<N> b, Vector<N> c) {
    return {multiplyAdd(a.x, b, c.x), multiplyAdd(a.y, b, c.y), multiplyAdd(a.z, b, c.z)};
}

template <int N>
RT_FN Float<N> dot(Vector<N> a, Vector<N> b) {
    return multiplyAdd(a.z, b.z, multiplyAdd(a.y, b.y, a.x * b.x));
}

template <int N>
struct LaneHits {
    Mask<N> mask;
    Float<N> t, u, v; // meaningful where mask is set
};

template <int N>
RT_FN LaneHits<N> intersectSpheres(const ShapeRay& ray, Vector<N> center, Float<N> radius) {
    const Float<N> zero = broadcast<N>(0.0f);
    const Float<N> inverseA = broadcast<N>(ray.inverseSquaredLength);
    const Vector<N> d = broadcast3<N>(ray.direction);
    const Vector<N> f = center - broadcast3<N>(ray.origin);
    const Float<N> middle = dot(f, d) * inverseA;
    const Float<N> x = negateMultiplyAdd(middle, d.x, f.x);
    const Float<N> y = negateMultiplyAdd(middle, d.y, f.y);
    const Float<N> z = negateMultiplyAdd(middle, d.z, f.z);
    const Float<N> squaredHalf = negateMultiplyAdd(x, x, radius * radius) - multiplyAdd(y, y, z * z);
    const Float<N> halfChord = squareRoot(squaredHalf * inverseA); // not a number beside the sphere
    const Float<N> near = middle - halfChord;
    const Float<N> t = select(zero < near, near, middle + halfChord);
    return {zero < t, t, zero, zero};
}

template <int N, std::uint32_t B>
RT_FN LaneHits<N> intersectBlock(const ShapeRay& ray, const SphereBlock<B>& block, unsigned first) {
    return intersectSpheres<N>(ray, load3<N>(block.center, first), load<N>(block.radius + first));
}

template <int N, std::uint32_t B>
RT_FN LaneHits<N> intersectBlock(const ShapeRay& ray, const MovingSphereBlock<B>& block, unsigned first) {
    const Vector<N> center =
        multiplyAdd(load3<N>(block.motion, first), broadcast<N>(ray.time), load3<N>(block.center, first));
    return intersectSpheres<N>(ray, center, load<N>(block.radius + first));
}

template <int N, std::uint32_t B>
RT_FN LaneHits<N> intersectBlock(const ShapeRay& ray, const QuadBlock<B>& block, unsigned first) {
    const Float<N> half = broadcast<N>(0.5f);
    const Vector<N> d = broadcast3<N>(ray.direction);
    const Vector<N> f = load3<N>(block.corner, first) - broadcast3<N>(ray.origin);
    const Vector<N> normal = load3<N>(block.normal, first);
    const Vector<N> dualU = load3<N>(block.dualU, first);
    const Vector<N> dualV = load3<N>(block.dualV, first);
    const Float<N> t = dot(normal, f) / dot(normal, d);
    const Float<N> u = multiplySubtract(t, dot(dualU, d), dot(dualU, f) + half); // from the middle of the quad
    const Float<N> v = multiplySubtract(t, dot(dualV, d), dot(dualV, f) + half);
    const Float<N> margin = load<N>(block.margin + first) * broadcast<N>(ray.length);
    const Float<N> reach = multiplyAdd(t, margin, broadcast<N>(0.5f + shared::kQuadError));
    const Mask<N> inside = maximum(absolute(u), absolute(v)) <= reach;
    return {inside & (broadcast<N>(0.0f) < t), t, u + half, v + half};
}

// x of p times y of q minus y of p times x of q, for the three edges of triangles in the plane across the ray. Signs
// are those of the exact values (unless those underflow), so the two triangles at an edge always agree on which side of
// it the ray passes.
template <int N>
struct EdgeFunctions {
    Float<N> a, b, c;
};

// With fused multiply-add the error of one product is added back: Jeannerod, Louvet & Muller, "Further analysis of
// Kahan's algorithm for the accurate computation of 2x2 determinants", 2013.
template <int N>
RT_FN Float<N> fusedDifference(Float<N> a, Float<N> b, Float<N> c, Float<N> d) {
    const Float<N> cd = c * d;
    return multiplySubtract(a, b, cd) - multiplySubtract(c, d, cd);
}

// Products of floats are exact in double.
template <int N>
[[maybe_unused]] static EdgeFunctions<N> doubleEdgeFunctions(const Float<N> (&x)[3], const Float<N> (&y)[3]) {
    alignas(4 * N) float xs[3][N], ys[3][N], edges[3][N];
    for (int vertex = 0; vertex < 3; ++vertex) {
        store(xs[vertex], x[vertex]);
        store(ys[vertex], y[vertex]);
    }
    for (int edge = 0; edge < 3; ++edge) {
        const int p = (edge + 2) % 3, q = (edge + 1) % 3;
        for (int i = 0; i < N; ++i) {
            const double e = double{xs[p][i]} * double{ys[q][i]} - double{ys[p][i]} * double{xs[q][i]};
            edges[edge][i] = static_cast<float>(e);
        }
    }
    return {load<N>(edges[0]), load<N>(edges[1]), load<N>(edges[2])};
}

template <int N>
RT_FN EdgeFunctions<N> edgeFunctions(const Float<N> (&x)[3], const Float<N> (&y)[3]) {
    if constexpr (kFusedMultiplyAdd) {
        return {fusedDifference(x[2], y[1], y[2], x[1]), fusedDifference(x[0], y[2], y[0], x[2]),
                fusedDifference(x[1], y[0], y[1], x[0])};
    } else {
        Float<N> e[3];
        Mask<N> doubtful = x[0] < x[0]; // none yet: what rounding may have given the wrong sign
        for (int edge = 0; edge < 3; ++edge) {
            const int p = (edge + 2) % 3, q = (edge + 1) % 3;
            const Float<N> left = x[p] * y[q], right = y[p] * x[q];
            e[edge] = left - right;
            const Float<N> bound = (absolute(left) + absolute(right)) * broadcast<N>(2.0f * shared::kEpsilon);
            doubtful = doubtful | (absolute(e[edge]) <= bound);
        }
        if (bits(doubtful) == 0) return {e[0], e[1], e[2]};
        const EdgeFunctions<N> exact = doubleEdgeFunctions(x, y);
        return {select(doubtful, exact.a, e[0]), select(doubtful, exact.b, e[1]), select(doubtful, exact.c, e[2])};
    }
}

template <int N, std::uint32_t B>
RT_FN LaneHits<N> intersectBlock(const ShapeRay& ray, const TriangleBlock<B>& block, unsigned first) {
    const Float<N> zero = broadcast<N>(0.0f);
    Float<N> x[3], y[3], z[3];
    for (int vertex = 0; vertex < 3; ++vertex) {
        z[vertex] = load<N>(block.vertex[vertex][ray.axis[2]] + first) - broadcast<N>(ray.origin[ray.axis[2]]);
        x[vertex] = load<N>(block.vertex[vertex][ray.axis[0]] + first) - broadcast<N>(ray.origin[ray.axis[0]]);
        y[vertex] = load<N>(block.vertex[vertex][ray.axis[1]] + first) - broadcast<N>(ray.origin[ray.axis[1]]);
        x[vertex] = negateMultiplyAdd(broadcast<N>(ray.shear[0]), z[vertex], x[vertex]);
        y[vertex] = negateMultiplyAdd(broadcast<N>(ray.shear[1]), z[vertex], y[vertex]);
    }
    const EdgeFunctions<N> e = edgeFunctions(x, y);
    const Mask<N> inside = (zero <= minimum(e.a, minimum(e.b, e.c))) | (maximum(e.a, maximum(e.b, e.c)) <= zero);
    const Float<N> inverse = broadcast<N>(1.0f) / (e.a + e.b + e.c);
    const Float<N> depth = multiplyAdd(e.a, z[0], multiplyAdd(e.b, z[1], e.c * z[2]));
    const Float<N> t = depth * broadcast<N>(ray.shear[2]) * inverse;
    return {inside & (zero < t), t, e.b * inverse, e.c * inverse};
}

} // namespace
} // namespace rt::accel
