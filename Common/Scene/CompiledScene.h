// The compiled scene: arrays of records, nothing else. What a kernel, CPU or GPU, sees of a scene.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "Common/Scene/Origins.h"
#include "Common/Scene/SceneDesc.h"
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Base/Types.h"

namespace rt::scene {

// Produced by compileScene(), immutable afterwards, shared by everything that renders it. Every index in a record is
// valid; every number is finite; geometry 0 (the world) always exists.
struct CompiledScene : shared::SceneArraysOf<std::vector> {
    std::string id; // "cornell-box-lights", "white-spheres:500", or the file's name
    std::string title;
    std::uint64_t hash = 0; // of everything that affects the image except camera and settings

    shared::Features features;

    shared::SceneGlobals globals{};

    CameraDesc camera;                         // authored, in world units as authored (not relative to globals.origin)
    std::map<std::string, CameraDesc> cameras; // others that it can be seen with, by name, in those units
    glm::dvec3 origin{0.0};                    // globals.origin before rounding
    glm::dvec3 lower{0.0}, upper{0.0};         // bounds of all that there is, in authored units
    RenderDefaults defaults;
    Motion motion;
    Origins origins;                        // of its primitives, for editors
    std::vector<std::string> materialNames; // of each material, as the scene or its model has it
    std::vector<std::string> modelFiles;    // of models that it has taken in
    std::vector<std::string> notices;       // one line each: dropped primitives, stand-ins for missing assets
};

} // namespace rt::scene
