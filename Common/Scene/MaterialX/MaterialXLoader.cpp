#include "Common/Scene/MaterialX/MaterialXLoader.h"

#include <cstddef>
#include <set>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/MaterialX/MaterialXSurface.h"
#include "Common/Scene/MaterialX/MaterialXValues.h"
#include "Common/Scene/Obj/ObjText.h"

namespace rt::scene {

namespace {

constexpr std::uint64_t kMaxMaterialXBytes = 16u << 20;
constexpr std::size_t kMaxMaterials = 10'000;

void checkRoot(const XmlElement& root, const std::string& file) {
    const auto fail = [&](const std::string& message) {
        throw InputError(file + ":" + std::to_string(root.line) + ": " + materialXPlace(root) + ": " + message);
    };
    if (root.name != "materialx") fail("must be <materialx>");
    const std::string version = root.attribute("version");
    const std::size_t dot = version.find('.');
    const auto major = numberOf(version.substr(0, dot));
    const auto minor = dot == version.npos ? std::optional(0.0) : numberOf(version.substr(dot + 1));
    if (!major || !minor || *major != 1 || *minor < 38)
        fail("version \"" + printable(version, 100) + "\": must be 1.38 or a later one of 1");
}

// The surface that a material shows; null: none, or one that a notice leaves out.
const XmlElement* surfaceOf(const MaterialXGraph& graph, const XmlElement& material) {
    const XmlElement* input = material.child("input", "surfaceshader");
    return input != nullptr ? graph.source(*input) : nullptr;
}

} // namespace

SceneDesc parseMaterialX(std::string_view text, const std::string& file, const std::filesystem::path& folder) {
    const XmlElement root = parseXml(text, file);
    checkRoot(root, file);
    SceneDesc scene;
    scene.id = file;
    std::set<std::string> notices;
    UniqueNames materialNames, textureNames;
    MaterialXGraph graph(root, file, folder, notices);
    const auto add = [&](const std::string& name, const XmlElement& node, const MaterialXModel& model) {
        if (scene.materials.size() == kMaxMaterials) graph.fail(node, "there are more than 10000 materials");
        MaterialXSurface surface(graph, model, node, scene, textureNames, notices);
        scene.materials[materialNames.unique(name, "material", scene.materials.size())] = surface.material();
    };
    bool hasMaterials = false;
    for (const XmlElement& node : root.children) {
        if (node.name != "surfacematerial") continue;
        hasMaterials = true;
        const XmlElement* surface = surfaceOf(graph, node);
        const MaterialXModel* model = surface != nullptr ? materialXModel(surface->name) : nullptr;
        const std::string* shown = node.find("uiname"); // may have what names must not
        if (model != nullptr)
            add(shown != nullptr ? *shown : node.attribute("name"), *surface, *model);
        else
            notices.insert(materialXPlace(node) + ": left out: its surface is none of " + kMaterialXModels);
    }
    for (const XmlElement& node : root.children) // surfaces alone
        if (const MaterialXModel* model = hasMaterials ? nullptr : materialXModel(node.name))
            add(node.attribute("name"), node, *model);
    if (scene.materials.empty()) graph.fail(root, std::string("has no surface: one of ") + kMaterialXModels);
    for (const std::string& notice : notices) scene.notices.push_back(file + ": " + notice);
    return scene;
}

SceneDesc loadMaterialX(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = readFile(path, kMaxMaterialXBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return parseMaterialX(text, path.string(), path.parent_path());
}

} // namespace rt::scene
