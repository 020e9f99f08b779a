// Where in a scene a model is put that somebody adds to it.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Of the surfaces and media of a prototype, hidden ones included; meshes whose data is in files of their own are left
// out.
Bounds boundsOfPrototype(const std::map<std::string, std::vector<ObjectDesc>>& prototypes, const std::string& name);

// Nothing, so that it stands where its file has it, if that lies within the scene and is not too small to be seen from
// the camera. Else its middle comes to where the camera looks, scaled where it would fill the view or be a speck.
Transform placeOfModel(const Bounds& model, const Bounds& scene, const CameraDesc& camera);

} // namespace rt::scene
