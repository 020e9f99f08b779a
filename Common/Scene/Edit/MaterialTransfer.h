// Materials of one scene for objects of another one, as edits of that.
#pragma once
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "Common/Scene/Edit/SceneEdit.h"

namespace rt::scene {

// Objects with a material of their own: the object, or of a group all that are in it.
std::vector<ObjectPath> surfacesOf(const SceneDesc& scene, const ObjectPath& path);

// A name that is not taken: that one, or with a number behind it. isTaken(name)
template <typename IsTaken>
std::string freeName(const std::string& like, const IsTaken& isTaken) {
    std::string name = like;
    for (int number = 2; isTaken(name); ++number) name = like + " " + std::to_string(number);
    return name;
}

// Gathers edits that are to be made in one step.
class MaterialTransfer {
  public:
    // Both must outlive this.
    MaterialTransfer(const SceneDesc& scene, const SceneDesc& source)
        : source_(source), textures_{scene.textures, {}}, materials_{scene.materials, {}}, scene_(scene) {}

    // A material of the source, with its textures. Its name in the scene: that of one that is equal, else of a new one.
    std::string bring(const std::string& material);
    // A material that the scene has by then, for the surfaces of these objects; whether there are any.
    bool assign(std::span<const ObjectPath> objects, const std::string& material);
    std::vector<SceneEdit> takeEdits() { return std::move(edits_); } // none: all is so already

  private:
    template <typename Value>
    struct Section {
        const std::map<std::string, Value>& there;
        std::map<std::string, Value> added;

        // The name of what is equal, and false; or a free one like that, by which it was added.
        std::pair<std::string, bool> place(const std::string& like, const Value& value);
    };
    std::string bringTexture(const std::string& name);

    const SceneDesc& source_;
    Section<TextureDesc> textures_;
    Section<MaterialDesc> materials_;
    std::map<std::string, std::string> broughtTextures_; // from the source's names to the scene's
    std::vector<SceneEdit> edits_;
    const SceneDesc& scene_;
};

} // namespace rt::scene
