// The parts of reading a scene file; SceneJson.h is the interface.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Json/JsonText.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// What values of a scene file refer to: names in its sections, and files.
class SceneReferences {
  public:
    // Both must outlive this.
    SceneReferences(const JsonNode& root, const std::filesystem::path& folder) : root_(root), folder_(folder) {}

    // What the scene begins with (import) has names, too. It must outlive this, and name what is left of it.
    void setModel(const SceneDesc* model) { model_ = model; }
    // Of a model's object what it becomes may refer to; null: there is none.
    void setOriginal(const ObjectDesc* original) { original_ = original; }
    const ObjectDesc* original() const { return original_; }

    // The name of a member of a section of the scene.
    std::string name(const JsonNode& node, const char* section) const;
    // A constant colour with components in [0,1], or the name of a texture.
    ColorOrTexture colorOrTexture(const JsonNode& node) const;
    // An existing file: its full path if it lies beside the scene, its name if it is an asset. With a stand-in it may
    // be missing.
    std::string file(const JsonNode& node, bool hasStandIn) const;

  private:
    const JsonNode& root_;
    const std::filesystem::path& folder_;
    const SceneDesc* model_ = nullptr;
    const ObjectDesc* original_ = nullptr;
};

// One of a list of names.
std::string readChoice(const JsonNode& node, const std::vector<std::string>& allowed);

TextureDesc readTexture(const JsonNode& node, const SceneReferences& references);
MaterialDesc readMaterial(const JsonNode& node, const SceneReferences& references);
std::vector<ObjectDesc> readObjects(const JsonNode& node, const SceneReferences& references);
// Of the array that `text` may have left out of the document.
std::vector<ObjectDesc> readObjects(const JsonNode& node, const SceneReferences& references, const LongJson& text);
TargetDesc readTarget(const JsonNode& node);

} // namespace rt::scene
