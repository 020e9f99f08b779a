#include "Common/App/Interactive/SceneFileText.h"

#include <filesystem>
#include <optional>
#include <utility>

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
        if (std::optional<scene::ImportDesc> import = importBehind(source, moment)) {
            scene::SceneDesc model = scene::loadModelFile(import->file, import->moment);
            std::error_code error;
            const fs::path folder = fs::absolute(file, error).parent_path();
            const fs::path beside = import->file.lexically_relative(folder);
            if (!error && !beside.empty()) import->file = beside; // empty: on another drive
            return scene::toJson(scene, *import, std::move(model));
        }
    } catch (const Error&) { // what is saved must not depend on it
    }
    return scene::toJson(scene);
}

} // namespace rt::app
