// Whatever the tree, the instruction set and the order of traversal, the answer is that of testing every primitive.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/unit/AccelScene.h"

namespace rt::accel::testing {
namespace {

void addRandomSpheres(Geometry& g, Random& random, int count) {
    for (int i = 0; i < count; ++i) {
        g.addSphere(random.inCube(10.0f), random.uniform(0.05f, 1.5f));
    }
}
void addRandomQuads(Geometry& g, Random& random, int count) {
    for (int i = 0; i < count; ++i) {
        g.addQuad(random.inCube(10.0f), random.direction() * random.uniform(0.1f, 3.0f),
                  random.direction() * random.uniform(0.1f, 3.0f));
    }
}
void addRandomTriangles(Geometry& g, Random& random, int count) {
    for (int i = 0; i < count; ++i) {
        const vec3 a = random.inCube(10.0f);
        g.addTriangle(a, a + random.inCube(1.5f), a + random.inCube(1.5f));
    }
}

// Disks and cylinders, round and elliptic, slanted too.
void addRandomRounds(Geometry& g, Random& random, int count) {
    for (int i = 0; i < count; ++i) {
        const vec3 u = random.direction(), across = shared::normalize(shared::cross(u, random.direction()));
        const float size = random.uniform(0.1f, 2.0f);
        const vec3 v = (across + 0.3f * random.uniform() * u) * random.uniform(0.3f, 1.0f);
        const vec3 axis = shared::normalize(shared::cross(u, v)) + 0.3f * random.uniform() * u;
        if (i % 2 == 0)
            g.addDisk(random.inCube(10.0f), u * size, v * size, i % 4 == 0 ? 0.0f : random.uniform(0.0f, 0.9f));
        else
            g.addCylinder(random.inCube(10.0f), u * size, v * size, axis * random.uniform(0.1f, 3.0f));
    }
}

// Every other ray is aimed at some primitive.
std::vector<Ray> randomRays(const Geometry& g, Random& random, int count) {
    std::vector<vec3> targets;
    for (const shared::Sphere& s : g.spheres) {
        targets.push_back(s.center);
    }
    for (const shared::Quad& q : g.quads) {
        targets.push_back(q.corner + q.edgeU * 0.5f + q.edgeV * 0.5f);
    }
    for (const shared::uvec3& t : g.triangles) {
        targets.push_back((g.positions[t.x] + g.positions[t.y] + g.positions[t.z]) / 3.0f);
    }
    for (const shared::Round& r : g.rounds) targets.push_back(r.origin + 0.95f * r.edgeU);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        Ray ray{random.inCube(14.0f), random.direction(), random.uniform()};
        if (i % 2 == 0) ray.direction = shared::normalize(targets[random.below(targets.size())] - ray.origin);
        rays.push_back(ray);
    }
    return rays;
}

bool sameBits(const Hit& a, const Hit& b) {
    return std::memcmp(&a, &b, sizeof(Hit)) == 0;
}

// The scenes that the traversals are compared on: each kind alone, all together.
struct NamedGeometry {
    std::string name;
    Geometry geometry;
};
std::vector<NamedGeometry> geometries(int count) {
    Random random(7);
    std::vector<NamedGeometry> result(6);
    result[0].name = "spheres";
    addRandomSpheres(result[0].geometry, random, count);
    result[1].name = "moving spheres";
    addRandomSpheres(result[1].geometry, random, count);
    for (int i = 0; i < count; ++i) {
        result[1].geometry.motions.push_back(random.inCube(0.5f));
    }
    result[2].name = "quads";
    addRandomQuads(result[2].geometry, random, count);
    result[3].name = "triangles";
    addRandomTriangles(result[3].geometry, random, count);
    result[4].name = "all kinds";
    addRandomSpheres(result[4].geometry, random, count / 3);
    addRandomQuads(result[4].geometry, random, count / 3);
    addRandomTriangles(result[4].geometry, random, count / 3);
    addRandomRounds(result[4].geometry, random, count / 3);
    result[5].name = "disks and cylinders";
    addRandomRounds(result[5].geometry, random, count);
    return result;
}

TEST(AccelTraversal, TreeFindsExactlyWhatTestingEverythingFinds) {
    for (int count : {3, 40, 1000}) {
        for (NamedGeometry& scene : geometries(count)) {
            const auto tree = buildAccel(scene.geometry);
            const auto linear = buildAccel(scene.geometry, kAlwaysLinear);
            ASSERT_FALSE(tree->view().isLinear);
            ASSERT_TRUE(linear->view().isLinear);
            Random random(11);
            const std::vector<Ray> rays = randomRays(scene.geometry, random, 4000);
            for (const NamedQuery& q : runnableQueries()) {
                SCOPED_TRACE(scene.name + " " + std::to_string(count) + " " + q.name);
                const std::vector<Hit> a = closestHits(*q.query, tree->view(), rays);
                const std::vector<Hit> b = closestHits(*q.query, linear->view(), rays);
                int hits = 0, different = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    hits += a[i].t >= 0.0f;
                    different += !sameBits(a[i], b[i]);
                }
                EXPECT_EQ(different, 0);
                EXPECT_GT(hits, 1500);

                std::vector<float> ends(rays.size());
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    ends[i] = b[i].t < 0.0f ? shared::kInfinity : b[i].t * (i % 2 == 0 ? 0.9999f : 1.0001f);
                }
                const auto anyTree = anyHits(*q.query, tree->view(), rays, ends);
                const auto anyLinear = anyHits(*q.query, linear->view(), rays, ends);
                int wrong = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const std::uint8_t expected = b[i].t >= 0.0f && i % 2 == 1;
                    wrong += anyTree[i] != expected || anyLinear[i] != expected;
                }
                EXPECT_EQ(wrong, 0);
            }
        }
    }
}

TEST(AccelTraversal, BothQuestionsAtOnceHaveTheSameAnswers) {
    for (NamedGeometry& scene : geometries(40)) {
        for (std::uint32_t maxLinear : {0u, kAlwaysLinear}) {
            const auto accel = buildAccel(scene.geometry, maxLinear);
            const AccelView& view = accel->view();
            Random random(13);
            const std::vector<Ray> rays = randomRays(scene.geometry, random, 2000);
            for (const NamedQuery& q : runnableQueries()) {
                SCOPED_TRACE(scene.name + (view.isLinear ? ", linear list, " : ", tree, ") + q.name);
                const Tracer tracer = q.query->tracer(view.kinds);
                int different = 0, wrong = 0, occluded = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    // Every other one along the ray, to end before or behind what it hits.
                    const Ray shadow{rays[i].origin, rays[i % 2 == 0 ? i : rays.size() - 1 - i].direction,
                                     rays[i].time};
                    const float end = i % 8 == 0 ? shared::kInfinity : 10.0f;
                    bool isOccluded = i % 2 == 0;
                    const Hit hit = tracer.both(view, rays[i], shadow.direction, end, isOccluded);
                    different += !sameBits(hit, tracer.closest(view, rays[i], shared::kInfinity));
                    wrong += isOccluded != tracer.occluded(view, shadow, end);
                    occluded += isOccluded;
                }
                EXPECT_EQ(different, 0);
                EXPECT_EQ(wrong, 0);
                EXPECT_GT(occluded, 50);
                EXPECT_LT(occluded, 1950);
            }
        }
    }
}

// Small things of all kinds far from each other in a room.
Geometry scatteredCloud(Random& random) {
    Geometry g;
    for (int i = 0; i < 3000; ++i) {
        g.addSphere(random.inCube(10.0f), 0.02f);
        g.addQuad(random.inCube(10.0f), random.direction() * 0.04f, random.direction() * 0.04f);
        const vec3 a = random.inCube(10.0f);
        g.addTriangle(a, a + random.inCube(0.04f), a + random.inCube(0.04f));
    }
    for (const float y : {-11.0f, 11.0f}) g.addQuad({-11.0f, y, -11.0f}, {22.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 22.0f});
    return g;
}

// A row of boxes along the x axis, more than a traversal can remember, with nothing in them where the axis is.
Geometry emptyBoxes(Random& random) {
    Geometry g;
    for (int i = 0; i < 6000; ++i) {
        const float x = 0.01f * static_cast<float>(i) - 30.0f, s = random.uniform(0.001f, 0.002f);
        const vec3 a(x, s, -0.5f * s), b(x + s, -0.5f * s, s), c(x, s, s);
        if (i % 2 == 0) {
            g.addTriangle(a, b, c);
        } else {
            g.addQuad(a, b - a, c - a);
        }
    }
    g.addSphere({32.0f, 0.0f, 0.0f}, 0.01f);
    return g;
}

TEST(AccelTraversal, QuantizedTreesFindWhatTestingEverythingFinds) {
    Random random(17);
    Geometry scenes[] = {scatteredCloud(random), emptyBoxes(random)};
    for (std::size_t scene = 0; scene < 2; ++scene) {
        Geometry& g = scenes[scene];
        const auto tree = buildAccel(g), linear = buildAccel(g, kAlwaysLinear);
        ASSERT_NE(tree->view().quantizedNodes, nullptr);
        std::vector<Ray> rays = randomRays(g, random, 1000);
        if (scene == 1) {
            for (int i = 0; i < 200; ++i) { // along the axis, to the sphere at its end
                const vec3 origin(-31.0f, random.uniform(-1e-4f, 1e-4f), random.uniform(-1e-4f, 1e-4f));
                rays.push_back({origin, shared::normalize(vec3(32.0f, 0.0f, 0.0f) - origin), 0.0f});
            }
        }
        for (const NamedQuery& q : runnableQueries()) {
            SCOPED_TRACE(std::to_string(scene) + " " + q.name);
            const std::vector<Hit> a = closestHits(*q.query, tree->view(), rays);
            const std::vector<Hit> b = closestHits(*q.query, linear->view(), rays);
            int hits = 0, different = 0;
            std::vector<float> ends(rays.size());
            for (std::size_t i = 0; i < rays.size(); ++i) {
                hits += a[i].t >= 0.0f;
                different += !sameBits(a[i], b[i]);
                ends[i] = b[i].t < 0.0f ? shared::kInfinity : b[i].t * (i % 2 == 0 ? 0.9999f : 1.0001f);
            }
            EXPECT_EQ(different, 0);
            EXPECT_GT(hits, 400);
            const auto any = anyHits(*q.query, tree->view(), rays, ends);
            int wrong = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) wrong += any[i] != (b[i].t >= 0.0f && i % 2 == 1);
            EXPECT_EQ(wrong, 0);
        }
    }
}

// Numerics N6: rays in the planes of flat boxes, along axes and diagonals, with zeros of both signs and denormal
// components.
TEST(AccelTraversal, RaysInThePlanesOfBoxesMissNothing) {
    Geometry g;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            for (int k = 0; k < 6; ++k) {
                const vec3 corner(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
                const int axis = (i + j + k) % 3;
                vec3 u(0.0f), v(0.0f);
                u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1.0f;
                if ((i + 2 * j + k) % 2 == 0) {
                    g.addQuad(corner, u, v);
                } else {
                    g.addTriangle(corner, corner + u, corner + v);
                }
            }
        }
    }
    std::vector<Ray> rays;
    const float components[] = {0.0f, -0.0f, 1.0f, -1.0f, 1e-40f, -1e-40f};
    Random random(41);
    for (const float x : components) {
        for (const float y : components) {
            for (const float z : components) {
                const vec3 d(x, y, z);
                if (!(shared::dot(d, d) > 0.5f)) continue;
                for (int i = 0; i < 60; ++i) { // whole and half coordinates, inside and outside of the lattice
                    const vec3 origin(static_cast<float>(random.below(18)) * 0.5f - 1.0f,
                                      static_cast<float>(random.below(18)) * 0.5f - 1.0f,
                                      static_cast<float>(random.below(18)) * 0.5f - 1.0f);
                    rays.push_back({origin, d / shared::sqrt(shared::dot(d, d)), 0.0f});
                }
            }
        }
    }
    const auto tree = buildAccel(g);
    const auto linear = buildAccel(g, kAlwaysLinear);
    for (const NamedQuery& q : runnableQueries()) {
        SCOPED_TRACE(q.name);
        const std::vector<Hit> a = closestHits(*q.query, tree->view(), rays);
        const std::vector<Hit> b = closestHits(*q.query, linear->view(), rays);
        int different = 0, hits = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            different += !sameBits(a[i], b[i]);
            hits += b[i].t >= 0.0f;
        }
        EXPECT_EQ(different, 0);
        EXPECT_GT(hits, static_cast<int>(rays.size()) / 10);
    }
}

TEST(AccelTraversal, TheFirstOfEquallyNearPrimitivesWins) {
    for (const int copies : {1, 7, 30}) {
        Geometry g; // a triangle under a quad under the pole of a sphere, in one plane
        for (int i = 0; i < copies; ++i) {
            g.addTriangle(vec3(-1.0f, 0.0f, -1.0f), vec3(1.0f, 0.0f, -1.0f), vec3(0.0f, 0.0f, 2.0f));
            g.addQuad(vec3(-2.0f, 0.0f, -2.0f), vec3(4.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 4.0f));
            g.addSphere(vec3(0.0f, -1.0f, 0.0f), 1.0f);
        }
        const std::vector<Ray> rays{{vec3(0.0f, 4.0f, 0.0f), vec3(0.0f, -1.0f, 0.0f), 0.0f},
                                    {vec3(0.25f, 4.0f, 0.25f), vec3(0.0f, -1.0f, 0.0f), 0.0f}};
        for (const std::uint32_t maxLinear : {0u, kAlwaysLinear}) {
            const auto accel = buildAccel(g, maxLinear);
            for (const NamedQuery& q : runnableQueries()) {
                SCOPED_TRACE(q.name + " " + std::to_string(copies) + (maxLinear != 0 ? " linear list" : " tree"));
                const std::vector<Hit> hits = closestHits(*q.query, accel->view(), rays);
                EXPECT_EQ(hits[0].t, 4.0f);
                EXPECT_EQ(hits[0].kind, shared::kSphere);
                EXPECT_EQ(hits[0].primitive, 0u);
                EXPECT_EQ(hits[1].t, 4.0f);
                EXPECT_EQ(hits[1].kind, shared::kQuad);
                EXPECT_EQ(hits[1].primitive, 0u);
            }
        }
    }
}

TEST(AccelTraversal, IntervalsAreOpenAtBothEnds) {
    Geometry g;
    g.addQuad(vec3(-1.0f, 0.0f, -1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 2.0f));
    const vec3 down(0.0f, -1.0f, 0.0f);
    const std::vector<Ray> rays{{vec3(0.0f, 2.0f, 0.0f), down, 0.0f},
                                {vec3(0.0f, 2.0f, 0.0f), down, 0.0f},
                                {vec3(0.0f), down, 0.0f},
                                {vec3(0.0f, -1.0f, 0.0f), down, 0.0f}};
    const std::vector<float> ends{2.0f, 2.0000002f, 10.0f, 10.0f};
    const std::vector<std::uint8_t> expected{0, 1, 0, 0};
    for (const std::uint32_t maxLinear : {0u, kAlwaysLinear}) {
        const auto accel = buildAccel(g, maxLinear);
        for (const NamedQuery& q : runnableQueries()) {
            EXPECT_EQ(anyHits(*q.query, accel->view(), rays, ends), expected);
            std::vector<Hit> hits(rays.size());
            q.query->closest(accel->view(), rays.data(), ends.data(), hits.data(), rays.size());
            for (std::size_t i = 0; i < rays.size(); ++i) {
                EXPECT_EQ(hits[i].t >= 0.0f, expected[i] == 1);
            }
        }
    }
}

TEST(AccelTraversal, AnEmptySceneIsMissed) {
    Geometry g;
    const auto accel = buildAccel(g);
    for (const NamedQuery& q : runnableQueries()) {
        const std::vector<Ray> rays{{vec3(0.0f), vec3(0.0f, 0.0f, 1.0f), 0.0f}};
        EXPECT_LT(closestHits(*q.query, accel->view(), rays)[0].t, 0.0f);
        EXPECT_EQ(anyHits(*q.query, accel->view(), rays, {1.0f})[0], 0);
    }
}

// Numerics N20: a scene twice as large is hit in the same places, bit for bit.
TEST(AccelTraversal, PowersOfTwoScaleExactly) {
    for (NamedGeometry& scene : geometries(300)) {
        Random random(12);
        const std::vector<Ray> rays = randomRays(scene.geometry, random, 3000);
        for (const int exponent : {-20, -13, 4, 20}) {
            const float scale = std::ldexp(1.0f, exponent);
            Geometry scaled = scene.geometry;
            for (shared::Sphere& s : scaled.spheres) {
                s.center *= scale;
                s.radius *= scale;
                if (s.power < shared::kInfinity) s.power *= scale * scale;
            }
            for (vec3& v : scaled.motions) {
                v *= scale;
            }
            for (shared::Quad& quad : scaled.quads) {
                quad.corner *= scale;
                quad.edgeU *= scale;
                quad.edgeV *= scale;
            }
            for (shared::Round& r : scaled.rounds) {
                r.origin *= scale;
                r.edgeU *= scale;
                r.edgeV *= scale;
                if (r.hole < 0.0f) r.axis *= scale;
            }
            for (vec3& v : scaled.positions) {
                v *= scale;
            }
            std::vector<Ray> scaledRays = rays;
            for (Ray& ray : scaledRays) {
                ray.origin *= scale;
            }
            const auto accel = buildAccel(scene.geometry), scaledAccel = buildAccel(scaled);
            for (const NamedQuery& q : runnableQueries()) {
                SCOPED_TRACE(scene.name + " " + q.name + " 2^" + std::to_string(exponent));
                const std::vector<Hit> a = closestHits(*q.query, accel->view(), rays);
                const std::vector<Hit> b = closestHits(*q.query, scaledAccel->view(), scaledRays);
                int different = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    Hit expected = a[i];
                    if (expected.t >= 0.0f) expected.t *= scale;
                    different += !sameBits(expected, b[i]);
                }
                EXPECT_EQ(different, 0);
            }
        }
    }
}

} // namespace
} // namespace rt::accel::testing
