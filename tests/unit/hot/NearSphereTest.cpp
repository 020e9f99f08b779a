// Spheres so large that they are the ground: hits, rays that leave them and what stands on them, against long double
// and a form factor, by the shared formula and by every traversal. The spheres are not those of the rounded records but
// those that were authored.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Accel/GpuBvh.h"
#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Scene/SpherePower.h"
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Light/Lights.h"
#include "Common/Shared/Shape/Shapes.h"
#include "tests/unit/AccelScene.h"

namespace rt::accel::testing {
namespace {

using glm::dvec3;
using Long = long double;

struct Planet {
    dvec3 up; // unit, from the centre to the foot of the origin of coordinates
    double radius;
    double height; // of the origin of coordinates above the surface
    shared::Sphere record;

    // Of a point that is given in doubles, without the digits that its distance from the centre would cost.
    double heightOf(const dvec3& p) const {
        const Long r = radius, h = height, along = glm::dot(p, up);
        const Long squared = glm::dot(p, p);
        const Long power = h * (2 * r + h) + 2 * along * (r + h) + squared;
        return static_cast<double>(power / (std::sqrt(power + r * r) + r));
    }
    dvec3 normalAt(const dvec3& p) const { return glm::normalize(p + up * (radius + height)); }
};

Planet makePlanet(const dvec3& up, double radius, double height) {
    const dvec3 center = up * -(radius + height);
    const shared::Sphere record{vec3(center), static_cast<float>(radius), 0, shared::kNone,
                                scene::spherePower(center, radius)};
    EXPECT_LT(record.power, shared::kInfinity);
    return {up, radius, height, record};
}

std::vector<std::pair<std::string, std::vector<float>>> hitsOf(const Planet& planet, const std::vector<Ray>& rays) {
    const shared::Sphere& s = planet.record;
    std::vector<std::pair<std::string, std::vector<float>>> results{{"shared", {}}};
    for (const Ray& ray : rays) {
        results[0].second.push_back(shared::intersectSphere(ray, 1.0f / shared::dot(ray.direction, ray.direction),
                                                            s.center, s.radius, s.power, shared::kInfinity));
    }
    Geometry g;
    g.spheres.push_back(s);
    const auto accel = buildAccel(g, kAlwaysLinear);
    for (const NamedQuery& q : runnableQueries()) {
        results.push_back({q.name, {}});
        for (const Hit& hit : closestHits(*q.query, accel->view(), rays)) results.back().second.push_back(hit.t);
    }
    return results;
}

template <class Visit>
void forEachPlanet(const Visit& visit) {
    for (const double radius : {1.0, 1e3, 1e5, 1e7, 1e9}) {
        for (const dvec3 up : {dvec3(0, 1, 0), glm::normalize(dvec3(3, 1, 2)), glm::normalize(dvec3(1, -1, 1.01))}) {
            for (const double height : {0.0, 1.3e-3, 1.7, 300.7}) {
                if (height > 0.2 * radius) continue;
                SCOPED_TRACE("radius " + std::to_string(radius) + ", up " + std::to_string(up.x) + ", height " +
                             std::to_string(height));
                visit(makePlanet(up, radius, height));
            }
        }
    }
}

// Down to the surface from near the origin of coordinates, steep and grazing.
std::vector<Ray> raysDown(const Planet& planet, Random& random, double reach, int count) {
    std::vector<Ray> rays;
    while (static_cast<int>(rays.size()) < count) {
        const dvec3 origin = dvec3(random.inCube(1.0f)) * reach;
        if (planet.heightOf(dvec3(vec3(origin))) <= 1e-3 * reach) continue;
        const double cosine = std::exp2(random.uniform(-10.0f, 0.0f));
        const dvec3 n = planet.normalAt(origin);
        const dvec3 side = glm::normalize(glm::cross(n, dvec3(random.direction())));
        const dvec3 d = side * std::sqrt(1 - cosine * cosine) - n * cosine;
        rays.push_back({vec3(origin), shared::normalize(vec3(d)), 0.0f});
    }
    return rays;
}

double errorOf(const Ray& ray, float t, float radius) {
    return static_cast<double>(shared::nearSphereError(ray.origin, ray.direction * t, radius));
}

TEST(NearSphere, ErrorsGrowWithTheWayAndNotWithTheRadius) {
    forEachPlanet([](const Planet& planet) {
        Random random(71);
        for (const double reach : {1e-2, 1.0, 100.0}) {
            if (reach > 0.05 * planet.radius) continue;
            const std::vector<Ray> rays = raysDown(planet, random, std::max(reach, 2 * planet.height), 500);
            for (const auto& [name, hits] : hitsOf(planet, rays)) {
                double worst = 0;
                int missed = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const dvec3 o(rays[i].origin), d(rays[i].direction);
                    const double h = planet.heightOf(o), cosine = -glm::dot(planet.normalAt(o), d);
                    const bool passes = cosine * cosine * planet.radius < 2.1 * h; // over the horizon, or nearly
                    missed += hits[i] < 0 && !passes;
                    if (hits[i] < 0 || passes) continue;
                    const double off = planet.heightOf(o + d * static_cast<double>(hits[i]));
                    worst = std::max(worst, std::abs(off) / errorOf(rays[i], hits[i], planet.record.radius));
                }
                EXPECT_EQ(missed, 0) << name;
                EXPECT_LE(worst, 0.5) << name << ": the other half is for the rays that leave";
            }
        }
    });
}

// Also nearly along the surface, and once more after that.
TEST(NearSphere, RaysThatLeaveDoNotMeetItAgain) {
    forEachPlanet([](const Planet& planet) {
        Random random(72);
        const shared::Sphere& s = planet.record;
        for (const double reach : {1e-2, 1.0, 100.0}) {
            if (reach > 0.05 * planet.radius) continue;
            std::vector<Ray> leaving;
            for (const Ray& ray : raysDown(planet, random, std::max(reach, 2 * planet.height), 3000)) {
                const float t = shared::intersectSphere(ray, 1.0f / shared::dot(ray.direction, ray.direction), s.center,
                                                        s.radius, s.power, shared::kInfinity);
                if (t < 0) continue;
                const shared::SpherePoint p = shared::spherePoint(ray, s.center, s.radius, s.power, t);
                EXPECT_NEAR(glm::length(dvec3(p.normal) - planet.normalAt(dvec3(p.position))), 0, 5e-7);
                const vec3 side = shared::normalize(shared::cross(p.normal, random.direction()));
                const float cosine = std::exp2(random.uniform(-20.0f, 0.0f));
                const vec3 d = p.normal * cosine + side * std::sqrt(1 - cosine * cosine);
                leaving.push_back({shared::offsetOrigin(p.position, vec3(p.error), p.normal, d), d, 0.0f});
            }
            ASSERT_GT(leaving.size(), 300u);
            for (const auto& [name, hits] : hitsOf(planet, leaving))
                EXPECT_EQ(std::count_if(hits.begin(), hits.end(), [](float t) { return t > 0; }), 0) << name;
        }
    });
}

// The power serves rays that begin far away no better than the centre does, and these as well.
TEST(NearSphere, FarAwayItIsASphereAsAnyOther) {
    const Planet planet = makePlanet(dvec3(0.6, 0, 0.8), 1, 0);
    const dvec3 center = planet.up * -1.0;
    Random random(73);
    std::vector<Ray> rays;
    for (int i = 0; i < 5000; ++i) {
        const vec3 from = random.direction() * std::exp2(random.uniform(1.0f, 15.0f));
        const vec3 to = vec3(center) + random.direction() * 0.9f;
        rays.push_back({from, shared::normalize(to - from), 0.0f});
    }
    for (const auto& [name, hits] : hitsOf(planet, rays)) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const dvec3 d(rays[i].direction), f = center - dvec3(rays[i].origin);
            const double along = glm::dot(f, d) / glm::dot(d, d);
            const double half = std::sqrt((1 - glm::dot(f - d * along, f - d * along)) / glm::dot(d, d));
            if (!(half > 0.3)) continue; // grazing
            ASSERT_NEAR(static_cast<double>(hits[i]) / (along - half), 1, 2e-6) << name;
        }
    }
}

// Others stand in one block with it, where it leaves lanes free: they are hit where they are without it, bit for bit.
TEST(NearSphere, LeavesHitsOnSpheresBesideItAsTheyAre) {
    Random random(79);
    Geometry alone, together;
    for (int i = 0; i < 11; ++i) alone.addSphere(random.inCube(4.0f) + vec3(0, 9, 0), 1.0f);
    together.spheres = alone.spheres;
    together.spheres.push_back(makePlanet(dvec3(0, 1, 0), 1e3, 1.7).record);
    std::vector<Ray> rays;
    for (int i = 0; i < 5000; ++i) {
        const vec3 to = alone.spheres[random.below(11)].center + random.direction();
        const vec3 from = random.inCube(1.0f) * 0.1f; // which is above the ground, and below the others
        rays.push_back({from, (to - from) * random.uniform(0.5f, 2.0f), 0.0f});
    }
    const auto accel = buildAccel(alone, kAlwaysLinear), accelTogether = buildAccel(together, kAlwaysLinear);
    for (const NamedQuery& q : runnableQueries()) {
        SCOPED_TRACE(q.name);
        const std::vector<Hit> expected = closestHits(*q.query, accel->view(), rays);
        const std::vector<Hit> hits = closestHits(*q.query, accelTogether->view(), rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(hits[i].t, expected[i].t);
            ASSERT_EQ(hits[i].primitive, expected[i].primitive);
        }
    }
}

TEST(NearSphere, ComesFirstInListsOfDevices) {
    Geometry geometry;
    geometry.addSphere(vec3(5.0f, 0.0f, 0.0f), 1.0f);
    geometry.addSphere(vec3(0.0f, -100.0f, 0.0f), 100.0f); // the origin of coordinates is on it
    geometry.addSphere(vec3(0.0f, 0.0f, 9.0f), 2.0f);
    const LinearLists lists = buildGpuBvh(geometry.input())->lists;
    ASSERT_EQ(lists.nearSpheres, 1u);
    ASSERT_EQ(lists.spheres, 2u);
    const std::uint32_t order[] = {1, 0, 2};
    for (std::size_t i = 0; i < std::size(order); ++i) {
        EXPECT_EQ(std::bit_cast<std::uint32_t>(lists.vectors[2 * i + 1].w), order[i]);
        EXPECT_EQ(lists.vectors[2 * i].w < 0, i == 0); // the radius
    }
}

// The sky that a point of the ground sees beside a ball on it, at `x` from where they touch: a ball of radius 1 that
// touches a plane is all above it, and its form factor 1 / (1 + x^2)^(3/2).
TEST(NearSphere, WhatTouchesTheGroundShadowsItToTheContact) {
    constexpr int kStrata = 700;
    for (const double radius : {1e3, 1e5, 1e7}) {
        const Planet planet = makePlanet(glm::normalize(dvec3(1, 7, -2)), radius, 1.3);
        const dvec3 contact = planet.up * -1.3;
        const dvec3 along = glm::normalize(glm::cross(planet.up, dvec3(0.2, 0.3, 0.7)));
        Geometry g;
        g.spheres.push_back(planet.record);
        g.addSphere(vec3(contact + planet.up), 1);
        const auto accel = buildAccel(g, kAlwaysLinear);
        for (const double x : {0.1, 0.3, 1.0}) {
            const dvec3 target = contact + along * x;
            const Ray down{vec3(0.0f), shared::normalize(vec3(target)), 0.0f};
            const shared::Sphere& s = planet.record;
            const float t = shared::intersectSphere(down, 1.0f / shared::dot(down.direction, down.direction), s.center,
                                                    s.radius, s.power, shared::kInfinity);
            const shared::SpherePoint p = shared::spherePoint(down, s.center, s.radius, s.power, t);
            const shared::Frame frame = shared::makeFrame(p.normal);
            const vec3 origin = shared::offsetOrigin(p.position, vec3(p.error), p.normal, p.normal);
            std::vector<Ray> rays;
            for (int i = 0; i < kStrata * kStrata; ++i) {
                const int column = i % kStrata, row = i / kStrata;
                const shared::vec2 u((column + 0.5f) / kStrata, (row + 0.5f) / kStrata);
                rays.push_back({origin, shared::toWorld(frame, shared::sampleCosineHemisphere(u)), 0.0f});
            }
            const std::vector<float> far(rays.size(), 1e6f);
            const std::vector<std::uint8_t> blocked =
                anyHits(*runnableQueries().back().query, accel->view(), rays, far);
            const auto open = static_cast<double>(std::count(blocked.begin(), blocked.end(), 0));
            const double expected = 1 - std::pow(1 + x * x, -1.5);
            EXPECT_NEAR(open / static_cast<double>(rays.size()) / expected, 1, 0.01)
                << "radius " << radius << " at " << x;
        }
    }
}

// Shadow rays to a ground that glows end there, and not where its coordinates round to: what stands on it is in between.
TEST(NearSphere, SamplesOfAGroundThatGlowsLieOnIt) {
    forEachPlanet([](const Planet& planet) {
        if (planet.radius < 1e3) return;
        shared::Light light = scene::sphereLight(planet.record, vec3(0.0f));
        light.emission = vec3(1.0f);
        shared::RenderParams params{};
        Random random(74);
        for (const shared::uint method : {shared::kShapeAuto, shared::kShapeSolidAngle, shared::kShapeProjected}) {
            params.sphereLight = method;
            int useful = 0;
            for (int i = 0; i < 2000; ++i) {
                const dvec3 above = dvec3(random.inCube(1.0f)) + planet.up * (1.1 - planet.height);
                const vec3 position(above), normal = -planet.normalAt(above);
                const shared::LightSample s =
                    shared::sampleLight(shared::kFeatureAll & ~shared::kFeatureMovingSpheres, params, light, position,
                                        normal, 0.0f, {random.uniform(), random.uniform()});
                if (!(s.pdf > 0)) continue;
                ++useful;
                const double error = static_cast<double>(s.error.x);
                EXPECT_LE(std::abs(planet.heightOf(dvec3(s.point))), error);
                EXPECT_LE(error, 1e-5 * (2 + planet.height + static_cast<double>(s.distance)) + 1e-13 * planet.radius);
            }
            if (planet.radius <= 1e5) {
                EXPECT_GT(useful, 1000);
            }
        }
    });
}

} // namespace
} // namespace rt::accel::testing
