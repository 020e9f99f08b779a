#include "Common/App/Interactive/SceneFileText.h"

#include <filesystem>
#include <optional>

#include "Common/Core/Error.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/ModelFile.h"

namespace rt::app {

namespace fs = std::filesystem;

namespace {

std::optional<scene::ImportDesc> importBehind(const fs::path& source, const scene::Moment& moment) {
    std::error_code none;
    if (!fs::is_regular_file(source, none)) return std::nullopt; // a built-in scene
    if (scene::isModelFile(source)) return scene::ImportDesc{source, moment};
    std::optional<scene::ImportDesc> import = scene::importOf(source);
    if (import) import->moment = momentOfImport(import->moment, moment);
    return import;
}

} // namespace

std::string sceneFileText(const scene::SceneDesc& scene, const std::string& source, const scene::Moment& moment,
                          const std::string& file) {
    try {
        const std::optional<scene::ImportDesc> import = importBehind(source, moment);
        if (import || !scene.models.empty()) {
            std::error_code error;
            const fs::path folder = fs::absolute(file, error).parent_path();
            return scene::toJson(scene, import, scene::baseOf(import, scene.models), error ? fs::path() : folder);
        }
    } catch (const Error&) { // what is saved must not depend on it
    }
    return scene::toJson(scene);
}

} // namespace rt::app
