// Materials of every kind as principled ones, whose parameters are those of glTF.
#pragma once
#include <string>
#include <vector>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// The nearest principled material; what it cannot show gets a notice.
MaterialDesc asPrincipled(const MaterialDesc& material, std::vector<std::string>& notices);

} // namespace rt::scene
