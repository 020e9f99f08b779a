// From the binary tree of a builder to the nodes of eight children that traversal wants.
#pragma once
#include <vector>

#include "Common/Accel/AccelView.h"
#include "Common/Accel/Build/LeafMaker.h"
#include "Common/Accel/Bvh.h"

namespace rt::accel {

// Appends a tree to the nodes of others, with leaves from `leafMaker`, and returns the reference of its root.
Reference appendWide(const Bvh& bvh, LeafMaker& leafMaker, std::vector<WideNode>& nodes);

} // namespace rt::accel
