// Placed geometry is hit where the same geometry, transformed, is (numerics N11).
#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include "tests/unit/AccelScene.h"

namespace rt::accel::testing {
namespace {

// x' = linear x + shift
struct Placement {
    glm::dmat3 linear;
    glm::dvec3 shift;

    glm::dvec3 operator()(glm::dvec3 p) const { return linear * p + shift; }
};

shared::Instance makeInstance(const Placement& place, std::uint32_t geometry) {
    const glm::dmat3 inverse = glm::inverse(place.linear);
    const glm::dvec3 back = -(inverse * place.shift);
    shared::Instance instance{};
    for (int row = 0; row < 3; ++row) {
        instance.toWorld[row] = {place.linear[0][row], place.linear[1][row], place.linear[2][row], place.shift[row]};
        instance.toObject[row] = {inverse[0][row], inverse[1][row], inverse[2][row], back[row]};
    }
    instance.geometry = geometry;
    instance.material = shared::kNone;
    return instance;
}

glm::dmat3 rotation(Random& random) {
    const glm::dvec3 a = random.direction();
    const glm::dvec3 b = glm::normalize(glm::cross(a, glm::dvec3(random.direction())));
    return {a, b, glm::cross(a, b)};
}

TEST(AccelInstances, AreHitLikeTransformedGeometry) {
    Random random(51);
    Geometry placed, baked;
    for (int i = 0; i < 40; ++i) { // the world's own, in both
        const vec3 a = random.inCube(12.0f);
        const vec3 b = a + random.inCube(2.0f), c = a + random.inCube(2.0f);
        placed.addTriangle(a, b, c);
        baked.addTriangle(a, b, c);
    }
    placed.geometries.push_back({0, 0, 0, 0, 0, 40, 0, 0});
    std::vector<Placement> places;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> origin(40, {shared::kNone, 0}); // of each baked triangle
    for (std::uint32_t g = 1; g <= 3; ++g) {
        const std::uint32_t first = static_cast<std::uint32_t>(placed.triangles.size());
        for (int i = 0; i < 30; ++i) {
            const vec3 a = random.inCube(1.0f);
            placed.addTriangle(a, a + random.inCube(0.5f), a + random.inCube(0.5f));
        }
        placed.geometries.push_back({0, 0, 0, 0, first, 30, 0, 0});
    }
    placed.geometries.push_back({}); // empty
    for (std::uint32_t i = 0; i < 60; ++i) {
        const std::uint32_t g = 1 + i % 4;
        glm::dmat3 scale(0.0);
        for (int a = 0; a < 3; ++a) {
            scale[a][a] = random.uniform(0.5f, 2.0f) * (random.uniform() < 0.3f ? -1.0 : 1.0);
        }
        const Placement place{rotation(random) * scale * rotation(random), glm::dvec3(random.inCube(10.0f))};
        placed.instances.push_back(makeInstance(place, g));
        const shared::Geometry& own = placed.geometries[g];
        for (std::uint32_t t = own.firstTriangle; t < own.firstTriangle + own.triangleCount; ++t) {
            const shared::uvec3 v = placed.triangles[t];
            baked.addTriangle(place(placed.positions[v.x]), place(placed.positions[v.y]), place(placed.positions[v.z]));
            origin.emplace_back(i, t);
        }
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 20000; ++i) {
        const vec3 start = random.inCube(14.0f);
        const vec3 target = placed.instances[random.below(60)].toWorld[0].w * vec3(1, 0, 0) + random.inCube(10.0f);
        rays.push_back({start, shared::normalize(target - start), 0.0f});
    }
    const auto placedAccel = buildAccel(placed), bakedAccel = buildAccel(baked);
    for (const NamedQuery& q : runnableQueries()) {
        SCOPED_TRACE(q.name);
        const std::vector<Hit> a = closestHits(*q.query, placedAccel->view(), rays);
        const std::vector<Hit> b = closestHits(*q.query, bakedAccel->view(), rays);
        int instanceHits = 0, otherHits = 0;
        std::vector<float> ends(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ends[i] = a[i].t < 0.0f ? shared::kInfinity : a[i].t * (i % 2 == 0 ? 0.999f : 1.001f);
            if (b[i].t < 0.0f || a[i].t < 0.0f) {
                otherHits += b[i].t >= 0.0f || a[i].t >= 0.0f; // only a ray along an edge may differ
                continue;
            }
            const auto [instance, primitive] = origin[b[i].primitive];
            if (instance == shared::kNone ? a[i].primitive != b[i].primitive : a[i].primitive != primitive) {
                ++otherHits;
                continue;
            }
            EXPECT_EQ(a[i].instance, instance);
            EXPECT_NEAR(a[i].t, b[i].t, 2e-5f * std::max(1.0f, b[i].t));
            instanceHits += instance != shared::kNone;
        }
        EXPECT_GT(instanceHits, 2000);
        EXPECT_LE(otherHits, 5);
        const auto any = anyHits(*q.query, placedAccel->view(), rays, ends);
        int wrong = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            wrong += any[i] != (a[i].t >= 0.0f && i % 2 == 1);
        }
        EXPECT_EQ(wrong, 0);
    }
}

TEST(AccelInstances, TiesGoToTheWorldAndThenToTheFirstInstance) {
    Geometry g;
    g.addQuad(vec3(-1.0f, 0.0f, -1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 2.0f));
    g.addQuad(vec3(-1.0f, 0.0f, -1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 2.0f));
    for (const bool inWorld : {false, true}) {
        g.geometries = {{0, 0, 0, inWorld ? 1u : 0u, 0, 0, 0, 0}, {0, 0, 1, 1, 0, 0, 0, 0}};
        g.instances.assign(12, makeInstance({glm::dmat3(1.0), glm::dvec3(0.0)}, 1));
        const auto accel = buildAccel(g);
        for (const NamedQuery& q : runnableQueries()) {
            const Hit hit =
                closestHits(*q.query, accel->view(), {{vec3(0.5f, 3.0f, 0.5f), vec3(0.0f, -1.0f, 0.0f), 0.0f}})[0];
            EXPECT_EQ(hit.t, 3.0f);
            EXPECT_EQ(hit.instance, inWorld ? shared::kNone : 0u);
            EXPECT_EQ(hit.primitive, inWorld ? 0u : 1u);
        }
    }
}

TEST(AccelInstances, OfNothingAreNotThere) {
    Geometry g;
    g.geometries = {{}, {}};
    g.instances.assign(3, makeInstance({glm::dmat3(1.0), glm::dvec3(0.0)}, 1));
    const auto accel = buildAccel(g);
    for (const NamedQuery& q : runnableQueries()) {
        EXPECT_LT(closestHits(*q.query, accel->view(), {{vec3(0.0f), vec3(1.0f, 0.0f, 0.0f), 0.0f}})[0].t, 0.0f);
    }
}

} // namespace
} // namespace rt::accel::testing
