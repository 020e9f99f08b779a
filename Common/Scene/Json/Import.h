// Scene files that begin with a model and change it: what they name of it, and what it becomes.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Json/SceneReader.h"
#include "Common/Scene/ModelFile.h"

namespace rt::scene {

// Objects of a list by what they are called and the how many-eth of that name they are, "wood #2 of 3": called by their
// prototype or their material, else by their type. The list must not change meanwhile.
class ObjectKeys {
  public:
    explicit ObjectKeys(const std::vector<ObjectDesc>& objects);

    std::string key(std::size_t index) const;
    std::optional<std::size_t> find(const std::string& key) const; // " of 3" may be missing, and need not be true
    bool isOfAnotherList(const std::string& key) const;            // which has another number that are called so
    std::size_t countLike(const std::string& key) const;           // how many are called so

  private:
    std::vector<std::string> keys_; // without " of 3"
    std::unordered_map<std::string, std::size_t> places_, counts_;
};

// ---- reading -------------------------------------------------------------------------------------------------------

// How the model is read, and at which moment it is wanted.
struct ModelReader {
    Moment asked = {};
    std::function<SceneDesc(const std::filesystem::path&, const Moment&)> load = loadModelFile;
};

ImportDesc readImport(const JsonNode& node, const SceneReferences& references);
std::filesystem::path fileOfImport(const ImportDesc& import); // the one that there is, be it named in other case
// What the scene begins with: `import`, `models`, or both.
SceneDesc readBase(const JsonNode& root, const SceneReferences& references, const ModelReader& reader);
void removeFromModel(const JsonNode& removed, SceneDesc& scene);
void changeModel(const JsonNode& changes, const SceneReferences& references, SceneDesc& scene);
// What is used must not have been removed.
void checkNames(const JsonNode& root, const SceneDesc& scene);

// As parseScene(), on a model that has been read by now, or that the reader reads. Throws UsageError, too, of the
// moment that is asked for.
SceneDesc parseSceneOn(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                       std::optional<SceneDesc> model);
SceneDesc parseSceneAt(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                       const ModelReader& reader);
std::optional<ImportDesc> importIn(std::string_view text, const std::filesystem::path& sceneFile);
std::vector<std::byte> readSceneFile(const std::filesystem::path& path);

} // namespace rt::scene
