// Models that a scene has taken in beside what is its own. Names of a model's textures, materials and prototypes begin
// with that of the model and ": "; its objects are the prototype that is called as the model is.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

struct ModelContents {
    std::map<std::string, TextureDesc> textures;
    std::map<std::string, MaterialDesc> materials;
    std::map<std::string, std::vector<ObjectDesc>> prototypes;
    std::vector<std::string> notices; // of reading it
    bool operator==(const ModelContents&) const = default;
};

// Whether a model can be called so: by something, in which what parts names does not occur.
bool isModelName(const std::string& name);
// Whether anything has a name that is the model's.
bool hasContents(const SceneDesc& scene, const std::string& name);
// One that can be shown, made of that of the file, of which the scene has nothing yet.
std::string freeModelName(const SceneDesc& scene, const std::string& file);

// What the scene of a file brings into another one: its objects with what they are made of, and neither its sky, nor
// cameras, nor targets.
ModelContents contentsOf(const std::string& name, SceneDesc file);
// Throws InputError as loadModelFile() and loadSceneFile() do, UsageError for an animation that there is not, and
// InputError for a scene file that takes in itself.
ModelContents readModel(const std::string& name, const ModelDesc& model);

// To a scene that has nothing of that model, and the reverse. Notices are left alone.
void addContents(SceneDesc& scene, ModelContents contents);
ModelContents takeContents(SceneDesc& scene, const std::string& name);

// How many objects, materials and textures that are not the model's refer to what is.
std::size_t modelUses(const SceneDesc& scene, const std::string& name);

} // namespace rt::scene
