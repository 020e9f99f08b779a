// Where files of others place things.
#pragma once
#include "Common/Scene/Affine.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

bool isWithinLimits(const Affine& map);   // kLargest, and finite
Transform toTransform(const Affine& map); // in one step

} // namespace rt::scene
