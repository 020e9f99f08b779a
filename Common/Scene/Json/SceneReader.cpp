// Reading of scene files: the scene as a whole, camera, and what its parts refer to.
#include "Common/Scene/Json/SceneReader.h"

#include <cstdint>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <glm/geometric.hpp>

#include "Common/Core/OtherCase.h"
#include "Common/Core/Paths.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Json/Import.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Json/SkyJson.h"

namespace rt::scene {

namespace {

constexpr std::uint64_t kMaxSceneBytes = std::uint64_t{4} << 30;

CameraDesc readCamera(const JsonNode& node) {
    node.expectKeys({"look_from", "look_at", "up", "vertical_fov", "defocus_angle", "focus_distance"});
    CameraDesc camera;
    if (const auto value = node.find("look_from")) camera.lookFrom = value->vector();
    if (const auto value = node.find("look_at")) camera.lookAt = value->vector();
    if (const auto value = node.find("up")) camera.up = value->vector();
    if (const auto value = node.find("vertical_fov")) {
        camera.verticalFov = value->number();
        if (!(camera.verticalFov > 0 && camera.verticalFov < 180)) value->failValue("a number between 0 and 180");
    }
    if (const auto value = node.find("defocus_angle")) {
        camera.defocusAngle = value->number();
        if (!(camera.defocusAngle >= 0 && camera.defocusAngle < 180)) value->failValue("a number from 0 to below 180");
    }
    if (const auto value = node.find("focus_distance")) camera.focusDistance = value->positive();
    const glm::dvec3 view = camera.lookAt - camera.lookFrom;
    if (!(glm::length(glm::cross(view, camera.up)) > 1e-9 * glm::length(view) * glm::length(camera.up)))
        node.fail("look_from and look_at must differ, and up must not be 0 or parallel to the view");
    return camera;
}

RenderDefaults readRender(const JsonNode& node) {
    node.expectKeys({"aspect"});
    RenderDefaults defaults;
    if (const auto aspect = node.find("aspect")) defaults.aspect = aspect->positive();
    return defaults;
}

// `model`: what the import has led to; empty: it is read.
SceneDesc readScene(const JsonNode& root, SceneReferences references, const LongJson& text,
                    std::optional<SceneDesc> model, const ModelReader& reader) {
    root.expectKeys({"$schema", "version", "title", "comment", "import", "models", "removed", "changes", "camera",
                     "cameras", "background", "textures", "materials", "prototypes", "objects", "importance_targets",
                     "render"});
    if (const auto version = root.find("version"); version && version->value() != 1) version->failValue("1");
    const bool hasModel = root.has("import") || root.has("models");
    for (const char* key : {"removed", "changes"})
        if (!hasModel && root.has(key))
            root.at(key).fail("there is neither \"import\" nor \"models\" that it could change");
    SceneDesc scene;
    if (hasModel) {
        scene = model ? std::move(*model) : readBase(root, references, reader);
        references.setModel(&scene);
    }
    if (const auto removed = root.find("removed")) removeFromModel(*removed, scene);
    if (const auto node = root.find("title")) scene.title = node->string();
    if (const auto lines = root.find("comment")) // for readers of the file
        lines->forEachElement([](const JsonNode& line) { (void)line.string(); });
    if (const auto node = root.find("camera")) scene.camera = readCamera(*node);
    if (const auto section = root.find("cameras"))
        section->forEachMember(
            [&](const std::string& name, const JsonNode& node) { scene.cameras[name] = readCamera(node); });
    if (const auto node = root.find("background")) scene.background = readSky(*node, references);
    if (const auto section = root.find("textures"))
        section->forEachMember([&](const std::string& name, const JsonNode& node) {
            scene.textures[name] = readTexture(node, references);
        });
    if (const auto section = root.find("materials"))
        section->forEachMember([&](const std::string& name, const JsonNode& node) {
            scene.materials[name] = readMaterial(node, references);
        });
    if (const auto section = root.find("prototypes"))
        section->forEachMember([&](const std::string& name, const JsonNode& node) {
            scene.prototypes[name] = readObjects(node, references);
        });
    if (const auto changes = root.find("changes")) changeModel(*changes, references, scene);
    std::vector<ObjectDesc> own = readObjects(root.at("objects"), references, text);
    if (scene.objects.empty())
        scene.objects = std::move(own);
    else
        std::move(own.begin(), own.end(), std::back_inserter(scene.objects));
    if (hasModel) checkNames(root, scene);
    if (root.has("importance_targets")) scene.importanceTargets.clear();
    if (const auto section = root.find("importance_targets"))
        section->forEachElement([&](const JsonNode& node) { scene.importanceTargets.push_back(readTarget(node)); });
    if (const auto node = root.find("render")) scene.render = readRender(*node);
    return scene;
}

} // namespace

// ---- references ----------------------------------------------------------------------------------------------------

namespace {

// Of a section of a scene: whether it has the name, and the first of those that it has.
bool sectionHas(const SceneDesc& scene, std::string_view section, const std::string& name) {
    return section == "textures"    ? scene.textures.contains(name)
           : section == "materials" ? scene.materials.contains(name)
                                    : scene.prototypes.contains(name);
}

void addKnown(const std::string& name, std::string& known) {
    constexpr std::size_t kMostCharacters = 200;
    if (known.size() < kMostCharacters) known += (known.empty() ? "" : ", ") + printable(name);
}

void addKnownNames(const SceneDesc& scene, std::string_view section, std::string& known) {
    const auto add = [&](const auto& named) {
        for (const auto& [name, value] : named) addKnown(name, known);
    };
    section == "textures" ? add(scene.textures) : section == "materials" ? add(scene.materials) : add(scene.prototypes);
}

} // namespace

std::string SceneReferences::name(const JsonNode& node, const char* section) const {
    std::string text = node.string();
    const auto names = root_.find(section);
    const bool isModels = model_ != nullptr && sectionHas(*model_, section, text);
    if (isModels || (names && names->has(text.c_str()))) return text;
    std::string known;
    if (names && names->value().is_object())
        for (const auto& member : names->value().items()) addKnown(member.key(), known);
    if (model_ != nullptr) addKnownNames(*model_, section, known);
    node.failValue("a name from " + std::string(section) + (known.empty() ? ", which is empty" : ": " + known));
}

ColorOrTexture SceneReferences::colorOrTexture(const JsonNode& node) const {
    if (node.value().is_string()) return name(node, "textures");
    if (!node.value().is_array()) node.failValue("an array of 3 numbers from 0 to 1, or the name of a texture");
    return node.vectorWithin(0, 1);
}

std::string SceneReferences::file(const JsonNode& node, bool hasStandIn) const {
    std::string text = node.string();
    if (text.find('\0') != text.npos) node.failValue("a name of a file, which has no character 0");
    const std::filesystem::path path(text);
    const std::filesystem::path beside = path.is_absolute() ? path : folder_ / path;
    const std::filesystem::path whole = path.empty() ? path : std::filesystem::absolute(beside).lexically_normal();
    std::error_code ignored;
    if (std::filesystem::is_regular_file(whole, ignored) || !findInOtherCase(whole).empty())
        return whole.generic_string();
    const bool isAsset = !path.empty() && path.is_relative() && findAsset(path);
    if (!hasStandIn && !isAsset) node.failValue("an existing file, beside the scene or among the assets");
    return text;
}

std::string readChoice(const JsonNode& node, const std::vector<std::string>& allowed) {
    std::string text = node.string();
    std::string known;
    for (const std::string& name : allowed) {
        if (name == text) return text;
        known += (known.empty() ? "" : ", ") + name;
    }
    node.failValue("one of " + known);
}

// ---- interface -----------------------------------------------------------------------------------------------------

namespace {

SceneDesc parsedScene(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                      std::optional<SceneDesc> model, const ModelReader& reader) {
    const LongJson json(text, file, "objects");
    const LargeJson document = json.document();
    const JsonNode root(*document, file);
    SceneDesc scene = readScene(root, SceneReferences(root, folder), json, std::move(model), reader);
    scene.id = file;
    return scene;
}

} // namespace

SceneDesc parseSceneOn(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                       std::optional<SceneDesc> model) {
    return parsedScene(text, file, folder, std::move(model), {});
}

SceneDesc parseSceneAt(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                       const ModelReader& reader) {
    return parsedScene(text, file, folder, std::nullopt, reader);
}

SceneDesc parseScene(std::string_view text, const std::string& file, const std::filesystem::path& folder) {
    return parsedScene(text, file, folder, std::nullopt, {});
}

std::optional<ImportDesc> importIn(std::string_view text, const std::filesystem::path& sceneFile) {
    const std::string name = sceneFile.string();
    const LongJson json(text, name, "objects");
    const LargeJson document = json.document();
    const JsonNode root(*document, name);
    const std::filesystem::path folder = sceneFile.parent_path();
    const auto import = root.find("import");
    return import ? std::optional(readImport(*import, SceneReferences(root, folder))) : std::nullopt;
}

std::vector<std::byte> readSceneFile(const std::filesystem::path& path) {
    return readFile(path, kMaxSceneBytes);
}

} // namespace rt::scene
