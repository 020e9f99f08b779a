// 8-wide trees with quantized boxes, traversed breadth-first. They serve scenes in which rays visit many nodes for each
// leaf that they enter, as among small things far from each other: memory decides there, and the order of the visits
// hardly matters.
#pragma once
#include <vector>

#include "Common/Accel/AccelView.h"
#include "Common/Accel/Build/LeafMaker.h"
#include "Common/Accel/Bvh.h"

namespace rt::accel {

struct QuantizedBvh {
    std::vector<QuantizedNode> nodes; // the root first
    QuantizationGrid grid;
};

// Whether the leaves have so little of the tree's surface that rays mostly visit inner nodes.
bool gainsFromQuantization(const Bvh& bvh);

// `bvh` is not empty; its leaves are from `leafMaker`.
QuantizedBvh quantize(const Bvh& bvh, LeafMaker& leafMaker);

} // namespace rt::accel
