// One function for each built-in scene, grouped by where the scene comes from; BuiltinScenes.cpp has the table of them.
#pragma once
#include <cstdint>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// BuiltinOneWeekend.cpp
SceneDesc oneWeekendDefault();
SceneDesc oneWeekendTest();
SceneDesc oneWeekendFinal();
// The field of small spheres with its ground and camera, without the three large spheres.
SceneDesc oneWeekendField();

// BuiltinNextWeek.cpp
SceneDesc nextWeekDefault();
SceneDesc nextWeekRandomSpheres();
SceneDesc nextWeekTwoSpheres();
SceneDesc nextWeekEarth();
SceneDesc nextWeekTwoPerlinSpheres();
SceneDesc nextWeekQuads();
SceneDesc nextWeekSimpleLight();
SceneDesc nextWeekCornellBox();
SceneDesc nextWeekCornellSmoke();
SceneDesc nextWeekFinal();

// BuiltinCornell.cpp
SceneDesc restOfLifeCornellBox();
SceneDesc restOfLifeCornellBoxMirror();
SceneDesc restOfLifeCornellBoxGlass();
SceneDesc whiteSpheres(std::uint32_t count);
SceneDesc cornellBoxLights();
SceneDesc cornellBoxLucy();

// BuiltinModels.cpp
SceneDesc cubeAndSpheres();
SceneDesc planetsInOneWeekend();
SceneDesc lucyInOneWeekend();
MeshDesc lucyMesh();

// BuiltinOurs.cpp
SceneDesc veachMis();
SceneDesc manyLights(std::uint32_t count);
SceneDesc triangleLights();
SceneDesc furnace();
SceneDesc furnaceMixed();

} // namespace rt::scene
