// From what --scene names to a scene.
#pragma once
#include <memory>
#include <string>

#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::app {

// A .json scene file, an .obj file, or the id of a built-in scene. Throws InputError.
scene::SceneDesc loadScene(const std::string& source);

// With its textures; with generated ones in place of files that have a stand-in, where asked for. Throws InputError.
std::shared_ptr<const scene::CompiledScene> compile(const scene::SceneDesc& desc, bool oneSidedLights,
                                                    bool generatedAssets = false);

// Ids and titles, one a line or as JSON: [{"id": …, "title": …, "description": …}].
std::string listScenes(bool json);

} // namespace rt::app
