// Whatever the tree, the instruction set and the order of traversal, the answer is that of testing every primitive.
#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "AccelScene.h"

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
    std::vector<NamedGeometry> result(5);
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
    return result;
}

TEST(AccelTraversal, TreeFindsExactlyWhatTestingEverythingFinds) {
    for (int count : {3, 40, 1000}) {
        for (NamedGeometry& scene : geometries(count)) {
            const auto tree = buildAccel(scene.geometry);
            const auto flat = buildAccel(scene.geometry, kAlwaysFlat);
            ASSERT_FALSE(tree->view().flat);
            ASSERT_TRUE(flat->view().flat);
            Random random(11);
            const std::vector<Ray> rays = randomRays(scene.geometry, random, 4000);
            for (const NamedQuery& q : runnableQueries()) {
                SCOPED_TRACE(scene.name + " " + std::to_string(count) + " " + q.name);
                const std::vector<Hit> a = closestHits(*q.query, tree->view(), rays);
                const std::vector<Hit> b = closestHits(*q.query, flat->view(), rays);
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
                const auto anyFlat = anyHits(*q.query, flat->view(), rays, ends);
                int wrong = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const std::uint8_t expected = b[i].t >= 0.0f && i % 2 == 1;
                    wrong += anyTree[i] != expected || anyFlat[i] != expected;
                }
                EXPECT_EQ(wrong, 0);
            }
        }
    }
}

}  // namespace
}  // namespace rt::accel::testing
