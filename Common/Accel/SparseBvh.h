// Trees in which rays visit many nodes for each leaf that they enter, as among small things far from each other: memory
// decides there, and the order of the visits hardly matters.
#pragma once
#include <vector>

#include "Common/Accel/AccelView.h"
#include "Common/Accel/Build/LeafMaker.h"
#include "Common/Accel/Bvh.h"

namespace rt::accel {

struct SparseBvh {
    std::vector<SparseNode> nodes; // the root first
    SparseGrid grid;
};

bool isSparse(const Bvh& bvh);

// `bvh` is sparse; its leaves are from `leafMaker`.
SparseBvh makeSparse(const Bvh& bvh, LeafMaker& leafMaker);

} // namespace rt::accel
