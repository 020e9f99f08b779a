#include "Common/App/Session/SceneSource.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "Common/App/Interactive/CameraController.h"
#include "Common/App/Session/SceneImages.h"
#include "Common/Core/Error.h"
#include "Common/Core/Paths.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "Common/Scene/Pbrt/PbrtLoader.h"
#include "Common/Scene/Studio.h"

namespace rt::app {
namespace {

std::shared_ptr<const scene::CompiledScene> compileWith(const scene::SceneDesc& desc, bool oneSidedLights,
                                                        scene::CompileOptions options) {
    options.oneSidedLights = oneSidedLights;
    if (!options.loadTexels) options.loadTexels = makeTexelLoader();
    return scene::compileScene(desc, options);
}

// The ending of a file, in lower case, with what is packed before ".gz".
std::string kindOf(const std::filesystem::path& path) {
    std::string kind = path.extension().string();
    const auto lower = [](unsigned char c) { return static_cast<char>(std::tolower(c)); };
    std::transform(kind.begin(), kind.end(), kind.begin(), lower);
    return kind == ".gz" ? kindOf(path.stem()) + kind : kind;
}

// A model's scene at any time of an animation. What surrounds it follows from its start, and stays where it is while
// the model moves: the studio, and the view where the file has no camera.
class AnimatedModel {
  public:
    AnimatedModel(const std::filesystem::path& path, scene::Moment moment) : file_(path), moment_(std::move(moment)) {}

    bool isAnimated() const { return file_.isAnimated(); }

    scene::SceneDesc at(double seconds) {
        scene::SceneDesc scene = file_.at({moment_.animation, seconds, moment_.isAsked});
        if (!start_) start_ = seconds == 0 ? startOf(scene) : startOf(file_.at({moment_.animation, 0}));
        if (scene.cameras.empty()) scene.camera = start_->camera;
        scene::addStudioIfUnlit(scene, start_->bounds);
        return scene;
    }

  private:
    struct Start {
        scene::CameraDesc camera;
        scene::Bounds bounds;
    };
    static Start startOf(const scene::SceneDesc& scene) { return {scene.camera, scene::boundsOfMeshes(scene)}; }

    const scene::GltfScene file_;
    const scene::Moment moment_; // but for its time
    std::optional<Start> start_; // once a pose was asked for
};

bool namesGltf(const std::filesystem::path& path) {
    const std::string kind = kindOf(path);
    return kind == ".gltf" || kind == ".glb";
}

// Of the source, or of the assets' file of this name.
std::filesystem::path fileNamedBy(const std::string& source) {
    std::filesystem::path path(source);
    std::error_code none;
    if (path.is_relative() && !std::filesystem::exists(path, none)) path = findAsset("scenes" / path).value_or(path);
    return path;
}

} // namespace

scene::SceneDesc loadScene(const std::string& source, const scene::Moment& moment) {
    const std::string extension = kindOf(source);
    using Load = scene::SceneDesc (*)(const std::filesystem::path&);
    static const std::map<std::string, Load> loaders = {{".json", scene::loadSceneFile},
                                                        {".obj", scene::loadObjScene},
                                                        {".pbrt", scene::loadPbrtScene},
                                                        {".pbrt.gz", scene::loadPbrtScene}};
    const auto loader = loaders.find(extension);
    if (loader == loaders.end() && !namesGltf(source)) {
        scene::SceneDesc scene = scene::findBuiltinScene(source);
        noticeStandstill(moment, scene.notices);
        return scene;
    }
    const std::filesystem::path path = fileNamedBy(source);
    if (namesGltf(path)) return AnimatedModel(path, moment).at(moment.time);
    scene::SceneDesc scene = loader->second(path);
    noticeStandstill(moment, scene.notices);
    // Files of scenes, as those of models do not, say what light there is.
    if (extension == ".obj") scene::addStudioIfUnlit(scene, scene::boundsOfMeshes(scene));
    return scene;
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
                                                        scene::CompileMemory* memory) {
    const ReadsBelow confined(request.assetsBelow, request.source);
    scene::CompileOptions options;
    options.memory = memory;
    options.installedMaps = true;
    if (!request.pose.empty()) options.camera = cameraOf(request.pose, desc);
    return compileWith(desc, request.oneSidedLights, options);
}

std::shared_ptr<const scene::CompiledScene> compile(scene::SceneDesc desc, const SceneRequest& request) {
    std::optional<scene::SceneDesc> kept(std::move(desc));
    auto compiled = compileKept(*kept, request, nullptr);
    kept.reset(); // as large as what was made of it, and engines now want memory
    releaseFreedMemory();
    return compiled;
}

PoseScene posesOf(const SceneRequest& request) {
    if (!namesGltf(request.source)) return {};
    const ReadsBelow confined(request.assetsBelow, request.source);
    const auto model = std::make_shared<AnimatedModel>(fileNamedBy(request.source), request.moment);
    if (!model->isAnimated()) return {};
    return [request, model, loadTexels = makeKeepingTexelLoader()](double seconds) {
        const ReadsBelow readsBelow(request.assetsBelow, request.source);
        const scene::SceneDesc desc = model->at(seconds);
        scene::CompileOptions options;
        options.installedMaps = true;
        options.loadTexels = loadTexels;
        if (!request.pose.empty()) options.camera = cameraOf(request.pose, desc);
        return compileWith(desc, request.oneSidedLights, options);
    };
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
