// A binary bounding volume hierarchy over boxes: what builders make and what other layouts are made from. It knows
// nothing of the primitives in the boxes.
#pragma once
#include <cstdint>
#include <vector>

#include "Common/Accel/Box.h"

namespace rt::accel {

struct BvhNode {
    Box box;
    std::uint32_t first; // inner node: its children are nodes[first] and nodes[first + 1]; leaf: first of its items
    std::uint32_t count; // items of a leaf; 0: an inner node

    bool isLeaf() const { return count != 0; }
};

struct Bvh {
    std::vector<BvhNode> nodes;       // [0] is the root; empty without items
    std::vector<std::uint32_t> items; // indices of boxes, leaf by leaf
};

} // namespace rt::accel
