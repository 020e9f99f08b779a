// The library of materials: its files, where its numbers come from, and how they get into a scene.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Interactive/MaterialPresets.h"
#include "Common/Image/ImageIo.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Edit/MaterialTransfer.h"
#include "Common/Scene/Edit/SceneDocument.h"
#include "Common/Scene/Pbrt/PbrtLoader.h"
#include "Common/Scene/Pbrt/PbrtSpectrum.h"
#include "tests/TempFolder.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;
using scene::MaterialDesc;
using scene::ObjectPath;
using scene::SceneDesc;

const fs::path kLibrary = fs::path(RT_SOURCE_DIR) / "Assets" / "materials";

std::vector<MaterialPreset> library() {
    std::vector<std::string> failures;
    std::vector<MaterialPreset> presets = readMaterialPresets(kLibrary, failures);
    EXPECT_TRUE(failures.empty()) << failures.front();
    return presets;
}

const MaterialDesc& materialOf(const MaterialPreset& preset) {
    return preset.scene->materials.at(preset.name);
}

const MaterialPreset& find(const std::vector<MaterialPreset>& presets, const std::string& name) {
    for (const MaterialPreset& preset : presets)
        if (preset.name == name) return preset;
    throw std::runtime_error(name);
}

TEST(MaterialPresets, ThereAreThirtyWithSourcesAndPictures) {
    const std::vector<MaterialPreset> presets = library();
    EXPECT_EQ(presets.size(), 30u);
    std::set<std::string> names, pictures;
    std::uintmax_t bytes = 0;
    for (const MaterialPreset& preset : presets) {
        EXPECT_TRUE(names.insert(preset.name).second) << preset.name;
        EXPECT_TRUE(pictures.insert(preset.picture()).second) << preset.name;
        EXPECT_FALSE(preset.group.empty()) << preset.name;
        EXPECT_FALSE(preset.source.empty())
            << preset.name << ": its file has no comment \"" << preset.name << ": ...\"";
        const fs::path file = kLibrary / "thumbnails" / (preset.picture() + ".png");
        ASSERT_TRUE(fs::exists(file)) << file << "; cmake --build build --target thumbnails";
        bytes += fs::file_size(file);
        const image::Image image = image::readImage(file);
        EXPECT_EQ(image.width, 96u) << file;
        EXPECT_EQ(image.height, 96u) << file;
    }
    EXPECT_LE(bytes, 300'000u);
    for (const auto& entry : fs::directory_iterator(kLibrary / "thumbnails"))
        EXPECT_TRUE(pictures.contains(entry.path().stem().string())) << entry.path() << " is of no material";
}

// Whoever opens a file of the library sees its materials.
TEST(MaterialPresets, TheirFilesAreScenesWithoutNotices) {
    const std::vector<MaterialPreset> presets = library();
    std::set<const SceneDesc*> scenes;
    for (const MaterialPreset& preset : presets) scenes.insert(preset.scene.get());
    EXPECT_EQ(scenes.size(), 6u);
    for (const SceneDesc* scene : scenes) {
        EXPECT_TRUE(scene->notices.empty()) << scene->title;
        EXPECT_TRUE(compileScene(*scene)->notices.empty()) << scene->title;
        EXPECT_EQ(scene->objects.size(), scene->materials.size()) << scene->title;
    }
}

// By way of the reader of pbrt's files, which has the measured indices.
TEST(MaterialPresets, MetalsHaveTheColorOfTheirMeasuredIndices) {
    const std::vector<MaterialPreset> presets = library();
    const std::map<std::string, std::string> metals = {
        {"Aluminium", "Al"}, {"Brushed aluminium", "Al"}, {"Silver", "Ag"},         {"Gold", "Au"}, {"Matt gold", "Au"},
        {"Copper", "Cu"},    {"Brass", "CuZn"},           {"Hammered copper", "Cu"}};
    const test::TempFolder folder;
    std::size_t tested = 0;
    for (const MaterialPreset& preset : presets) {
        if (preset.group != "Metals") continue;
        ++tested;
        const std::string metal = "metal-" + metals.at(preset.name);
        std::ofstream(folder.path() / "metal.pbrt")
            << "WorldBegin\nMaterial \"conductor\" \"spectrum eta\" \"" << metal << "-eta\" \"spectrum k\" \"" << metal
            << "-k\"\nShape \"sphere\"\n";
        const SceneDesc measured = scene::loadPbrtScene(folder.path() / "metal.pbrt");
        ASSERT_EQ(measured.materials.size(), 1u);
        EXPECT_EQ(materialOf(preset).principled.metallic.factor, 1) << preset.name;
        const glm::dvec3 color = std::get<glm::dvec3>(materialOf(preset).albedo);
        const glm::dvec3 expected = std::get<glm::dvec3>(measured.materials.begin()->second.albedo);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], expected[c], 1e-3) << preset.name;
    }
    EXPECT_EQ(tested, metals.size());
    EXPECT_EQ(materialOf(find(presets, "Crown glass")).parameters[0], scene::pbrtGlass("glass-BK7"));
    EXPECT_EQ(materialOf(find(presets, "Dense flint glass")).parameters[0], scene::pbrtGlass("glass-SF11"));
}

TEST(MaterialPresets, AreFoundByWordsOfNameGroupAndKind) {
    const std::vector<MaterialPreset> presets = library();
    const auto count = [&](const std::string& search) {
        return std::count_if(presets.begin(), presets.end(), [&](const auto& p) { return p.matches(search); });
    };
    EXPECT_EQ(count(""), 30);
    EXPECT_EQ(count("GOLD"), 2);
    EXPECT_EQ(count("gold matt"), 1);
    EXPECT_EQ(count("skin"), 2);
    EXPECT_EQ(count("dielectric"), 5);
    EXPECT_EQ(count("gold skin"), 0);
    EXPECT_EQ(find(presets, "Grey 59 %").picture(), "grey-59");
}

TEST(MaterialPresets, FilesThatCannotBeReadAreToldAndLeftOut) {
    const test::TempFolder folder;
    std::ofstream(folder.path() / "1-bad.json") << R"({"materials": {"m": {"type": "wood"}}, "objects": []})";
    std::ofstream(folder.path() / "2-good.json")
        << R"({"title": "Good", "comment": ["b: second", "a: not measured"], "objects": [], "materials":
            {"a": {"type": "lambertian", "albedo": [0, 0, 0]}, "b": {"type": "lambertian", "albedo": [1, 1, 1]}}})";
    std::vector<std::string> failures;
    const std::vector<MaterialPreset> presets = readMaterialPresets(folder.path(), failures);
    ASSERT_EQ(failures.size(), 1u);
    EXPECT_NE(failures[0].find("1-bad.json: /materials/m/type"), std::string::npos) << failures[0];
    ASSERT_EQ(presets.size(), 2u);
    EXPECT_EQ(presets[0].name, "b"); // in the order of the comment
    EXPECT_EQ(presets[0].source, "second");
    EXPECT_EQ(presets[1].name, "a");
    EXPECT_TRUE(readMaterialPresets(folder.path() / "nothing", failures).empty());
}

// ---- into a scene --------------------------------------------------------------------------------------------------

SceneDesc balls() {
    SceneDesc scene = scene::withMaterials();
    scene::SphereDesc sphere;
    sphere.material = "matte";
    scene.objects = {{sphere}, {sphere}, {scene::PointLightDesc{}}, {scene::group({}, sphere)}};
    return scene;
}

std::string materialAt(const SceneDesc& scene, const ObjectPath& path) {
    return *materialNameOf(*findObject(scene, path));
}

TEST(MaterialTransfer, AMaterialIsAddedOnceAndUndoneInOneStep) {
    const std::vector<MaterialPreset> presets = library();
    const MaterialPreset& gold = find(presets, "Gold");
    scene::SceneDocument document(balls());
    const SceneDesc before = document.scene();
    const std::vector<ObjectPath> objects = {{"", {0}}, {"", {3}}};
    for (int time = 0; time < 2; ++time) {
        scene::MaterialTransfer transfer(document.scene(), *gold.scene);
        const std::string name = transfer.bring("Gold");
        EXPECT_EQ(name, "Gold");
        EXPECT_TRUE(transfer.assign(objects, name));
        std::vector<scene::SceneEdit> edits = transfer.takeEdits();
        EXPECT_EQ(edits.size(), time == 0 ? 3u : 0u); // the second time all is so already
        if (!edits.empty()) document.perform("Assign Gold", edits);
    }
    EXPECT_EQ(document.scene().materials.at("Gold"), materialOf(gold));
    EXPECT_EQ(materialAt(document.scene(), {"", {0}}), "Gold");
    EXPECT_EQ(materialAt(document.scene(), {"", {1}}), "matte");
    EXPECT_EQ(materialAt(document.scene(), {"", {3, 0}}), "Gold") << "what is in a group gets it";
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(document.scene(), before);
}

TEST(MaterialTransfer, NamesThatAreTakenByOthersStayTheirs) {
    SceneDesc scene = balls();
    scene.materials["Gold"] = scene::lambertian(1, 1, 0);
    scene.materials["Gold 2"] = scene::lambertian(1, 0, 0);
    const std::vector<MaterialPreset> presets = library();
    scene::MaterialTransfer transfer(scene, *find(presets, "Gold").scene);
    EXPECT_EQ(transfer.bring("Gold"), "Gold 3");
    EXPECT_EQ(transfer.bring("Gold"), "Gold 3");
    EXPECT_EQ(transfer.takeEdits().size(), 1u);
    const std::vector<ObjectPath> lamp = {{"", {2}}};
    EXPECT_FALSE(transfer.assign(lamp, "Gold")) << "a point has no surface";
}

TEST(MaterialTransfer, TexturesComeAlong) {
    SceneDesc source = scene::withMaterials();
    scene::CheckerTexture checker;
    checker.even = "solid";
    source.textures = {{"solid", scene::SolidTexture{{1, 0, 0}}}, {"squares", checker}};
    source.materials["floor"].albedo = "squares";
    scene::SceneDocument document(balls());
    document.perform("", {scene::SetTexture{"solid", scene::SolidTexture{{0, 1, 0}}}}); // another one of the name
    scene::MaterialTransfer transfer(document.scene(), source);
    const std::string name = transfer.bring("floor");
    document.perform("Bring", transfer.takeEdits());
    const SceneDesc& scene = document.scene();
    EXPECT_EQ(std::get<std::string>(scene.materials.at(name).albedo), "squares");
    EXPECT_EQ(std::get<std::string>(std::get<scene::CheckerTexture>(scene.textures.at("squares")).even), "solid 2");
    EXPECT_EQ(scene.textures.at("solid 2"), source.textures.at("solid"));
    scene::MaterialTransfer again(scene, source);
    EXPECT_EQ(again.bring("floor"), "floor");
    EXPECT_TRUE(again.takeEdits().empty());
}

} // namespace
} // namespace rt::app
