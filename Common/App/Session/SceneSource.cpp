#include "Common/App/Session/SceneSource.h"

#include <algorithm>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "Common/App/Interactive/CameraController.h"
#include "Common/App/Session/PosedScene.h"
#include "Common/Core/Error.h"
#include "Common/Core/Paths.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/ModelFile.h"

namespace rt::app {
namespace {

// Consumes a description that is moved in.
template <class Desc>
std::shared_ptr<const scene::CompiledScene> compileWith(Desc&& desc, bool oneSidedLights,
                                                        scene::CompileOptions options) {
    options.oneSidedLights = oneSidedLights;
    if (!options.loadTexels) options.loadTexels = makeTexelLoader();
    return scene::compileScene(std::forward<Desc>(desc), options);
}

// A name of something that is there is no misspelt id.
void refuseOtherFile(const std::string& source) {
    std::error_code none;
    const std::filesystem::file_status status = std::filesystem::status(source, none);
    if (!std::filesystem::exists(status)) return;
    const char* const what = std::filesystem::is_directory(status) ? "is a folder" : "is no file of a known kind";
    throw InputError("scene \"" + printable(source) + "\": " + what +
                     "; allowed is an id that --list-scenes lists, or a .json, .obj, .gltf, .glb or .pbrt file");
}

scene::CompileOptions optionsOf(const scene::SceneDesc& desc, const SceneRequest& request,
                                scene::CompileMemory* memory) {
    scene::CompileOptions options;
    options.memory = memory;
    options.installedMaps = true;
    if (!request.pose.empty()) options.camera = cameraOf(request.pose, desc);
    return options;
}

} // namespace

std::filesystem::path fileNamedBy(const std::string& source) {
    std::filesystem::path path(source);
    std::error_code none;
    if (path.is_relative() && !std::filesystem::exists(path, none)) path = findAsset("scenes" / path).value_or(path);
    return path;
}

scene::SceneDesc loadScene(const std::string& source, const scene::Moment& moment) {
    const bool isSceneFile = scene::kindOfFile(source) == ".json";
    if (!isSceneFile && !scene::isModelFile(source)) {
        if (!scene::isBuiltinScene(source)) refuseOtherFile(source);
        scene::SceneDesc scene = scene::findBuiltinScene(source);
        noticeStandstill(moment, scene.notices);
        return scene;
    }
    const std::filesystem::path path = fileNamedBy(source);
    return isSceneFile ? scene::loadSceneFile(path, moment) : scene::loadModelFile(path, moment);
}

std::shared_ptr<const scene::CompiledScene> compile(const scene::SceneDesc& desc, bool oneSidedLights,
                                                    bool generatedAssets, const std::string& camera) {
    scene::CompileOptions options;
    options.generatedAssets = generatedAssets;
    if (!camera.empty()) options.camera = cameraOf(camera, desc);
    return compileWith(desc, oneSidedLights, options);
}

std::shared_ptr<const scene::CompiledScene> compile(const SceneRequest& request) {
    const ReadsBelow confined(request.assetsBelow, request.source);
    return compile(loadScene(request.source, request.moment), request);
}

std::shared_ptr<const scene::CompiledScene> compileKept(const scene::SceneDesc& desc, const SceneRequest& request,
                                                        scene::CompileMemory* memory, const TexelLoader& loadTexels) {
    const ReadsBelow confined(request.assetsBelow, request.source);
    scene::CompileOptions options = optionsOf(desc, request, memory);
    options.loadTexels = loadTexels;
    return compileWith(desc, request.oneSidedLights, options);
}

std::shared_ptr<const scene::CompiledScene> compile(scene::SceneDesc desc, const SceneRequest& request) {
    const ReadsBelow confined(request.assetsBelow, request.source);
    const scene::CompileOptions options = optionsOf(desc, request, nullptr);
    auto compiled = compileWith(std::move(desc), request.oneSidedLights, options);
    desc = {}; // as large as what was made of it, and engines now want memory
    releaseFreedMemory();
    return compiled;
}

scene::Moment wholeMoment(const SceneRequest& request) {
    scene::Moment moment = request.moment;
    if (!moment.isWhole && scene::kindOfFile(request.source) == ".json") {
        const ReadsBelow confined(request.assetsBelow, request.source);
        if (const auto import = scene::importOf(fileNamedBy(request.source)))
            moment = momentOfImport(import->moment, moment);
    }
    moment.isWhole = true;
    return moment;
}

PoseScene posesOf(const SceneRequest& request) {
    auto scene = std::make_shared<PosedScene>(request);
    return scene->isAnimated() ? posesOf(std::move(scene), request.moment) : PoseScene{};
}

scene::CameraDesc poseOf(const std::string& pose, const scene::CameraDesc& scenes) {
    const auto camera = CameraController::fromText(pose, scenes);
    if (camera) return *camera;
    throw UsageError("--camera " + pose +
                     ": allowed is a JSON object of look_from, look_at and up, each three numbers, vertical_fov, "
                     "defocus_angle and focus_distance, as a window copies its pose");
}

scene::CameraDesc cameraOf(const std::string& text, const scene::SceneDesc& scene) {
    if (isPose(text)) return poseOf(text, scene.camera);
    const auto found = scene.cameras.find(text);
    if (found != scene.cameras.end()) return found->second;
    std::string names;
    for (const auto& [name, camera] : scene.cameras) names += (names.empty() ? "" : ", ") + name;
    throw UsageError("--camera " + printable(text) + ": " +
                     (names.empty() ? "the scene has no cameras with names; allowed is a pose as JSON"
                                    : "allowed is a pose as JSON, or one of the scene's cameras: " + names));
}

bool isPose(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != text.npos && text[first] == '{';
}

std::string listScenes(bool json) {
    const std::span<const scene::BuiltinScene> scenes = scene::builtinScenes();
    if (json) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (const scene::BuiltinScene& scene : scenes)
            list.push_back({{"id", scene.id}, {"title", scene.title}, {"description", scene.description}});
        return list.dump(2) + "\n";
    }
    std::size_t longest = 0;
    for (const scene::BuiltinScene& scene : scenes) longest = std::max(longest, scene.id.size());
    std::string text;
    for (const scene::BuiltinScene& scene : scenes)
        text +=
            std::string(scene.id) + std::string(longest + 2 - scene.id.size(), ' ') + std::string(scene.title) + "\n";
    return text;
}

} // namespace rt::app
