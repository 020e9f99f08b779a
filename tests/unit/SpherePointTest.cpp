// Where rays meet spheres, against double precision: never farther off the sphere than what leaving rays are offset by,
// and near a huge sphere as exact as the ray is, not as the sphere's coordinates.
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
    vec3 center;
    float radius;
    shared::Ray ray;
    float t;
    dvec3 truth; // where the ray as given meets the sphere as given
};

double number(std::mt19937& random) {
    return std::uniform_real_distribution<double>(-1, 1)(random);
}

// The ray from near `from` to that point of the sphere that is near `to`.
Cast castRay(vec3 center, float radius, dvec3 from, dvec3 to) {
    const dvec3 c(center);
    const double r = static_cast<double>(radius);
    Cast cast;
    cast.center = center;
    cast.radius = radius;
    cast.ray.origin = vec3(from);
    cast.ray.direction = vec3(glm::normalize(c + r * glm::normalize(to - c) - from));
    cast.ray.time = 0;
    cast.t = shared::intersectSphere(cast.ray, center, radius, shared::kInfinity);
    const dvec3 d(cast.ray.direction);
    const dvec3 f = dvec3(cast.ray.origin) - c;
    const double a = glm::dot(d, d);
    const double middle = -glm::dot(f, d) / a;
    const double half = std::sqrt(std::max(0.0, middle * middle - (glm::dot(f, f) - r * r) / a));
    cast.truth = dvec3(cast.ray.origin) + d * (static_cast<double>(cast.t) < middle ? middle - half : middle + half);
    return cast;
}

constexpr double kUnit = 0x1p-24; // roundoff of a float
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
        const vec3 size = glm::abs(p.center);
        const double allowed = 8 * kUnit * static_cast<double>(std::max({size.x, size.y, size.z}) + p.radius);
        double worst = 0;
        for (int i = 0; i < kCasts; ++i) {
            const dvec3 from = nearby();
            const Cast cast = castRay(p.center, p.radius, from, nearby());
            if (cast.t < 0) continue; // starts on the far side of a tangent
            const shared::SpherePoint point = shared::spherePoint(cast.ray, p.center, p.radius, cast.t);
            const double off = glm::length(dvec3(point.position) - dvec3(p.center)) - static_cast<double>(p.radius);
            worst = std::max(worst, std::abs(off) / allowed);
            EXPECT_NEAR(glm::length(point.normal), 1, 1e-6);
        }
        EXPECT_LE(worst, 1) << "radius " << p.radius << " at " << p.center.x << " from " << p.around.x;
    }
}

// Seen under an angle that is not grazing, the point keeps the digits of its own coordinates: 100 times more than the
// sphere has.
TEST(SpherePointTest, NearAHugeSphereItIsAsExactAsTheRay) {
    std::mt19937 random(1);
    double worst = 0;
    for (int i = 0; i < kCasts; ++i) {
        const dvec3 target(20 * number(random), -2, 20 * number(random));
        const Cast cast = castRay({-13, -1002, -3}, 1000, dvec3(0), target);
        const dvec3 normal = (cast.truth - dvec3(cast.center)) / 1000.0;
        if (cast.t < 0 || std::abs(glm::dot(normal, dvec3(cast.ray.direction))) < 0.2) continue;
        const vec3 position = shared::spherePoint(cast.ray, cast.center, cast.radius, cast.t).position;
        worst = std::max(worst, glm::length(dvec3(position) - cast.truth));
    }
    EXPECT_GT(worst, 0.0);
    EXPECT_LE(worst, 1e-5); // reprojected from the sphere's coordinates: 1e-4 and more
}

} // namespace
} // namespace rt::test
