// Boxes of primitives, a little larger than exact ones: what a test of the primitive hits in spite of rounding is
// inside.
#pragma once
#include "Common/Accel/Box.h"

namespace rt::accel {

Box boxOf(const shared::Sphere& sphere);
Box boxOf(const shared::Sphere& sphere, shared::vec3 motion); // over the whole shutter interval
Box boxOf(const shared::Quad& quad);
Box boxOf(const shared::Round& round);
Box boxOf(shared::vec3 vertex0, shared::vec3 vertex1, shared::vec3 vertex2);

// In world space, of an object-space box under an instance.
Box boxOf(const shared::Instance& instance, const Box& object);

} // namespace rt::accel
