// One change of several objects.
#pragma once
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// What was changed of one object is changed of another of its kind: numbers, also single ones of vectors, that differ
// between `before` and `after` become those of `after`, and all others stay. Nothing of objects of other kinds. Meshes,
// sets of spheres, groups and instances have no numbers.
void changeAlike(const ObjectDesc& before, const ObjectDesc& after, ObjectDesc& other);

// Likewise of the transforms of groups and instances, where they consist of the same steps.
void changeAlike(const Transform& before, const Transform& after, Transform& other);

} // namespace rt::scene
