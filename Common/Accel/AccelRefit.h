// Trees of the CPU engine whose boxes follow what has moved.
#pragma once
#include <cstdint>

#include "Common/Accel/AccelInput.h"
#include "Common/Accel/AccelStorage.h"

namespace rt::accel {

// Whether leaves can stay what they are: the same primitives of the same kinds, instances of the same geometries.
bool canRefit(const AccelStorage& storage, Reference root, const AccelInput& before, const AccelInput& now);

// Half the surface of all boxes of the world's tree together: in proportion to it they are visited.
double areaOf(const LargeArray<WideNode>& nodes, Reference root);

// Requires canRefit(). Keeps track of that surface; false: it would be larger than `maxArea`, and all is as it was.
bool refit(AccelStorage& storage, Reference root, const AccelInput& before, const AccelInput& now, double maxArea,
           double& area, std::uint32_t threads);

} // namespace rt::accel
