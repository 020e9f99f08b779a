// Which nodes of a binary tree become nodes of many children, so that the sum of their surfaces, that is of visits, is
// least. After Ylitie, Karras & Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017,
// section 3.1, with what lies below some nodes as it is.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "Common/Accel/Bvh.h"

namespace rt::accel {

template <std::uint32_t kPlaces>
class Collapse {
  public:
    // What is below nodes of which isEnd(index) is true is not looked into; leaves must be among them, the root not.
    // Beside its surface a node costs `nodeCost`, in units of the root's surface for each item.
    template <class IsEnd>
    Collapse(const Bvh& bvh, float nodeCost, const IsEnd& isEnd)
        : bvh_(bvh),
          nodeCost_(nodeCost * bvh.nodes[0].box.halfArea() / static_cast<float>(bvh.items.size())),
          splits_(bvh.nodes.size()) {
        solve(0, isEnd);
    }

    // The descendants of a node that become the children of its wide node.
    struct Children {
        std::uint32_t node[kPlaces];
        std::uint32_t count = 0;
    };
    Children children(std::uint32_t node) const {
        Children result;
        distribute(node, kPlaces, result);
        return result;
    }

  private:
    // [n - 1]: least cost of the wide nodes in a subtree that hangs from n places or fewer, 1 to kPlaces - 1.
    using Costs = std::array<float, kPlaces - 1>;

    // [n - 1], of a subtree in n places: those for its first child; 0: one place less is as good. All 0: an end.
    using Splits = std::array<std::uint8_t, kPlaces>;

    template <class IsEnd>
    Costs solve(std::uint32_t node, const IsEnd& isEnd) { // recursion as deep as the tree: kMaxTreeDepth
        Costs costs{};
        if (isEnd(node)) return costs;
        const Costs a = solve(bvh_.nodes[node].first, isEnd), b = solve(bvh_.nodes[node].first + 1, isEnd);
        Splits& splits = splits_[node];
        std::array<float, kPlaces> divided{};
        for (std::uint32_t places = 2; places <= kPlaces; ++places) {
            for (std::uint32_t k = 1; k < places; ++k) {
                const float cost = a[k - 1] + b[places - k - 1];
                if (k > 1 && cost >= divided[places - 1]) continue;
                divided[places - 1] = cost;
                splits[places - 1] = static_cast<std::uint8_t>(k);
            }
        }
        costs[0] = bvh_.nodes[node].box.halfArea() + nodeCost_ + divided[kPlaces - 1];
        for (std::uint32_t places = 2; places < kPlaces; ++places) {
            const bool fewer = costs[places - 2] <= divided[places - 1];
            if (fewer) splits[places - 1] = 0;
            costs[places - 1] = fewer ? costs[places - 2] : divided[places - 1];
        }
        return costs;
    }

    void distribute(std::uint32_t node, std::uint32_t places, Children& result) const {
        const std::uint32_t first = bvh_.nodes[node].first, k = splits_[node][places - 1];
        gather(first, k, result);
        gather(first + 1, places - k, result);
    }

    void gather(std::uint32_t node, std::uint32_t places, Children& result) const {
        while (places > 1 && splits_[node][places - 1] == 0) --places;
        if (places == 1) {
            result.node[result.count++] = node;
        } else {
            distribute(node, places, result);
        }
    }

    const Bvh& bvh_;
    const float nodeCost_;
    std::vector<Splits> splits_;
};

} // namespace rt::accel
