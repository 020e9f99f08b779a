// One function a built-in scene, grouped by where the scene comes from; BuiltinScenes.cpp has the table of them.
#pragma once
#include <cstdint>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

SceneDesc oneWeekendFinal();

SceneDesc cornellBoxGlass();
SceneDesc cornellBoxLights();

}  // namespace rt::scene
