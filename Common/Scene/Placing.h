// Affine maps as scenes are authored with them.
#pragma once
#include "Common/Scene/Affine.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

bool isWithinLimits(const Affine& map); // kLargest, and finite
bool isIdentity(const Affine& map);
Matrix toMatrix(const Affine& map);
Transform toTransform(const Affine& map); // in one step

} // namespace rt::scene
