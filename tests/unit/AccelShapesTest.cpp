// One primitive, one ray, against the same in long double: the shared formulas and the blocks of every instruction set.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "Common/Shared/Shape/Shapes.h"
#include "tests/unit/AccelScene.h"

namespace rt::accel::testing {
namespace {

using Real = long double;
struct RealVec {
    Real x, y, z;
};
RealVec real(vec3 v) {
    return {v.x, v.y, v.z};
}
RealVec operator-(RealVec a, RealVec b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Real dot(RealVec a, RealVec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Hits of many rays with one sphere, by the shared formula and by every traversal.
std::vector<std::pair<std::string, std::vector<float>>> sphereHits(const shared::Sphere& sphere,
                                                                   const std::vector<Ray>& rays) {
    std::vector<std::pair<std::string, std::vector<float>>> results{{"shared", {}}};
    for (const Ray& ray : rays) {
        results[0].second.push_back(shared::intersectSphere(ray, 1.0f / shared::dot(ray.direction, ray.direction),
                                                            sphere.center, sphere.radius, sphere.power,
                                                            shared::kInfinity));
    }
    Geometry g;
    g.spheres.push_back(sphere);
    const auto accel = buildAccel(g, kAlwaysLinear);
    for (const NamedQuery& q : runnableQueries()) {
        results.push_back({q.name, {}});
        for (const Hit& hit : closestHits(*q.query, accel->view(), rays)) {
            results.back().second.push_back(hit.t);
        }
    }
    return results;
}

// Numerics N1: t and the decision between hit and miss, whatever the ratio of distance to radius.
TEST(Shapes, SpheresAreExactFromAnyDistance) {
    Random random(21);
    for (const Real ratio : {1.001L, 2.0L, 100.0L, 1e3L, 1e4L, 1e5L}) {
        for (const float radius : {1e-4f, 1.0f, 1e4f}) {
            const shared::Sphere sphere{random.inCube(radius), radius, 0, shared::kNone, shared::kInfinity};
            std::vector<Ray> rays;
            for (int i = 0; i < 4000; ++i) {
                // A ray from `ratio` radii away, towards a point at up to 1.05 radii across it.
                const vec3 out = random.direction();
                const vec3 origin = sphere.center + out * static_cast<float>(ratio * radius);
                const vec3 side = shared::normalize(shared::cross(out, random.direction()));
                const float impact = ratio > 1.05L ? random.uniform(0.0f, 1.05f) : random.uniform(0.0f, 0.9f);
                rays.push_back({origin, shared::normalize(sphere.center + side * (impact * radius) - origin), 0.0f});
            }
            for (const auto& [name, hits] : sphereHits(sphere, rays)) {
                SCOPED_TRACE(name + " ratio " + std::to_string(ratio) + " radius " + std::to_string(radius));
                Real squares = 0;
                int compared = 0, wrong = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const RealVec d = real(rays[i].direction), f = real(rays[i].origin) - real(sphere.center);
                    const Real a = dot(d, d), b = -dot(f, d), r = sphere.radius;
                    const Real discriminant = b * b - a * (dot(f, f) - r * r);
                    const Real relativeImpact = std::sqrt((dot(f, f) - b * b / a)) / r;
                    const bool hit = hits[i] >= 0.0f;
                    ASSERT_FALSE(std::isnan(hits[i]));
                    if (hit != (discriminant >= 0)) {
                        wrong += std::abs(relativeImpact - 1) > 2 * shared::kEpsilon * (1 + ratio);
                    } else if (hit && relativeImpact < 0.99L) {
                        const Real t = (dot(f, f) - r * r) / (b + std::sqrt(discriminant));
                        squares += (hits[i] / t - 1) * (hits[i] / t - 1);
                        ++compared;
                    }
                }
                EXPECT_EQ(wrong, 0);
                EXPECT_GT(compared, 1000);
                EXPECT_LE(std::sqrt(squares / compared), ratio < 2.0L ? 1e-4L : 3e-7L);
            }
        }
    }
}

TEST(Shapes, SpheresNeverGiveNaN) {
    const shared::Sphere sphere{vec3(0.25f, -1.0f, 2.0f), 0.5f, 0, shared::kNone, shared::kInfinity};
    std::vector<Ray> rays;
    Random random(22);
    for (const vec3 start : {vec3(0.0f), vec3(0.5f, 0.0f, 0.0f), vec3(0.0f, -0.5f, 0.0f)}) { // centre and surface
        for (const vec3 direction :
             {vec3(1, 0, 0), vec3(0, 0, 1), vec3(-0.0f, 1, 0), vec3(0, -1, 0), random.direction()}) {
            rays.push_back({sphere.center + start, direction, 0.0f});
        }
    }
    for (const auto& [name, hits] : sphereHits(sphere, rays)) {
        SCOPED_TRACE(name);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_FALSE(std::isnan(hits[i]));
            if (i < 5) {
                EXPECT_NEAR(hits[i], 0.5f, 1e-7f);
            }
        }
    }
    for (const float length : {1e-6f, 1e-3f, 1e3f, 1e6f}) { // as under an instance; t counts lengths of the direction
        const Ray ray{vec3(0.25f, -1.0f, 7.0f), vec3(0.0f, 0.0f, -length), 0.0f};
        EXPECT_NEAR(shared::intersectSphere(ray, sphere.center, sphere.radius, shared::kInfinity) * length, 4.5f,
                    2e-6f);
    }
}

// Numerics N3: a ray that starts off its sphere by the error bound leaves it, or crosses it to the far side.
TEST(Shapes, RaysLeaveTheSphereTheyStartFrom) {
    Random random(23);
    for (const shared::Sphere& sphere : {shared::Sphere{{0.0f, 0.0f, 0.0f}, 1.0f, 0, 0, shared::kInfinity},
                                         shared::Sphere{{0.0f, -1000.0f, 0.0f}, 1000.0f, 0, 0, shared::kInfinity},
                                         shared::Sphere{{10.0f, 3.0f, 5.0f}, 1e-4f, 0, 0, shared::kInfinity},
                                         shared::Sphere{{1e5f, 2e4f, -3e3f}, 1.0f, 0, 0, shared::kInfinity}}) {
        const vec3 c = shared::abs(sphere.center);
        const float offset = 8.0f * shared::kEpsilon * (shared::max(c.x, shared::max(c.y, c.z)) + sphere.radius);
        std::vector<Ray> outward, inward;
        for (int i = 0; i < 20000; ++i) {
            const vec3 n = random.direction();
            const vec3 side = shared::normalize(shared::cross(n, random.direction()));
            const float cosine = i % 2 == 0 ? random.uniform(1e-4f, 1e-2f) : random.uniform(0.01f, 1.0f);
            const vec3 d = n * cosine + side * std::sqrt(1.0f - cosine * cosine);
            const vec3 point = sphere.center + n * sphere.radius;
            const vec3 margin = offset * vec3(shared::dot(shared::abs(n), vec3(1.0f)));
            outward.push_back({point + n * margin, shared::normalize(d), 0.0f});
            inward.push_back({point - n * margin, shared::normalize(d - n * (2.0f * cosine)), 0.0f});
        }
        for (const auto& [name, hits] : sphereHits(sphere, outward)) {
            SCOPED_TRACE(name);
            EXPECT_EQ(std::count_if(hits.begin(), hits.end(), [](float t) { return t >= 0.0f; }), 0);
        }
        if (c.x > 1e4f * sphere.radius || sphere.radius < 1e-3f) continue; // the offset is of the size of short chords
        for (const auto& [name, hits] : sphereHits(sphere, inward)) {
            SCOPED_TRACE(name);
            int wrong = 0;
            for (std::size_t i = 0; i < inward.size(); ++i) {
                const RealVec f = real(inward[i].origin) - real(sphere.center);
                const Real b = -dot(f, real(inward[i].direction)), r = sphere.radius;
                const Real chord = b + std::sqrt(b * b - dot(f, f) + r * r);
                wrong += hits[i] < 0.5L * chord || hits[i] > 1.5L * chord;
            }
            EXPECT_EQ(wrong, 0);
        }
    }
}

// The blocks agree with the shared formulas, which the GPU uses.
TEST(Shapes, BlocksAgreeWithTheSharedFormulas) {
    Random random(24);
    Geometry quads, triangles;
    quads.addQuad(vec3(-1.0f, 0.3f, -1.0f), vec3(2.0f, 0.4f, 0.1f), vec3(0.3f, 0.1f, 1.9f));
    triangles.addTriangle(vec3(-1.0f, 0.0f, -1.0f), vec3(1.5f, 0.2f, -1.0f), vec3(0.0f, 0.3f, 1.0f));
    std::vector<Ray> rays;
    for (int i = 0; i < 20000; ++i) {
        rays.push_back({random.inCube(2.0f) + vec3(0.0f, 3.0f, 0.0f), random.direction(), 0.0f});
        rays.back().direction.y = -std::abs(rays.back().direction.y);
    }
    const shared::Quad& quad = quads.quads[0];
    const shared::QuadFrame frame = shared::quadFrame(quad.edgeU, quad.edgeV);
    const auto quadAccel = buildAccel(quads, kAlwaysLinear);
    const auto triangleAccel = buildAccel(triangles, kAlwaysLinear);
    for (const NamedQuery& q : runnableQueries()) {
        SCOPED_TRACE(q.name);
        const std::vector<Hit> a = closestHits(*q.query, quadAccel->view(), rays);
        const std::vector<Hit> b = closestHits(*q.query, triangleAccel->view(), rays);
        int quadHits = 0, triangleHits = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const shared::ShapeHit onQuad = shared::intersectQuad(rays[i], quad.corner, frame, shared::kInfinity);
            const shared::ShapeHit onTriangle = shared::intersectTriangle(
                rays[i], triangles.positions[0], triangles.positions[1], triangles.positions[2], shared::kInfinity);
            ASSERT_NEAR(a[i].t, onQuad.t, 1e-5f);
            ASSERT_NEAR(b[i].t, onTriangle.t, 1e-5f);
            if (onQuad.t >= 0.0f) {
                ++quadHits;
                ASSERT_NEAR(a[i].u, onQuad.u, 1e-5f);
                ASSERT_NEAR(a[i].v, onQuad.v, 1e-5f);
                const vec3 p = quad.corner + quad.edgeU * a[i].u + quad.edgeV * a[i].v;
                ASSERT_LT(shared::length(p - (rays[i].origin + rays[i].direction * a[i].t)), 1e-5f);
            }
            if (onTriangle.t >= 0.0f) {
                ++triangleHits;
                ASSERT_NEAR(b[i].u, onTriangle.u, 1e-5f);
                ASSERT_NEAR(b[i].v, onTriangle.v, 1e-5f);
                const vec3 p = triangles.positions[0] * (1.0f - b[i].u - b[i].v) + triangles.positions[1] * b[i].u +
                               triangles.positions[2] * b[i].v;
                ASSERT_LT(shared::length(p - (rays[i].origin + rays[i].direction * b[i].t)), 1e-5f);
            }
        }
        EXPECT_GT(quadHits, 1000);
        EXPECT_GT(triangleHits, 500);
    }
}

// A strip is as long and as wide as its edges say: what rounding asks for along the short ones must not lengthen the
// long ones.
TEST(Shapes, StripsEndWhereTheirEdgesAre) {
    Random random(25);
    Geometry strip;
    const vec3 corner(100.0f, 554.0f, 127.0f);
    strip.addQuad(corner, vec3(355.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 10.0f));
    const auto accel = buildAccel(strip, kAlwaysLinear);
    const float offset =
        8.0f * shared::kEpsilon * 1200.0f; // more than the errors of ray and strip at the greatest distance
    std::vector<Ray> outside, inside;
    for (int i = 0; i < 20000; ++i) {
        const vec3 origin(555.0f * random.uniform(), 400.0f * random.uniform(), 1000.0f * random.uniform() - 500.0f);
        const float along = 2.0f * random.uniform() - 1.0f;
        const shared::vec2 edge = i % 2 == 0 ? shared::vec2(177.5f * along, i % 4 == 0 ? 5.0f : -5.0f)
                                             : shared::vec2(i % 4 == 1 ? 177.5f : -177.5f, 5.0f * along);
        const shared::vec2 outward = i % 2 == 0 ? shared::vec2(0.0f, edge.y > 0.0f ? offset : -offset)
                                                : shared::vec2(edge.x > 0.0f ? offset : -offset, 0.0f);
        const auto rayTo = [&](shared::vec2 p) {
            const vec3 target = corner + vec3(177.5f + p.x, 0.0f, 5.0f + p.y);
            return Ray{origin, shared::normalize(target - origin), 0.0f};
        };
        outside.push_back(rayTo(edge + outward));
        inside.push_back(rayTo(edge - outward));
    }
    for (const NamedQuery& q : runnableQueries()) {
        SCOPED_TRACE(q.name);
        for (const Hit& hit : closestHits(*q.query, accel->view(), outside)) ASSERT_LT(hit.t, 0.0f);
        for (const Hit& hit : closestHits(*q.query, accel->view(), inside)) ASSERT_GT(hit.t, 0.0f);
    }
}

TEST(Shapes, MovingSpheresAreWhereTheyAreAtTheTimeOfTheRay) {
    Geometry g;
    g.addSphere(vec3(0.0f), 1.0f);
    g.motions.emplace_back(0.0f, 4.0f, 0.0f);
    for (const std::uint32_t maxLinear : {0u, kAlwaysLinear}) {
        const auto accel = buildAccel(g, maxLinear);
        for (const NamedQuery& q : runnableQueries()) {
            const auto hits = closestHits(*q.query, accel->view(),
                                          {{vec3(5.0f, 2.0f, 0.0f), vec3(-1.0f, 0.0f, 0.0f), 0.0f},
                                           {vec3(5.0f, 2.0f, 0.0f), vec3(-1.0f, 0.0f, 0.0f), 0.5f},
                                           {vec3(5.0f, 3.5f, 0.0f), vec3(-1.0f, 0.0f, 0.0f), 0.875f}});
            EXPECT_LT(hits[0].t, 0.0f);
            EXPECT_EQ(hits[1].t, 4.0f);
            EXPECT_EQ(hits[2].t, 4.0f);
        }
    }
}

} // namespace
} // namespace rt::accel::testing
