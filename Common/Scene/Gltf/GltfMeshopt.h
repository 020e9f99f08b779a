// EXT_meshopt_compression: buffer views whose bytes meshoptimizer has compressed.
#pragma once

#include "Common/Scene/Gltf/GltfBudget.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

// Whether this build reads them; else a file's own uncompressed views are taken, where it has any.
bool knowsMeshopt();

// What of the extension of a view can be checked before buffers are read; `viewBytes`: what the view states. Throws
// InputError.
void checkMeshopt(const JsonNode& extension, std::uint64_t viewBytes);

// Fills GltfFile::decoded with the views that are compressed. Throws InputError where the data are damaged.
void decodeMeshopt(GltfFile& file, GltfBudget& budget);

} // namespace rt::scene
