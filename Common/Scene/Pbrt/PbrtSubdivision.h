// Subdivision surfaces after C. Loop, Smooth Subdivision Surfaces Based on Triangles, 1987.
#pragma once
#include <cstdint>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// The triangles of a control mesh, each cut into 4^levels, with their vertices on the limit surface and normals there.
// Indices must be of positions. Empty: an edge has more than two triangles, or a triangle meets itself.
MeshData subdividedByLoop(MeshData mesh, int levels);

} // namespace rt::scene
