// The trees of the compute engine that an edit of the world leaves: what is built behind them makes what there would be
// from scratch, byte for byte.
#include <cstddef>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Accel/GpuBvh.h"
#include "tests/unit/AccelScene.h"

namespace rt::accel {
namespace {

using testing::Geometry;
using testing::mixture;
using testing::placedAt;

template <class T>
std::vector<T> prefixed(const std::vector<T>& all, std::size_t kept, const std::vector<T>& behind) {
    std::vector<T> result(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kept));
    result.insert(result.end(), behind.begin(), behind.end());
    return result;
}

template <class T>
bool areSameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

// What was kept and what was built behind it: the trees from scratch.
void expectKept(const GpuTrees& before, const AccelInput& now) {
    const PlacedTrees& placed = before.placed;
    const GpuTrees fresh = buildGpuBvh(now)->trees, behind = buildGpuBvh(now, {}, nullptr, &placed)->trees;
    const TreeCounts& kept = placed.counts;
    ASSERT_GT(kept.nodes, 0u);
    EXPECT_TRUE(areSameBytes(prefixed(before.nodes, placed.isWide ? 0 : kept.nodes, behind.nodes), fresh.nodes));
    EXPECT_TRUE(
        areSameBytes(prefixed(before.wideNodes, placed.isWide ? kept.nodes : 0, behind.wideNodes), fresh.wideNodes));
    EXPECT_TRUE(areSameBytes(prefixed(before.spheres, kept.spheres, behind.spheres), fresh.spheres));
    EXPECT_TRUE(areSameBytes(prefixed(before.sphereIndices, kept.spheres, behind.sphereIndices), fresh.sphereIndices));
    EXPECT_TRUE(areSameBytes(prefixed(before.quads, kept.quads, behind.quads), fresh.quads));
    EXPECT_TRUE(areSameBytes(prefixed(before.triangles, kept.triangles, behind.triangles), fresh.triangles));
    EXPECT_TRUE(areSameBytes(behind.instanceRoots, fresh.instanceRoots));
    EXPECT_EQ(behind.root, fresh.root);
    EXPECT_EQ(behind.depth, fresh.depth);
}

TEST(PlacedTrees, AreKeptWhereOnlyTheWorldIsAnother) {
    Geometry before = mixture(90, 13);
    before.geometries = {{0, 1, 0, 1, 0, 1, 0, 0}, {1, 29, 1, 29, 1, 29, 0, 0}, {0, 0, 0, 0, 0, 0, 0, 0}};
    for (int i = 0; i < 7; ++i)
        before.instances.push_back(placedAt(i == 3 ? 2 : 1, shared::vec3(30.0f * static_cast<float>(i))));
    const GpuTrees trees = buildGpuBvh(before.input())->trees;
    const auto canKeepFor = [&](Geometry& now) { return canKeep(trees.placed, before.input(), now.input()); };

    Geometry moved = before;
    moved.instances[2] = placedAt(1, shared::vec3(-50.0f, 4.0f, 1.0f));
    moved.instances.push_back(placedAt(1, shared::vec3(9.0f, 80.0f, 1.0f)));
    moved.spheres[0].radius *= 2.0f; // of the world
    ASSERT_TRUE(canKeepFor(moved));
    expectKept(trees, moved.input());

    Geometry larger = before; // an object
    larger.spheres[5].radius *= 2.0f;
    EXPECT_FALSE(canKeepFor(larger));
    Geometry smaller = before; // the world, so that the object's are others of the arrays
    smaller.geometries[0].sphereCount = 0;
    smaller.geometries[1].firstSphere = 0;
    EXPECT_FALSE(canKeepFor(smaller));
    Geometry unlike = before; // nothing shows the second object any more
    unlike.instances.erase(unlike.instances.begin() + 3);
    EXPECT_FALSE(canKeepFor(unlike));
}

} // namespace
} // namespace rt::accel
