// Trees are complete, tight, bounded in depth, and the same for any number of threads.
#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "Common/Accel/Build/BvhBuilder.h"
#include "tests/unit/AccelScene.h"

namespace rt::accel::testing {
namespace {

std::vector<Box> randomBoxes(std::size_t count) {
    Random random(3);
    std::vector<Box> boxes(count);
    for (Box& box : boxes) {
        const vec3 center = random.inCube(10.0f);
        box.add(center);
        box.add(center + random.inCube(0.2f));
    }
    return boxes;
}

bool contains(const Box& outer, const Box& inner) {
    return shared::min(outer.lower, inner.lower) == outer.lower && shared::max(outer.upper, inner.upper) == outer.upper;
}

// Checks the tree below `node` and returns its depth.
std::uint32_t check(const Bvh& bvh, const BvhInput& input, const BvhSettings& settings, std::uint32_t node,
                    std::vector<int>& seen) {
    const BvhNode& n = bvh.nodes[node];
    if (n.isLeaf()) {
        EXPECT_LE(n.count, settings.maxLeafSize);
        for (std::uint32_t i = n.first; i < n.first + n.count; ++i) {
            const std::uint32_t item = bvh.items[i];
            ++seen[item];
            EXPECT_TRUE(contains(n.box, input.boxes[item]));
            EXPECT_TRUE(i == n.first || bvh.items[i - 1] < item);
            if (!input.groups.empty()) {
                EXPECT_EQ(input.groups[item], input.groups[bvh.items[n.first]]);
                EXPECT_TRUE(input.groups[item] != settings.singleGroup || n.count == 1);
            }
        }
        return 1;
    }
    std::uint32_t depth = 0;
    for (std::uint32_t child : {n.first, n.first + 1}) {
        EXPECT_GT(child, node);
        EXPECT_TRUE(contains(n.box, bvh.nodes[child].box));
        depth = std::max(depth, check(bvh, input, settings, child, seen));
    }
    return depth + 1;
}

void expectComplete(const BvhInput& input, const BvhSettings& settings) {
    const std::optional<Bvh> bvh = buildBvh(input, settings);
    ASSERT_TRUE(bvh);
    std::vector<int> seen(input.boxes.size(), 0);
    EXPECT_LE(check(*bvh, input, settings, 0, seen), settings.maxDepth);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
}

TEST(BvhBuilder, HoldsEveryItemOnceWithinItsBoxes) {
    for (std::size_t count : {1u, 2u, 9u, 1000u, 60000u}) {
        SCOPED_TRACE(count);
        const std::vector<Box> boxes = randomBoxes(count);
        expectComplete({boxes, {}}, {});
    }
}

TEST(BvhBuilder, KeepsGroupsApartAndSinglesAlone) {
    const std::vector<Box> boxes = randomBoxes(5000);
    std::vector<std::uint8_t> groups(boxes.size());
    Random random(4);
    for (std::uint8_t& group : groups) {
        group = static_cast<std::uint8_t>(random.below(4));
    }
    BvhSettings settings;
    settings.singleGroup = 2;
    expectComplete({boxes, groups}, settings);
}

TEST(BvhBuilder, DividesItemsThatNoPlaneDivides) {
    std::vector<Box> boxes(40000, randomBoxes(1)[0]);
    expectComplete({boxes, {}}, {});
    for (std::size_t i = 0; i < boxes.size(); ++i) { // every centre half as far as the one before
        boxes[i] = Box{};
        boxes[i].add(vec3(std::ldexp(1.0f, -static_cast<int>(i % 140))));
    }
    expectComplete({boxes, {}}, {});
}

TEST(BvhBuilder, DoesNotDependOnThreads) {
    const std::vector<Box> boxes = randomBoxes(100000);
    BvhSettings settings;
    settings.threads = 1;
    const std::optional<Bvh> one = buildBvh({boxes, {}}, settings);
    for (std::size_t threads : {2u, 5u}) {
        settings.threads = threads;
        const std::optional<Bvh> many = buildBvh({boxes, {}}, settings);
        EXPECT_EQ(one->items, many->items);
        ASSERT_EQ(one->nodes.size(), many->nodes.size());
        EXPECT_EQ(std::memcmp(one->nodes.data(), many->nodes.data(), one->nodes.size() * sizeof(BvhNode)), 0);
    }
}

TEST(BvhBuilder, StopsWhenCancelledAndCountsWhatIsDone) {
    const std::vector<Box> boxes = randomBoxes(50000);
    const std::atomic<bool> cancelled{true};
    EXPECT_FALSE(buildBvh({boxes, {}}, {}, &cancelled));
    std::atomic<std::uint64_t> done{0};
    EXPECT_TRUE(buildBvh({boxes, {}}, {}, nullptr, &done));
    EXPECT_EQ(done.load(), boxes.size());
}

// A tree worth its memory: a grid of triangles such as meshes have, with its vertices and indices and the mesh of each
// triangle.
TEST(CpuAccel, TakesAtMostHundredBytesForATriangle) {
    Geometry g;
    const std::uint32_t side = 250;
    Random random(9);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const std::uint32_t column = i % side, row = i / side;
        g.positions.emplace_back(static_cast<float>(column), random.uniform(), static_cast<float>(row));
    }
    for (std::uint32_t y = 0; y + 1 < side; ++y) {
        for (std::uint32_t x = 0; x + 1 < side; ++x) {
            const std::uint32_t a = y * side + x;
            g.triangles.emplace_back(a, a + 1, a + side);
            g.triangles.emplace_back(a + 1, a + side + 1, a + side);
        }
    }
    const std::size_t scene = g.positions.size() * sizeof(vec3) + g.triangles.size() * (sizeof(shared::uvec3) + 4);
    EXPECT_LE(scene + buildAccel(g)->bytes(), 100 * g.triangles.size());
}

} // namespace
} // namespace rt::accel::testing
