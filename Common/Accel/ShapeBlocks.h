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
    unsigned axis[3];  // permutation that makes axis[2] the direction's largest component
    float shear[3];    // direction[axis[0]] / direction[axis[2]], likewise axis[1]; 1 / direction[axis[2]]
};

RT_FN ShapeRay makeShapeRay(shared::uint features, const shared::Ray& ray) {
    const shared::vec3 d = ray.direction;
    ShapeRay r{};
    for (int a = 0; a < 3; ++a) {
        r.origin[a] = ray.origin[a];
        r.direction[a] = d[a];
    }
    r.time = ray.time;
    if (shared::has(features, shared::kFeatureSpheres | shared::kFeatureMovingSpheres | shared::kFeatureQuads)) {
        r.squaredLength = shared::dot(d, d);
        r.inverseSquaredLength = 1.0f / r.squaredLength;
    }
    if (shared::has(features, shared::kFeatureQuads)) r.length = shared::sqrt(r.squaredLength);
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
    Float<N> t, u, v;  // meaningful where mask is set
};

template <int N>
RT_FN LaneHits<N> intersectSpheres(const ShapeRay& ray, Vector<N> center, Float<N> radius) {
    const Float<N> zero = broadcast<N>(0.0f);
    const Float<N> inverseA = broadcast<N>(ray.inverseSquaredLength);
    const Vector<N> d = broadcast3<N>(ray.direction);
    const Vector<N> f = center - broadcast3<N>(ray.origin);
    const Float<N> b = dot(f, d);
    const Float<N> back = zero - b * inverseA;
    const Vector<N> l = multiplyAdd(d, back, f);
    const Float<N> squaredRadius = radius * radius;
    const Float<N> discriminant =
        negateMultiplyAdd(l.z, l.z, negateMultiplyAdd(l.y, l.y, negateMultiplyAdd(l.x, l.x, squaredRadius)));
    const Mask<N> meets = zero <= discriminant;
    if (bits(meets) == 0) return {meets, zero, zero, zero};

    const Float<N> root = squareRoot(broadcast<N>(ray.squaredLength) * discriminant);
    const Float<N> q = b + withSign(root, b);
    const Float<N> c = multiplySubtract(radius, radius, dot(f, f));  // minus the product of the roots, times a
    const Float<N> near = (zero - c) / q;
    const Float<N> t = select(zero < near, near, q * inverseA);
    return {meets & (zero < t), t, zero, zero};
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
    const Float<N> u = multiplySubtract(t, dot(dualU, d), dot(dualU, f));
    const Float<N> v = multiplySubtract(t, dot(dualV, d), dot(dualV, f));
    const Float<N> margin = load<N>(block.margin + first) * broadcast<N>(ray.length);
    const Float<N> reach = multiplyAdd(t, margin, broadcast<N>(0.5f + shared::kQuadError));
    const Mask<N> inside = maximum(absolute(u - half), absolute(v - half)) <= reach;
    return {inside & (broadcast<N>(0.0f) < t), t, u, v};
}

// Edge functions of triangles in the plane across the ray, computed again in double where one came out as 0: exactly,
// since products of floats are exact there.
template <int N>
struct EdgeFunctions {
    Float<N> a, b, c;
};

template <int N>
[[maybe_unused]] static EdgeFunctions<N> exactEdgeFunctions(const Float<N> (&x)[3], const Float<N> (&y)[3]) {
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
    EdgeFunctions<N> e{differenceOfProducts(x[2], y[1], y[2], x[1]), differenceOfProducts(x[0], y[2], y[0], x[2]),
                       differenceOfProducts(x[1], y[0], y[1], x[0])};
    if constexpr (!kFusedMultiplyAdd) {
        if (bits((e.a == zero) | (e.b == zero) | (e.c == zero)) != 0) e = exactEdgeFunctions<N>(x, y);
    }
    const Mask<N> inside = (zero <= minimum(e.a, minimum(e.b, e.c))) | (maximum(e.a, maximum(e.b, e.c)) <= zero);
    const Float<N> inverse = broadcast<N>(1.0f) / (e.a + e.b + e.c);
    const Float<N> depth = multiplyAdd(e.a, z[0], multiplyAdd(e.b, z[1], e.c * z[2]));
    const Float<N> t = depth * broadcast<N>(ray.shear[2]) * inverse;
    return {inside & (zero < t), t, e.b * inverse, e.c * inverse};
}

}  // namespace
}  // namespace rt::accel
