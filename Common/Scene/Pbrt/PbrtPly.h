// Meshes of PLY files, as pbrt scenes name them.
#pragma once
#include <filesystem>
#include <variant>

#include "Common/Scene/Pbrt/PbrtBudget.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Of a text, or binary in either order of bytes; packed by gzip or not: vertices with x, y, z, perhaps nx, ny, nz and
// u, v (or s, t), and faces of any number of corners, which are cut into fans of triangles. All else is passed over.
// Many vertices are in single precision, unless the file has doubles. Throws InputError naming the file, and the element
// where there is one.
std::variant<MeshData, FloatMeshData> loadPbrtPly(const std::filesystem::path& path, PbrtBudget& budget);

} // namespace rt::scene
