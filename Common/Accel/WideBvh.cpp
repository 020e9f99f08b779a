#include "Common/Accel/WideBvh.h"

#include <algorithm>
#include <limits>

#include "Common/Core/Error.h"

namespace rt::accel {
namespace {

// The up to eight descendants of binary node `root` that become the children of one wide node: what has the largest
// surface is opened first, since rays are likeliest to enter it.
struct Children {
    std::uint32_t node[kWidth];
    std::uint32_t count;
};

Children gatherChildren(const Bvh& bvh, std::uint32_t root) {
    Children children{{bvh.nodes[root].first, bvh.nodes[root].first + 1}, 2};
    while (children.count < kWidth) {
        float largest = -1.0f;
        std::uint32_t opened = 0;
        for (std::uint32_t i = 0; i < children.count; ++i) {
            const BvhNode& node = bvh.nodes[children.node[i]];
            if (!node.isLeaf() && node.box.halfArea() > largest) {
                largest = node.box.halfArea();
                opened = i;
            }
        }
        if (largest < 0.0f) break;
        const std::uint32_t first = bvh.nodes[children.node[opened]].first;
        children.node[opened] = first;
        children.node[children.count++] = first + 1;
    }
    return children;
}

// Items below each node; a child's index is greater than its parent's.
std::vector<std::uint32_t> countItems(const Bvh& bvh) {
    std::vector<std::uint32_t> items(bvh.nodes.size());
    for (std::size_t i = bvh.nodes.size(); i-- > 0;) {
        const BvhNode& node = bvh.nodes[i];
        items[i] = node.isLeaf() ? node.count : items[node.first] + items[node.first + 1];
    }
    return items;
}

void setSlabs(WideNode& node, std::uint32_t child, const Box& box) {
    for (int a = 0; a < 3; ++a) {
        node.planes[2 * a][child] = box.lower[a];
        node.planes[2 * a + 1][child] = box.upper[a];
    }
}

}  // namespace

Reference WideBvh::append(const Bvh& bvh, std::span<const std::uint8_t> kinds, std::vector<WideLeaf>& leaves) {
    const auto addLeaf = [&](const BvhNode& node) {
        const std::uint32_t kind = kinds[kinds.size() == 1 ? 0 : bvh.items[node.first]];
        const bool single = static_cast<LeafKind>(kind) == LeafKind::Instance;
        const std::uint32_t count = single ? node.count : (node.count + kWidth - 1) / kWidth;
        if (blocks[kind] + count > kMaxBlocks)
            throw RenderError(
                "the scene has more primitives than an acceleration structure can hold (268 million of a kind)");
        leaves.push_back({static_cast<LeafKind>(kind), node.first, node.count, blocks[kind]});
        blocks[kind] += count;
        return kLeafBit | kind << kKindShift | (count - 1) << kCountShift | leaves.back().firstBlock;
    };

    if (bvh.nodes[0].isLeaf()) return addLeaf(bvh.nodes[0]);
    const std::vector<std::uint32_t> items = countItems(bvh);
    const Reference root = static_cast<Reference>(nodes.size());
    struct Open {
        std::uint32_t binary, parent, child;
    };
    std::vector<Open> open{{0, kWidth, 0}};
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        const std::uint32_t index = static_cast<std::uint32_t>(nodes.size());
        nodes.emplace_back();
        if (index != root) nodes[next.parent].child[next.child] = index;
        Children children = gatherChildren(bvh, next.binary);
        // The largest subtree first: a search for any hit looks into children from the last to the first, cheap ones
        // before.
        std::stable_sort(children.node, children.node + children.count,
                         [&](std::uint32_t a, std::uint32_t b) { return items[a] > items[b]; });
        for (std::uint32_t i = kWidth; i-- > 0;) {
            setSlabs(nodes[index], i, i < children.count ? bvh.nodes[children.node[i]].box : Box{});
            nodes[index].child[i] = 0;
            if (i >= children.count) continue;
            const BvhNode& child = bvh.nodes[children.node[i]];
            if (child.isLeaf()) {
                nodes[index].child[i] = addLeaf(child);
            } else {
                open.push_back({children.node[i], index, i});
            }
        }
    }
    return root;
}

}  // namespace rt::accel
