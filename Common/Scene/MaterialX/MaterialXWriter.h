// Materials of a scene as MaterialX documents.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// A material of the scene as a document with one gltf_pbr, whose parameters are those of principled materials. Images
// below `folder` are named from there, where the document is to be. What it cannot hold gets a notice.
std::string toMaterialX(const SceneDesc& scene, const std::string& material, const std::filesystem::path& folder,
                        std::vector<std::string>& notices);

} // namespace rt::scene
