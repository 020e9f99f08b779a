#include "Common/Accel/WideBvh.h"

#include <algorithm>
#include <array>

#include "Common/Core/Error.h"

namespace rt::accel {
namespace {

// A node that few rays visit still takes memory, and the caches hold fewer of the others: what it costs beside its
// surface, in units of the surface of the root for each item.
constexpr float kNodeCost = 16.0f;

// Which binary nodes become wide ones, so that the sum of their surfaces, that is of visits, is least. After Ylitie, Karras & Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017,
// section 3.1, with the leaves of the binary tree as they are.
class Collapse {
  public:
    explicit Collapse(const Bvh& bvh)
        : bvh_(bvh),
          nodeCost_(kNodeCost * bvh.nodes[0].box.halfArea() / static_cast<float>(bvh.items.size())),
          splits_(bvh.nodes.size()) {
        solve(0);
    }

    // The descendants of a node that become the children of its wide node.
    struct Children {
        std::uint32_t node[kWidth];
        std::uint32_t count = 0;
    };
    Children children(std::uint32_t node) const {
        Children result;
        distribute(node, kWidth, result);
        return result;
    }

  private:
    // [n - 1]: least cost of the wide nodes in a subtree that hangs from n places or fewer, 1 to kWidth - 1.
    using Costs = std::array<float, kWidth - 1>;

    // Of `places` those for the first child, 0: one place less is as good. Four bits for each number of places.
    std::uint32_t split(std::uint32_t node, std::uint32_t places) const {
        return splits_[node] >> 4 * (places - 1) & 15u;
    }

    Costs solve(std::uint32_t node) { // recursion as deep as the tree: kMaxTreeDepth
        Costs costs{};
        if (bvh_.nodes[node].isLeaf()) return costs;
        const Costs a = solve(bvh_.nodes[node].first), b = solve(bvh_.nodes[node].first + 1);
        std::array<float, kWidth> divided{};
        for (std::uint32_t places = 2; places <= kWidth; ++places) {
            std::uint32_t best = 1;
            for (std::uint32_t k = 1; k < places; ++k) {
                const float cost = a[k - 1] + b[places - k - 1];
                if (k > 1 && cost >= divided[places - 1]) continue;
                divided[places - 1] = cost;
                best = k;
            }
            splits_[node] |= best << 4 * (places - 1);
        }
        costs[0] = bvh_.nodes[node].box.halfArea() + nodeCost_ + divided[kWidth - 1];
        for (std::uint32_t places = 2; places < kWidth; ++places) {
            const bool fewer = costs[places - 2] <= divided[places - 1];
            if (fewer) splits_[node] &= ~(15u << 4 * (places - 1));
            costs[places - 1] = fewer ? costs[places - 2] : divided[places - 1];
        }
        return costs;
    }

    void distribute(std::uint32_t node, std::uint32_t places, Children& result) const {
        const std::uint32_t first = bvh_.nodes[node].first, k = split(node, places);
        gather(first, k, result);
        gather(first + 1, places - k, result);
    }

    void gather(std::uint32_t node, std::uint32_t places, Children& result) const {
        while (places > 1 && split(node, places) == 0) --places;
        if (bvh_.nodes[node].isLeaf() || places == 1) {
            result.node[result.count++] = node;
        } else {
            distribute(node, places, result);
        }
    }

    const Bvh& bvh_;
    const float nodeCost_;
    std::vector<std::uint32_t> splits_;
};

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

// Makes the leaves of one tree.
class LeafMaker {
  public:
    LeafMaker(const Bvh& bvh, std::span<const std::uint8_t> kinds, std::uint32_t (&blocks)[kLeafKinds],
              WideLeaves& leaves)
        : bvh_(bvh), kinds_(kinds), blocks_(blocks), leaves_(leaves) {
        leaves_.items.reserve(bvh.items.size());
    }

    // References of the leaves among the children of a node; those of other children stay as they are.
    void make(const std::uint32_t* nodes, std::uint32_t count, Reference* references) {
        bool done[kWidth] = {};
        for (std::uint32_t i = 0; i < count; ++i) {
            if (done[i] || !bvh_.nodes[nodes[i]].isLeaf()) continue;
            const std::uint32_t kind = kindOf(nodes[i]);
            std::uint32_t items = 0;
            const std::size_t first = leaves_.items.size();
            bool joins[kWidth] = {};
            for (std::uint32_t k = i; k < count; ++k) {
                const BvhNode& node = bvh_.nodes[nodes[k]];
                if (done[k] || !node.isLeaf() || kindOf(nodes[k]) != kind) continue;
                if (k != i && (static_cast<LeafKind>(kind) == LeafKind::Instance || items + node.count > kWidth))
                    continue;
                items += node.count;
                leaves_.items.insert(leaves_.items.end(), bvh_.items.begin() + node.first,
                                     bvh_.items.begin() + node.first + node.count);
                joins[k] = done[k] = true;
            }
            std::sort(leaves_.items.begin() + static_cast<std::ptrdiff_t>(first), leaves_.items.end());
            const Reference leaf = addLeaf(kind, static_cast<std::uint32_t>(first), items);
            for (std::uint32_t k = i; k < count; ++k)
                if (joins[k]) references[k] = leaf;
        }
    }

  private:
    std::uint32_t kindOf(std::uint32_t leaf) const {
        return kinds_[kinds_.size() == 1 ? 0 : bvh_.items[bvh_.nodes[leaf].first]];
    }

    Reference addLeaf(std::uint32_t kind, std::uint32_t first, std::uint32_t items) {
        const bool single = static_cast<LeafKind>(kind) == LeafKind::Instance;
        const std::uint32_t count = single ? items : (items + kWidth - 1) / kWidth;
        if (blocks_[kind] + count > kMaxBlocks)
            throw RenderError(
                "the scene has more primitives than an acceleration structure can hold (268 million of a kind)");
        leaves_.leaves.push_back({static_cast<LeafKind>(kind), first, items, blocks_[kind]});
        blocks_[kind] += count;
        return kLeafBit | kind << kKindShift | (count - 1) << kCountShift | leaves_.leaves.back().firstBlock;
    }

    const Bvh& bvh_;
    const std::span<const std::uint8_t> kinds_;
    std::uint32_t (&blocks_)[kLeafKinds];
    WideLeaves& leaves_;
};

} // namespace

Reference WideBvh::append(const Bvh& bvh, std::span<const std::uint8_t> kinds, WideLeaves& leaves) {
    LeafMaker leafMaker(bvh, kinds, blocks, leaves);
    const Reference root = static_cast<Reference>(nodes.size());
    if (bvh.nodes[0].isLeaf()) {
        const std::uint32_t only = 0;
        Reference leaf = 0;
        leafMaker.make(&only, 1, &leaf);
        return leaf;
    }
    const Collapse collapse(bvh);
    const std::vector<std::uint32_t> items = countItems(bvh);
    struct Open {
        std::uint32_t binary, node;
    };
    std::vector<Open> open{{0, root}};
    nodes.emplace_back();
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        Collapse::Children children = collapse.children(next.binary);
        // The largest subtree first: a search for any hit looks into children from the last to the first, cheap ones
        // before. Siblings are neighbours in memory.
        std::stable_sort(children.node, children.node + children.count,
                         [&](std::uint32_t a, std::uint32_t b) { return items[a] > items[b]; });
        WideNode wide{};
        for (std::uint32_t i = 0; i < kWidth; ++i) {
            setSlabs(wide, i, i < children.count ? bvh.nodes[children.node[i]].box : Box{});
            if (i >= children.count || bvh.nodes[children.node[i]].isLeaf()) continue;
            wide.child[i] = static_cast<Reference>(nodes.size());
            open.push_back({children.node[i], wide.child[i]});
            nodes.emplace_back();
        }
        leafMaker.make(children.node, children.count, wide.child);
        nodes[next.node] = wide;
    }
    return root;
}

} // namespace rt::accel
