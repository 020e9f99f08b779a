// Scene files as they lie on the disk, at a moment of what they import.
#include <optional>
#include <utility>

#include "Common/Scene/Json/Import.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/ModelFile.h"

namespace rt::scene {
namespace {

std::string_view sceneText(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

SceneDesc readPosed(const std::vector<std::byte>& bytes, const std::filesystem::path& path, ModelReader reader) {
    bool isImport = false; // which the model's own reader has told what counts for nothing
    reader.load = [&isImport, load = std::move(reader.load)](const std::filesystem::path& file, const Moment& moment) {
        isImport = true;
        return load(file, moment);
    };
    SceneDesc scene = parseSceneAt(sceneText(bytes), path.string(), path.parent_path(), reader);
    scene.id = path.filename().string();
    if (!isImport) noticeStandstill(reader.asked, scene.notices);
    return scene;
}

} // namespace

SceneDesc loadSceneFile(const std::filesystem::path& path, const Moment& asked) {
    return readPosed(readSceneFile(path), path, {asked, loadModelFile});
}

std::optional<ImportDesc> importOf(const std::filesystem::path& sceneFile) {
    return importIn(sceneText(readSceneFile(sceneFile)), sceneFile);
}

PosedSceneFile::PosedSceneFile(const std::filesystem::path& path) : path_(path), text_(readSceneFile(path)) {
    const std::optional<ImportDesc> import = importIn(sceneText(text_), path_);
    if (!import || !isGltfFile(import->file)) return;
    model_ = std::make_unique<AnimatedModel>(fileOfImport(*import));
    if (!model_->isAnimated()) model_.reset();
}

PosedSceneFile::~PosedSceneFile() = default;

SceneDesc PosedSceneFile::at(const Moment& asked) {
    if (!model_) return readPosed(text_, path_, {asked, loadModelFile});
    const auto load = [this](const std::filesystem::path&, const Moment& moment) { return model_->at(moment); };
    return readPosed(text_, path_, {asked, load});
}

} // namespace rt::scene
