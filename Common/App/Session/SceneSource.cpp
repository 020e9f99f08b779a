#include "Common/App/Session/SceneSource.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "Common/App/Interactive/CameraController.h"
#include "Common/Core/Error.h"
#include "Common/Core/Paths.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Image/ImageIo.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "Common/Scene/Pbrt/PbrtLoader.h"
#include "Common/Scene/Studio.h"

namespace rt::app {
namespace {

// What the scene compiler wants of an image file: sRGB bytes packed into words, or floats as words. Values of 16
// bits become floats.
scene::TexelData toTexelData(const image::Texels& texels) {
    scene::TexelData data;
    data.width = texels.width;
    data.height = texels.height;
    if (!texels.srgb16.empty()) {
        const bool hasOpacity = !texels.alpha16.empty();
        const auto word = [](std::uint16_t value) { return shared::floatBitsToUint(float(value) / 65535.0f); };
        data.format = hasOpacity ? shared::kTexelLinearF32A : shared::kTexelLinearF32;
        data.isEncoded = true;
        data.words.reserve(texels.srgb16.size() + texels.alpha16.size());
        for (std::size_t i = 0; i < texels.srgb16.size(); ++i) {
            data.words.push_back(word(texels.srgb16[i]));
            if (hasOpacity && i % 3 == 2) data.words.push_back(word(texels.alpha16[i / 3]));
        }
        return data;
    }
    if (texels.srgb8.empty()) {
        data.format = shared::kTexelLinearF32;
        data.words.resize(texels.linear.size());
        std::memcpy(data.words.data(), texels.linear.data(), texels.linear.size() * sizeof(float));
        return data;
    }
    data.format = shared::kTexelSrgb8;
    data.words.resize(texels.srgb8.size() / 3);
    for (std::size_t i = 0; i < data.words.size(); ++i) {
        const std::uint8_t* rgb = &texels.srgb8[3 * i];
        const std::uint32_t alpha = texels.alpha8.empty() ? 0xffu : texels.alpha8[i];
        data.words[i] = rgb[0] | std::uint32_t{rgb[1]} << 8 | std::uint32_t{rgb[2]} << 16 | alpha << 24;
    }
    return data;
}

std::shared_ptr<const scene::CompiledScene> compileWith(const scene::SceneDesc& desc, bool oneSidedLights,
                                                        scene::CompileOptions options) {
    options.oneSidedLights = oneSidedLights;
    std::map<std::filesystem::path, scene::GltfImages> files; // read once each
    options.loadTexels = [&files](const std::filesystem::path& path, std::optional<std::uint32_t> image) {
        if (!image) {
            const auto bytes = std::make_shared<const std::vector<std::byte>>(image::readTexels(path));
            return scene::EncodedTexels(image::texelCount(*bytes),
                                        [bytes, path] { return toTexelData(image::decodeTexels(*bytes, path)); });
        }
        const scene::GltfImages& images = files.try_emplace(path, path).first->second;
        const std::span<const std::byte> bytes = images.encoded(*image);
        const std::string name = path.string() + ": /images/" + std::to_string(*image);
        return scene::EncodedTexels(image::texelCount(bytes),
                                    [bytes, name] { return toTexelData(image::decodeTexels(bytes, name)); });
    };
    return scene::compileScene(desc, options);
}

// The ending of a file, in lower case, with what is packed before ".gz".
std::string kindOf(const std::filesystem::path& path) {
    std::string kind = path.extension().string();
    const auto lower = [](unsigned char c) { return static_cast<char>(std::tolower(c)); };
    std::transform(kind.begin(), kind.end(), kind.begin(), lower);
    return kind == ".gz" ? kindOf(path.stem()) + kind : kind;
}

// What surrounds a model follows from its start, and stays where it is while the model moves: the studio, and the view
// where the file has no camera.
scene::SceneDesc loadAnimatedModel(const std::filesystem::path& path, const scene::Moment& moment) {
    scene::SceneDesc scene = scene::loadGltfScene(path, moment);
    if (moment.time == 0) {
        scene::addStudioIfUnlit(scene, scene::boundsOfMeshes(scene));
        return scene;
    }
    const scene::SceneDesc start = scene::loadGltfScene(path, {moment.animation, 0});
    if (scene.cameras.empty()) scene.camera = start.camera;
    scene::addStudioIfUnlit(scene, scene::boundsOfMeshes(start));
    return scene;
}

} // namespace

scene::SceneDesc loadScene(const std::string& source, const scene::Moment& moment) {
    std::filesystem::path path(source);
    const std::string extension = kindOf(path);
    using Load = scene::SceneDesc (*)(const std::filesystem::path&);
    static const std::map<std::string, Load> loaders = {{".json", scene::loadSceneFile},
                                                        {".obj", scene::loadObjScene},
                                                        {".pbrt", scene::loadPbrtScene},
                                                        {".pbrt.gz", scene::loadPbrtScene}};
    const auto loader = loaders.find(extension);
    const bool isGltf = extension == ".gltf" || extension == ".glb";
    if (loader == loaders.end() && !isGltf) {
        scene::SceneDesc scene = scene::findBuiltinScene(source);
        noticeStandstill(moment, scene.notices);
        return scene;
    }
    std::error_code none;
    if (path.is_relative() && !std::filesystem::exists(path, none)) path = findAsset("scenes" / path).value_or(path);
    if (isGltf) return loadAnimatedModel(path, moment);
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
