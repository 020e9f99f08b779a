// Skins: meshes that follow the joints of a skeleton.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfNodes.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// How many sets of four joints the vertices of a primitive have.
int jointSetCount(const tinygltf::Primitive& primitive);

// Where each joint of a skin puts what it is bound to, from the mesh's space to the world. Throws InputError naming
// file and place.
std::vector<Affine> jointMaps(const GltfFile& file, int skin, const GltfNodes& nodes);

// Moves positions, normals and tangents by the joints, as the primitive's attributes weigh them; the node of a skinned
// mesh moves nothing. `elements`: the vertices of the primitive that the mesh has; null: all. Returns how many vertices
// have weights whose sum is not 1, but for what small integers round by.
std::size_t applySkin(const GltfFile& file, const tinygltf::Primitive& primitive, std::span<const Affine> joints,
                      const std::vector<std::uint32_t>* elements, const std::string& place, MeshData& mesh);

} // namespace rt::scene
