// What the compilation of a scene that is edited takes over from the one before: an edit changes little, and most of
// the time goes into what it does not change.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Obj/ObjLoader.h"

namespace rt::scene {

// A surface of a mesh as it is in a compiled scene. What it looks like is not told: that may change.
struct KeptSurface {
    Affine map;
    bool mayBeDivided = false; // but is not
    std::uint32_t mesh = 0;    // of the compiled scene
    std::uint32_t vertexCount = 0;
    std::uint64_t dropped = 0; // triangles
    Bounds bounds;
};

// Surfaces are known by where their meshes lie in memory: until the next compilation that succeeds no mesh of the
// scene may be changed in place or freed, not even one that is no longer in the scene.
struct CompileMemory {
    std::shared_ptr<const CompiledScene> scene;                    // the latest; empty before the first
    std::multimap<const void*, KeptSurface> surfaces;              // of that scene, by mesh
    std::map<std::string, std::shared_ptr<const ObjModel>> models; // that were read
};

} // namespace rt::scene
