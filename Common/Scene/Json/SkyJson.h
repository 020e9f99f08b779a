// Skies in scene files.
#pragma once
#include "Common/Scene/Json/SceneReader.h"
#include "Common/Scene/Json/SceneWriter.h"

namespace rt::scene {

Background readSky(const JsonNode& node, const SceneReferences& references);
OrderedJson skyJson(const Background& sky);

} // namespace rt::scene
