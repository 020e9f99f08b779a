// Solid angles of shapes by themselves, without a scene.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <pybind11/pybind11.h>

#include "Common/Shared/Shape/SphericalShapes.h"
#include "Python/Arrays.h"
#include "Python/Bindings.h"

namespace rt::python {
namespace {

namespace py = pybind11;
using namespace rt::shared;

// A batch is turned over, component by component, so that compilers make vectors of the loops over its triangles.
constexpr std::size_t kLanes = 16;

struct Vectors {
    float x[kLanes], y[kLanes], z[kLanes];

    shared::vec3 at(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    void set(std::size_t lane, const shared::vec3& v) {
        x[lane] = v.x;
        y[lane] = v.y;
        z[lane] = v.z;
    }
};

// `count` rows from `first` on; lanes beyond repeat the first of them.
void load(const Rows& rows, std::size_t first, std::size_t count, Vectors& vectors) {
    for (std::size_t i = 0; i < kLanes; ++i) vectors.set(i, rows.vec3(first + (i < count ? i : 0)));
}

// A vertex whose largest component is 2^-kRange to 2^kRange has products that stay within float.
constexpr int kRange = 30;
constexpr float kLeast = 0x1p-30f, kMost = 0x1p30f;

// Of all lanes.
bool areInRange(const Vectors& vertices) {
    int others = 0;
    for (std::size_t i = 0; i < kLanes; ++i) {
        const float largest = std::max({std::abs(vertices.x[i]), std::abs(vertices.y[i]), std::abs(vertices.z[i])});
        others |= static_cast<int>(!(largest >= kLeast)) | static_cast<int>(!(largest <= kMost));
    }
    return others == 0;
}

// Of the largest component; INT_MIN: all are 0.
int exponentOf(const shared::vec3& v) {
    const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    int exponent = std::numeric_limits<int>::min();
    if (largest > 0.0f) (void)std::frexp(largest, &exponent);
    return exponent;
}

shared::vec3 scaled(const shared::vec3& v, int exponent) {
    return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

struct Triangles {
    Vectors a, b, c;

    void bringIntoRange() {
        if (areInRange(a) && areInRange(b) && areInRange(c)) return;
        for (std::size_t lane = 0; lane < kLanes; ++lane) bringIntoRange(lane);
    }
    // Powers of two change no direction, and the solid angle is one of directions: a vertex much nearer than others has
    // its own.
    void bringIntoRange(std::size_t lane) {
        Vectors* const vertices[] = {&a, &b, &c};
        int exponents[3];
        for (int i = 0; i < 3; ++i) exponents[i] = exponentOf(vertices[i]->at(lane));
        const auto [least, most] = std::minmax({exponents[0], exponents[1], exponents[2]});
        if (least >= -kRange && most <= kRange) return;
        for (int i = 0; i < 3; ++i) {
            if (exponents[i] == std::numeric_limits<int>::min()) continue;
            const int common = exponents[i] < most - kRange ? exponents[i] : most;
            vertices[i]->set(lane, scaled(vertices[i]->at(lane), -common));
        }
    }

    SphericalTriangle at(std::size_t lane) const {
        const shared::vec3 v0 = a.at(lane), v1 = b.at(lane), v2 = c.at(lane);
        return makeSphericalTriangle(v0, v1, v2, cross(v1 - v0, v2 - v0));
    }
};

// Calls take(first, triangles, n) for one batch after the other.
template <class Take>
void forEachBatch(const Rows& a, const Rows& b, const Rows& c, std::size_t count, const Take& take) {
    Triangles triangles;
    for (std::size_t first = 0; first < count; first += kLanes) {
        const std::size_t n = std::min(kLanes, count - first);
        load(a, first, n, triangles.a);
        load(b, first, n, triangles.b);
        load(c, first, n, triangles.c);
        triangles.bringIntoRange();
        take(first, triangles, n);
    }
}

py::tuple sampleTriangles(const py::object& first, const py::object& second, const py::object& third,
                          const py::object& numbers) {
    const Rows a(first, "a", 3), b(second, "b", 3), c(third, "c", 3);
    const Rows u(numbers, "u", 2, Demand::Fraction);
    const std::size_t count = commonCount({&a, &b, &c, &u});
    NewFloats direction(count, 3), pdf(count);
    {
        const Released released;
        forEachBatch(a, b, c, count, [&](std::size_t begin, const Triangles& triangles, std::size_t n) {
            Vectors samples;
            float angles[kLanes], x[kLanes], y[kLanes];
            for (std::size_t i = 0; i < kLanes; ++i) {
                const shared::vec2 uv = u.vec2(begin + (i < n ? i : 0));
                x[i] = uv.x;
                y[i] = uv.y;
            }
            for (std::size_t i = 0; i < kLanes; ++i) {
                const SphericalTriangle t = triangles.at(i);
                samples.set(i, sampleSphericalTriangle(t, shared::vec2(x[i], y[i])));
                angles[i] = t.solidAngle;
            }
            for (std::size_t i = 0; i < n; ++i) {
                const shared::vec3 d = samples.at(i);
                const bool isSampled = angles[i] > 0.0f && dot(d, d) > 0.5f; // neither is a NaN
                direction.set(begin + i, isSampled ? d : shared::vec3(0.0f));
                pdf.set(begin + i, isSampled ? 1.0f / angles[i] : 0.0f);
            }
        });
    }
    return py::make_tuple(direction.array, pdf.array);
}

py::array triangleSolidAngles(const py::object& first, const py::object& second, const py::object& third) {
    const Rows a(first, "a", 3), b(second, "b", 3), c(third, "c", 3);
    const std::size_t count = commonCount({&a, &b, &c});
    NewFloats angle(count);
    {
        const Released released;
        forEachBatch(a, b, c, count, [&](std::size_t begin, const Triangles& triangles, std::size_t n) {
            float angles[kLanes];
            for (std::size_t i = 0; i < kLanes; ++i) angles[i] = triangles.at(i).solidAngle;
            for (std::size_t i = 0; i < n; ++i) angle.set(begin + i, angles[i] > 0.0f ? angles[i] : 0.0f); // no NaN
        });
    }
    return angle.array;
}

} // namespace

void bindShapes(py::module_& module) {
    module.def("sample_spherical_triangle", &sampleTriangles);
    module.def("triangle_solid_angle", &triangleSolidAngles);
}

} // namespace rt::python
