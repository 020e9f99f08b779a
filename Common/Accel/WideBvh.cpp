#include "Common/Accel/WideBvh.h"

#include <algorithm>

#include "Common/Accel/Build/Collapse.h"

namespace rt::accel {
namespace {

// A node that few rays visit still takes memory, and the caches hold fewer of the others: what it costs beside its
// surface, in units of the surface of the root for each item.
constexpr float kNodeCost = 16.0f;

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

} // namespace

Reference appendWide(const Bvh& bvh, LeafMaker& leafMaker, std::vector<WideNode>& nodes) {
    const Reference root = static_cast<Reference>(nodes.size());
    if (bvh.nodes[0].isLeaf()) return leafMaker.make(bvh.nodes[0]);
    const Collapse<kWidth> collapse(bvh, kNodeCost, [&](std::uint32_t node) { return bvh.nodes[node].isLeaf(); });
    const std::vector<std::uint32_t> items = countItems(bvh);
    struct Open {
        std::uint32_t binary, node;
    };
    std::vector<Open> open{{0, root}};
    nodes.emplace_back();
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        Collapse<kWidth>::Children children = collapse.children(next.binary);
        // The largest subtree first: a search for any hit looks into children from the last to the first, cheap ones
        // before. Siblings are neighbours in memory.
        std::stable_sort(children.node, children.node + children.count,
                         [&](std::uint32_t a, std::uint32_t b) { return items[a] > items[b]; });
        WideNode wide{};
        for (std::uint32_t i = 0; i < kWidth; ++i) {
            setSlabs(wide, i, i < children.count ? bvh.nodes[children.node[i]].box : Box{});
            if (i >= children.count) continue;
            if (bvh.nodes[children.node[i]].isLeaf()) {
                wide.child[i] = leafMaker.make(bvh.nodes[children.node[i]]);
                continue;
            }
            wide.child[i] = static_cast<Reference>(nodes.size());
            open.push_back({children.node[i], wide.child[i]});
            nodes.emplace_back();
        }
        nodes[next.node] = wide;
    }
    return root;
}

} // namespace rt::accel
