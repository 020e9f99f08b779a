// A bounding volume hierarchy over boxes of one's own: the builder knows boxes alone, so whatever has a box can be in
// them. Here they are 20 000 small boxes in a cube, and the question is how many of them a ray passes through.
//
// The tree comes from the library; what walks through it is below, and is compared with a loop over all boxes.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include "Common/Accel/Build/BvhBuilder.h"

using rt::accel::Box;
using rt::accel::Bvh;
using rt::accel::BvhNode;
using rt::shared::vec3;

namespace {

struct Ray {
    vec3 origin;
    vec3 inverse; // of each component of the direction: a slab's distances are products then
};

// The slab test: a ray is in the box where it is between the two planes of each of the three axes at once.
bool meets(const Ray& ray, const Box& box) {
    const vec3 a = (box.lower - ray.origin) * ray.inverse;
    const vec3 b = (box.upper - ray.origin) * ray.inverse;
    float enters = 0, leaves = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        enters = std::max(enters, std::min(a[axis], b[axis]));
        leaves = std::min(leaves, std::max(a[axis], b[axis]));
    }
    return enters <= leaves;
}

struct Counts {
    std::uint64_t met = 0;    // boxes that the ray passes through
    std::uint64_t tested = 0; // slab tests that finding them took, of boxes and of nodes
};

// Depth first, by a stack of nodes still to be looked into: those of which the ray misses the box have nothing for it.
Counts walk(const Bvh& bvh, const std::vector<Box>& boxes, const Ray& ray) {
    Counts counts;
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
        const BvhNode& node = bvh.nodes[stack.back()];
        stack.pop_back();
        ++counts.tested;
        if (!meets(ray, node.box)) continue;
        if (!node.isLeaf()) {
            stack.push_back(node.first);
            stack.push_back(node.first + 1);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            ++counts.tested;
            counts.met += meets(ray, boxes[bvh.items[i]]) ? 1 : 0;
        }
    }
    return counts;
}

} // namespace

int main() {
    constexpr int kBoxes = 20000, kRays = 1000;
    std::mt19937 random(1); // the same numbers on every machine
    const auto number = [&random] { return static_cast<float>(random()) * 0x1p-32f; };
    const auto point = [&number] {
        const float x = number(), y = number();
        return vec3(x, y, number());
    };

    std::vector<Box> boxes;
    for (int i = 0; i < kBoxes; ++i) {
        const vec3 corner = point();
        boxes.push_back({corner, corner + 0.03f * point()});
    }

    rt::accel::BvhSettings settings;
    settings.blockSize = 1; // our leaves test one box at a time, not eight side by side
    settings.maxLeafSize = 4;
    const Bvh bvh = *rt::accel::buildBvh({boxes, {}}, settings);

    Counts byTree;
    std::uint64_t byLoop = 0;
    for (int i = 0; i < kRays; ++i) {
        const Ray ray{point(), 1.0f / (point() - 0.5f)};
        const Counts counts = walk(bvh, boxes, ray);
        byTree.met += counts.met;
        byTree.tested += counts.tested;
        byLoop += static_cast<std::uint64_t>(
            std::count_if(boxes.begin(), boxes.end(), [&ray](const Box& box) { return meets(ray, box); }));
    }

    std::printf("%zu nodes over %d boxes\n", bvh.nodes.size(), kBoxes);
    std::printf("boxes that %d rays pass through: %llu by the tree, %llu by a loop over all\n", kRays,
                static_cast<unsigned long long>(byTree.met), static_cast<unsigned long long>(byLoop));
    std::printf("tests a ray: %.0f by the tree, %d by the loop\n", static_cast<double>(byTree.tested) / kRays, kBoxes);
    return byTree.met == byLoop ? 0 : 1;
}
