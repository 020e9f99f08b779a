// The parts of writing a scene file; SceneJson.h is the interface.
#pragma once
#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

using OrderedJson = nlohmann::ordered_json;

OrderedJson jsonOf(const SceneDesc& scene);
OrderedJson jsonOf(const ObjectDesc& object);
OrderedJson jsonOf(const Transform& transform);
OrderedJson jsonOf(const std::map<std::string, ModelDesc>& models);

// The text of a file. Throws InputError for what JSON cannot hold.
std::string layOut(const OrderedJson& value);

} // namespace rt::scene
