// The tree of the compute engine: complete, its boxes hold what is below them, and its depth is what a traversal needs.
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Accel/Build/PrimitiveBoxes.h"
#include "Common/Accel/GpuBvh.h"
#include "Common/Shared/Shape/Shapes.h"
#include "tests/unit/AccelScene.h"

namespace rt::accel {
namespace {

using testing::Geometry;
using testing::mixture;
using testing::placedAt;
using testing::Random;

GpuBvhSettings alwaysTrees() {
    GpuBvhSettings settings;
    settings.maxLinear = 0;
    return settings;
}

// Walks all that can be reached from a reference, counting visits and checking boxes.
class Walk {
  public:
    Walk(const AccelInput& input, const GpuTrees& trees) : input_(input), trees_(trees) {
        spheres.resize(input.spheres.size());
        quads.resize(input.quads.size());
        triangles.resize(input.triangles.size());
        instances.resize(input.instances.size());
        Box everything;
        everything.lower = shared::vec3(-shared::kInfinity);
        everything.upper = shared::vec3(shared::kInfinity);
        visit(trees.root, everything, 0, true);
    }

    std::vector<int> spheres, quads, triangles, instances; // how often each was met
    std::uint32_t depth = 0;
    std::uint32_t missing = 0; // children that nodes lack of two, or before others

  private:
    static bool contains(const Box& outer, const Box& inner) {
        for (int a = 0; a < 3; ++a) {
            if (!(outer.lower[a] <= inner.lower[a] && inner.upper[a] <= outer.upper[a])) return false;
        }
        return true;
    }
    static Box childBox(const shared::TreeNode& node, int child) {
        const shared::vec3 middle(node.x[2 * child], node.y[2 * child], node.z[2 * child]);
        const shared::vec3 half(node.x[2 * child + 1], node.y[2 * child + 1], node.z[2 * child + 1]);
        return {middle - half, middle + half};
    }
    static Box childBox(const shared::WideTreeNode& node, int child) {
        const shared::vec3 middle(node.middleX[child], node.middleY[child], node.middleZ[child]);
        const shared::vec3 half(node.halfX[child], node.halfY[child], node.halfZ[child]);
        return {middle - half, middle + half};
    }
    // What lies in both: nodes are larger than what is below them by a few roundings of their own.
    static Box common(const Box& a, const Box& b) {
        return {shared::max(a.lower, b.lower), shared::min(a.upper, b.upper)};
    }

    // What is found in instances counts, but its boxes are of another space than the world's.
    void visit(std::uint32_t reference, const Box& box, std::uint32_t above, bool world) {
        depth = std::max(depth, above);
        if ((reference & shared::kTreeLeaf) == 0) {
            if (trees_.placed.isWide)
                visitChildren(trees_.wideNodes, reference, box, above, world);
            else
                visitChildren(trees_.nodes, reference, box, above, world);
            return;
        }
        const std::uint32_t first = shared::treeLeafFirst(reference);
        for (std::uint32_t i = first; i < first + shared::treeLeafCount(reference); ++i) {
            visitItem(shared::treeLeafKind(reference), i, box, above, world);
        }
    }

    template <class Node>
    void visitChildren(const std::vector<Node>& nodes, std::uint32_t index, const Box& box, std::uint32_t above,
                       bool world) {
        ASSERT_LT(index, nodes.size());
        const shared::uvec4& children = nodes[index].children;
        std::uint32_t count = 0;
        int end = 2; // behind the last child
        for (int child = 0; child < 4; ++child) {
            if (children[child] == shared::kTreeNothing) continue;
            ++count;
            end = std::max(end, child + 1);
        }
        missing += static_cast<std::uint32_t>(end) - count;
        for (int child = 0; child < end; ++child) {
            const Box own = childBox(nodes[index], child);
            if (children[child] == shared::kTreeNothing)
                EXPECT_GT(own.lower.x, own.upper.x) << "no ray enters";
            else
                visit(children[child], common(box, own), above + count - 1, world);
        }
    }

    void visitItem(std::uint32_t kind, std::uint32_t i, const Box& box, std::uint32_t above, bool world) {
        if (kind == shared::kSphere) {
            const std::uint32_t index = trees_.sphereIndices.at(i);
            const shared::vec3 motion =
                trees_.sphereMotions.empty() ? shared::vec3(0.0f) : shared::vec3(trees_.sphereMotions[i]);
            const shared::vec4 sphere = trees_.spheres.at(i);
            EXPECT_EQ(shared::vec3(sphere), input_.spheres[index].center);
            EXPECT_EQ(std::abs(sphere.w), input_.spheres[index].radius);
            EXPECT_EQ(sphere.w < 0.0f, input_.spheres[index].power < shared::kInfinity);
            if (!input_.motions.empty()) {
                EXPECT_EQ(motion, input_.motions[index]);
            }
            EXPECT_TRUE(contains(box, boxOf(input_.spheres[index], motion)));
            ++spheres[index];
        } else if (kind == shared::kQuad) {
            const std::uint32_t index = std::bit_cast<std::uint32_t>(trees_.quads.at(i).normal.w);
            EXPECT_EQ(shared::vec3(trees_.quads[i].corner), input_.quads[index].corner);
            EXPECT_TRUE(contains(box, boxOf(input_.quads[index])));
            ++quads[index];
        } else if (kind == shared::kTriangle) {
            const shared::TreeTriangle& t = trees_.triangles.at(i);
            const std::uint32_t index = std::bit_cast<std::uint32_t>(t.vertex0.w);
            EXPECT_EQ(shared::vec3(t.vertex2), input_.positions[input_.triangles[index].z]);
            EXPECT_TRUE(
                contains(box, boxOf(shared::vec3(t.vertex0), shared::vec3(t.vertex1), shared::vec3(t.vertex2))));
            ++triangles[index];
        } else {
            ASSERT_TRUE(world) << "instances are one level deep";
            ++instances.at(i);
            Box everything;
            everything.lower = shared::vec3(-shared::kInfinity);
            everything.upper = shared::vec3(shared::kInfinity);
            visit(trees_.instanceRoots.at(i), everything, above + 1, false);
        }
    }

    const AccelInput& input_;
    const GpuTrees& trees_;
};

bool allMet(const std::vector<int>& visits, int times) {
    return std::all_of(visits.begin(), visits.end(), [times](int n) { return n == times; });
}

void expectComplete(const AccelInput& input, const GpuBvh& bvh) {
    ASSERT_FALSE(bvh.isLinear);
    const Walk walk(input, bvh.trees);
    EXPECT_TRUE(allMet(walk.spheres, 1));
    EXPECT_TRUE(allMet(walk.quads, 1));
    EXPECT_TRUE(allMet(walk.triangles, 1));
    EXPECT_EQ(walk.depth, bvh.trees.depth);
    EXPECT_EQ(walk.missing, 0u);
}

TEST(GpuBvh, HoldsEveryPrimitiveOnce) {
    for (const std::size_t count : {1u, 2u, 3u, 5u, 64u, 1000u, 100000u}) {
        Geometry geometry = mixture(count, 7);
        const AccelInput input = geometry.input();
        expectComplete(input, *buildGpuBvh(input, alwaysTrees()));
    }
}

TEST(GpuBvh, OfMostlyTrianglesHasFourChildrenANode) {
    for (const std::size_t count : {3u, 4u, 5u, 64u, 1000u, 100000u}) {
        Geometry geometry = mixture(count, 7, 4);
        const AccelInput input = geometry.input();
        const GpuBvh bvh = *buildGpuBvh(input, alwaysTrees());
        const bool isWide = input.triangles.size() > input.spheres.size() + input.quads.size();
        EXPECT_EQ(bvh.trees.placed.isWide, isWide) << count;
        EXPECT_EQ(isWide, bvh.trees.nodes.empty()) << count;
        expectComplete(input, bvh);
        if (count < 1000) continue;
        EXPECT_LT(bvh.trees.wideNodes.size(), count / 2); // of two children it would be nearly one for each primitive
    }
}

TEST(GpuBvh, HoldsSpheresOverTheirWholeMotion) {
    Geometry geometry = mixture(300, 3);
    Random random(5);
    for (std::size_t i = 0; i < geometry.spheres.size(); ++i) geometry.motions.push_back(random.inCube(2.0f));
    const AccelInput input = geometry.input();
    const GpuBvh bvh = *buildGpuBvh(input, alwaysTrees());
    EXPECT_EQ(bvh.trees.sphereMotions.size(), bvh.trees.spheres.size());
    expectComplete(input, bvh);
}

TEST(GpuBvh, OfPrimitivesInOnePlace) {
    Geometry geometry;
    for (int i = 0; i < 1000; ++i) geometry.addSphere(shared::vec3(1.0f, 2.0f, 3.0f), 1.0f);
    const AccelInput input = geometry.input();
    expectComplete(input, *buildGpuBvh(input, alwaysTrees()));
}

// Whether a ray enters a child's box, as the shaders find by clipSlab(): in floats, with reciprocals that are off by up
// to 2.5 ulp, as Vulkan allows.
bool shadersEnter(const shared::TreeNode& node, int child, const shared::Ray& ray, Random& random) {
    const shared::vec4 slabs[3] = {node.x, node.y, node.z};
    float entry = 0.0f, leave = 1e30f;
    for (int a = 0; a < 3; ++a) {
        float inverse = shared::slabInverse(ray.direction[a]);
        inverse *= 1.0f + random.uniform(-4.0f, 4.0f) * shared::kEpsilon;
        const float middle = (slabs[a][2 * child] - ray.origin[a]) * inverse;
        const float reach = slabs[a][2 * child + 1] * std::abs(inverse);
        entry = std::max(entry, middle - reach);
        leave = std::min(leave, middle + reach);
    }
    return entry <= leave * shared::kSlabMargin;
}

// Whether a ray meets a box, in double: then shadersEnter() must be true.
bool enters(const Box& box, const shared::Ray& ray) {
    double entry = 0, leave = 1e30;
    for (int a = 0; a < 3; ++a) {
        const double inverse = 1 / double{ray.direction[a]};
        const double lower = (double{box.lower[a]} - ray.origin[a]) * inverse;
        const double upper = (double{box.upper[a]} - ray.origin[a]) * inverse;
        entry = std::max(entry, std::min(lower, upper));
        leave = std::min(leave, std::max(lower, upper));
    }
    return entry <= leave;
}

// A point of one of a box's edges.
shared::vec3 onEdge(const Box& box, Random& random) {
    shared::vec3 point;
    const int along = static_cast<int>(random.below(3));
    for (int a = 0; a < 3; ++a) point[a] = random.below(2) == 0 ? box.lower[a] : box.upper[a];
    point[along] = box.lower[along] + (box.upper[along] - box.lower[along]) * random.uniform();
    return point;
}

// Rays that graze a box's edges, from afar and from beside it, and rays that begin on its faces.
TEST(GpuBvh, ShadersEnterEveryBoxThatARayMeets) {
    Random random(23);
    int met = 0, missed = 0;
    for (int i = 0; i < 3000; ++i) {
        Geometry geometry;
        const float size = std::exp2(random.uniform(-12.0f, 6.0f));
        geometry.addSphere(random.inCube(1000.0f), size);
        geometry.addSphere(random.inCube(1000.0f), size);
        const AccelInput input = geometry.input();
        GpuBvhSettings settings = alwaysTrees();
        settings.tree.maxLeafSize = 1;
        const GpuTrees trees = buildGpuBvh(input, settings)->trees;
        ASSERT_EQ(trees.nodes.size(), 1u);
        const std::uint32_t first = trees.sphereIndices[shared::treeLeafFirst(trees.nodes[0].children[0])];
        const Box box = boxOf(geometry.spheres[first]);
        for (int k = 0; k < 100; ++k) {
            const float distance = size * std::exp2(random.uniform(-4.0f, 12.0f));
            shared::Ray ray;
            ray.origin = k % 2 == 0 ? onEdge(box, random) + random.direction() * distance : onEdge(box, random);
            ray.direction = shared::normalize(onEdge(box, random) - ray.origin);
            ray.time = 0.0f;
            if (!enters(box, ray)) continue;
            ++met;
            if (!shadersEnter(trees.nodes[0], 0, ray, random)) ++missed;
        }
    }
    EXPECT_GT(met, 100000);
    EXPECT_EQ(missed, 0);
}

TEST(GpuBvh, SmallScenesAreLists) {
    Geometry geometry = mixture(20, 11);
    const GpuBvh bvh = *buildGpuBvh(geometry.input());
    ASSERT_TRUE(bvh.isLinear);
    EXPECT_EQ(bvh.lists.spheres, geometry.spheres.size());
    EXPECT_EQ(bvh.lists.quads, geometry.quads.size());
    EXPECT_EQ(bvh.lists.triangles, geometry.triangles.size());
    ASSERT_EQ(bvh.lists.vectors.size(),
              2 * geometry.spheres.size() + 4 * geometry.quads.size() + 3 * geometry.triangles.size());
    const std::size_t quad = 2 * geometry.spheres.size() + 4; // the second one
    EXPECT_EQ(std::bit_cast<std::uint32_t>(bvh.lists.vectors[quad + 1].w), 1u);
    EXPECT_EQ(shared::vec3(bvh.lists.vectors[quad]), geometry.quads[1].corner);
    EXPECT_FALSE(buildGpuBvh(mixture(shared::kMaxListedPrimitives + 1, 11).input())->isLinear);
}

// A ground is one; what is as near to the origin of coordinates but small stays in the tree.
TEST(GpuBvh, NearSpheresThatMostRaysMeetAreListedBesideTheTree) {
    for (const std::size_t trianglesPerSphere : {1u, 4u}) { // nodes of two children, and of four
        Geometry geometry = mixture(300, 7, trianglesPerSphere);
        const auto ground = static_cast<std::uint32_t>(geometry.spheres.size());
        geometry.addSphere(shared::vec3(0.0f, -1000.0f, 0.0f), 1000.0f);
        geometry.addSphere(shared::vec3(0.0f, 0.1f, 0.0f), 0.1f);
        const AccelInput input = geometry.input();
        const GpuBvh bvh = *buildGpuBvh(input);
        ASSERT_FALSE(bvh.isLinear);
        ASSERT_EQ(bvh.lists.nearSpheres, 1u);
        ASSERT_EQ(bvh.lists.vectors.size(), 2u);
        EXPECT_EQ(bvh.lists.vectors[0].w, -1000.0f);
        EXPECT_EQ(std::bit_cast<std::uint32_t>(bvh.lists.vectors[1].w), ground);
        Walk walk(input, bvh.trees);
        EXPECT_EQ(std::exchange(walk.spheres[ground], 1), 0);
        EXPECT_TRUE(allMet(walk.spheres, 1));
        EXPECT_TRUE(allMet(walk.triangles, 1));
        EXPECT_LE(walk.depth, bvh.trees.depth);
        EXPECT_LE(walk.missing, 1u);
    }
}

// Whatever axis they are perpendicular to and whichever edge comes first, quads along axes are hit where the general
// test of quads hits them.
TEST(GpuBvh, QuadsAlongAxesHaveListsOfTheirOwn) {
    Random random(19);
    for (int axis = 0; axis < 3; ++axis) {
        for (int turned = 0; turned < 2; ++turned) {
            Geometry geometry;
            shared::vec3 u(0.0f), v(0.0f);
            u[(axis + 1 + turned) % 3] = 2.0f;
            v[(axis + 2 - turned) % 3] = -0.5f;
            geometry.addQuad(shared::vec3(0.5f, -0.25f, 3.0f), u, v);
            const LinearLists lists = buildGpuBvh(geometry.input())->lists;
            ASSERT_EQ(lists.axisQuads[axis], 1u);
            ASSERT_EQ(lists.quads, 0u);
            ASSERT_EQ(lists.vectors.size(), 2u);
            const shared::vec4 center = lists.vectors[0], half = lists.vectors[1];
            EXPECT_EQ(std::bit_cast<std::uint32_t>(center.w), 0u);

            const std::uint32_t last = static_cast<std::uint32_t>(axis);
            const shared::QuadFrame frame = shared::quadFrame(u, v);
            int hits = 0, disagreements = 0;
            for (int i = 0; i < 20000; ++i) {
                const shared::vec3 from = random.inCube(8.0f);
                const shared::vec3 to =
                    geometry.quads[0].corner + u * random.uniform() * 1.5f + v * random.uniform() * 1.5f;
                const shared::Ray ray{from, shared::normalize(to - from), 0.0f};
                const shared::ShapeHit general = shared::intersectQuad(ray, geometry.quads[0].corner, frame, 100.0f);
                const shared::vec3 direction = shared::axisLast(ray.direction, last);
                const float t = shared::intersectAxisQuad(
                    shared::axisLast(shared::vec3(center), last) - shared::axisLast(from, last), {half.x, half.y},
                    direction, 1 / direction.z, 1.0f, 100.0f);
                if ((general.t > 0) != (t > 0)) ++disagreements;
                if (!(general.t > 0 && t > 0)) continue;
                ++hits;
                const shared::vec2 uv = shared::rectanglePlace(ray, t, geometry.quads[0].corner, u, v);
                const float far = 4e-6f * (1 + 1 / std::abs(direction.z));
                EXPECT_NEAR(t, general.t, far * general.t);
                EXPECT_NEAR(uv.x, general.u, far * 32);
                EXPECT_NEAR(uv.y, general.v, far * 32);
            }
            EXPECT_GT(hits, 5000);
            EXPECT_LE(disagreements, 1); // rays within rounding of an edge
        }
    }
}

TEST(GpuBvh, OfNothingIsAnEmptyList) {
    Geometry geometry;
    const GpuBvh bvh = *buildGpuBvh(geometry.input(), alwaysTrees());
    EXPECT_TRUE(bvh.isLinear);
    EXPECT_TRUE(bvh.lists.vectors.empty());
}

TEST(GpuBvh, FollowsInstances) {
    Geometry geometry = mixture(90, 13);
    // The world has the first of each kind; an object the others; one object is empty.
    geometry.geometries = {{0, 1, 0, 1, 0, 1, 0, 0}, {1, 29, 1, 29, 1, 29, 0, 0}, {0, 0, 0, 0, 0, 0, 0, 0}};
    for (int i = 0; i < 7; ++i)
        geometry.instances.push_back(placedAt(i == 3 ? 2 : 1, shared::vec3(30.0f * static_cast<float>(i))));
    const AccelInput input = geometry.input();
    const GpuBvh bvh = *buildGpuBvh(input);
    ASSERT_FALSE(bvh.isLinear); // however few primitives there are
    const Walk walk(input, bvh.trees);
    EXPECT_EQ(walk.missing, 0u);
    EXPECT_EQ(walk.depth, bvh.trees.depth);
    for (std::size_t i = 0; i < walk.instances.size(); ++i) EXPECT_EQ(walk.instances[i], i == 3 ? 0 : 1);
    EXPECT_EQ(walk.spheres[0], 1);
    EXPECT_TRUE(allMet({walk.spheres.begin() + 1, walk.spheres.end()}, 6));
    EXPECT_TRUE(allMet({walk.quads.begin() + 1, walk.quads.end()}, 6));
    EXPECT_TRUE(allMet({walk.triangles.begin() + 1, walk.triangles.end()}, 6));
}

TEST(GpuBvh, OfInstancesOfNothingIsAnEmptyList) {
    Geometry geometry;
    geometry.geometries = {{}, {}};
    geometry.instances = {placedAt(1, shared::vec3(0.0f))};
    const GpuBvh bvh = *buildGpuBvh(geometry.input());
    EXPECT_TRUE(bvh.isLinear);
    EXPECT_EQ(bvh.lists.spheres + bvh.lists.quads + bvh.lists.triangles, 0u);
}

TEST(GpuBvh, CanBeCancelled) {
    Geometry geometry = mixture(5000, 17);
    const std::atomic<bool> cancel{true};
    EXPECT_FALSE(buildGpuBvh(geometry.input(), {}, &cancel).has_value());
}

} // namespace
} // namespace rt::accel
