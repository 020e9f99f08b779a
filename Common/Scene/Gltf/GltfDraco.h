// KHR_draco_mesh_compression: primitives whose triangles and vertices Draco has compressed.
#pragma once

#include "Common/Scene/Gltf/GltfBudget.h"
#include "Common/Scene/Gltf/GltfFile.h"

namespace rt::scene {

// Whether this build reads them; else a file's own uncompressed accessors are taken, where it has any.
bool knowsDraco();

// Gives each primitive that is compressed accessors of its own, of buffer views in GltfFile::decoded. Throws InputError
// where the data are damaged, or differ from what the accessors of the file state.
void decodeDraco(GltfFile& file, GltfBudget& budget);

} // namespace rt::scene
