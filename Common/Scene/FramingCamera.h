// A view of a whole model that brings no camera.
#pragma once
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// From the front (+z), slightly from the right and above, with all of `bounds` in sight of a square picture.
CameraDesc framingCamera(const Bounds& bounds);

} // namespace rt::scene
