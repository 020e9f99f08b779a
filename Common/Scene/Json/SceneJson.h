// Scene files. The format is published as Assets/scene.schema.json.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "Common/Scene/Moment.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

class AnimatedModel;

// Reads a scene file; files it names are looked for beside it, then among the assets. A model that it imports is posed
// as `asked` and momentOfImport() say; where nothing is imported, nothing moves. Throws InputError: for syntax with line
// and column, for contents with the JSON path, the value and what is allowed; and UsageError for an animation that was
// asked for and is not there.
SceneDesc loadSceneFile(const std::filesystem::path& path, const Moment& asked = {});

// The same from a text; `file` stands in messages, `folder` is where files are looked for first.
SceneDesc parseScene(std::string_view text, const std::string& file, const std::filesystem::path& folder);

// The text of a scene file that names no models: all of it is there. parseScene gives back an equal description, but
// for its id and its models, and numbers to the last bit.
std::string toJson(const SceneDesc& scene);

// A model that a scene file begins with, and changes: the file is named, not copied.
struct ImportDesc {
    std::filesystem::path file; // whole, or as it is to be written
    Moment moment;
};
std::optional<ImportDesc> importOf(const std::filesystem::path& sceneFile); // none: the file has all by itself

// A scene file that is read once, with what it imports, to be posed as often as one likes.
class PosedSceneFile {
  public:
    explicit PosedSceneFile(const std::filesystem::path& path); // throws InputError
    ~PosedSceneFile();
    bool isAnimated() const { return model_ != nullptr; }
    SceneDesc at(const Moment& asked); // as loadSceneFile()

  private:
    const std::filesystem::path path_;
    const std::vector<std::byte> text_;
    std::unique_ptr<AnimatedModel> model_; // null: it imports none
};

// What a scene begins with that is not its own: the import, if there is one, and those of its models that can be read.
// Throws what reading the import does.
SceneDesc baseOf(const std::optional<ImportDesc>& import, const std::map<std::string, ModelDesc>& models);
// The text of a scene file, to be in that folder, of what the scene has beyond its base, whose import and models it
// names. Throws InputError where reading it would not give an equal description.
std::string toJson(const SceneDesc& scene, const std::optional<ImportDesc>& import, SceneDesc base,
                   const std::filesystem::path& folder);

} // namespace rt::scene
