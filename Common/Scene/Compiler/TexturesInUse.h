// Which textures a scene shows, before any is made.
#pragma once
#include <string>
#include <vector>

#include "Common/Scene/Compiler/InstancePlan.h"
#include "Common/Scene/Compiler/MaterialTable.h"
#include "Common/Scene/Compiler/ModelCache.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Names of the textures of all materials that objects have, those of model files included, in the order in which the
// compiler comes to them. Throws InputError for a material that is not defined.
std::vector<std::string> texturesInUse(const SceneDesc& desc, const InstancePlan& plan, const MaterialTable& materials,
                                       ModelCache& models);

} // namespace rt::scene
