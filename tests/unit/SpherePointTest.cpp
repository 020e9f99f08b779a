// Where rays meet spheres, against double precision: never farther off the sphere than what leaving rays are offset by.
// Near spheres: NearSphereTest.cpp.
#include <algorithm>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Shared/Shape/Shapes.h"

namespace rt::test {
namespace {

using glm::dvec3;
using shared::vec3;

struct Cast {
    shared::Ray ray;
    float t;
};

double number(std::mt19937& random) {
    return std::uniform_real_distribution<double>(-1, 1)(random);
}

// The ray from near `from` to that point of the sphere that is near `to`.
Cast castRay(vec3 center, float radius, dvec3 from, dvec3 to) {
    const dvec3 c(center);
    const double r = static_cast<double>(radius);
    Cast cast;
    cast.ray.origin = vec3(from);
    cast.ray.direction = vec3(glm::normalize(c + r * glm::normalize(to - c) - from));
    cast.ray.time = 0;
    cast.t = shared::intersectSphere(cast.ray, center, radius, shared::kInfinity);
    return cast;
}

constexpr int kCasts = 200'000;

struct Placement {
    vec3 center;
    float radius;
    dvec3 around;
    double reach;
};

TEST(SpherePointTest, LiesOnTheSphereWithinTheOffset) {
    const Placement placements[] = {{{0, 0, 0}, 1, {0, 0, 0}, 3},
                                    {{0, 0, 0}, 1, {0, 0, 0}, 100},
                                    {{10, 3, 5}, 1e-4f, {10, 3, 5}, 3e-4},
                                    {{1e5f, 0, 0}, 1, {1e5, 0, 0}, 3},
                                    {{-13, -1002, -3}, 1000, {0, 0, 0}, 20},
                                    {{-600, -700, -388}, 1000, {0, 0, 0}, 20},
                                    {{-13, -1002, -3}, 1000, {-13, -1002, -3}, 1100},
                                    {{0, -1e4f, 0}, 1e4f, {300, 2, 5}, 500}};
    for (const Placement& p : placements) {
        std::mt19937 random(1);
        const auto nearby = [&] { return p.around + p.reach * dvec3(number(random), number(random), number(random)); };
        double worst = 0;
        for (int i = 0; i < kCasts; ++i) {
            const dvec3 from = nearby();
            const Cast cast = castRay(p.center, p.radius, from, nearby());
            if (cast.t < 0) continue; // starts on the far side of a tangent
            const shared::SpherePoint point = shared::spherePoint(cast.ray, p.center, p.radius, cast.t);
            const double off = glm::length(dvec3(point.position) - dvec3(p.center)) - static_cast<double>(p.radius);
            worst = std::max(worst, std::abs(off) / static_cast<double>(point.error));
            EXPECT_NEAR(glm::length(point.normal), 1, 1e-6);
        }
        EXPECT_LE(worst, 1) << "radius " << p.radius << " at " << p.center.x << " from " << p.around.x;
    }
}

} // namespace
} // namespace rt::test
