// Scene files that begin with a model and change it: what is written of an edited model is small, and read it is the
// same scene.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/App/Interactive/SceneFileText.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/Edit/ObjectMotion.h"
#include "Common/Scene/Edit/SceneDocument.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/ModelFile.h"
#include "tests/TempFolder.h"
#include "tests/unit/GltfBuilder.h"
#include "tests/unit/JsonSchema.h"

namespace rt::scene {
namespace {

namespace fs = std::filesystem;

class ImportedSceneTest : public testing::Test {
  protected:
    ImportedSceneTest() { fs::create_directories(folder_ / "models"); }

    // Three places of one mesh, another one that stands turned, and a lamp; large: a grid of that many triangles.
    fs::path writeModel(const std::string& name = "model.glb", std::uint32_t side = 4) const {
        GltfBuilder gltf;
        std::vector<float> positions;
        std::vector<std::uint32_t> indices;
        for (std::uint32_t y = 0; y <= side; ++y)
            for (std::uint32_t x = 0; x <= side; ++x)
                positions.insert(positions.end(),
                                 {float(x) / float(side), float(y) / float(side), 0.1f * float(x % 3)});
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x) {
                const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
                indices.insert(indices.end(), {a, a + 1, b, a + 1, b + 1, b});
            }
        const int places = gltf.addAccessor(positions, "VEC3"), grid = gltf.addAccessor(indices, "SCALAR");
        for (const char* material : {"oak", "steel"})
            gltf.add("materials", {{"name", material}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
        const auto primitive = [&](int material) {
            return nlohmann::json{{"attributes", {{"POSITION", places}}}, {"indices", grid}, {"material", material}};
        };
        gltf.add("meshes", {{"name", "chair"}, {"primitives", {primitive(0), primitive(1)}}});
        gltf.add("meshes", {{"name", "table"}, {"primitives", {primitive(0), primitive(0)}}});
        for (int i = 0; i < 3; ++i) gltf.addNode({{"mesh", 0}, {"translation", {2 * i, 0, 0}}});
        gltf.addNode({{"mesh", 1}, {"translation", {0, 2, 0}}});
        gltf.json["extensionsUsed"] = {"KHR_lights_punctual"};
        gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 5}}};
        gltf.addNode({{"translation", {0, 0, 5}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        fs::path file = folder_ / "models" / name;
        std::ofstream(file, std::ios::binary) << gltf.binary();
        return file;
    }
    // As it is saved in the folder above, and read again.
    std::string save(const SceneDesc& scene, const fs::path& source, const std::string& name = "saved.json") const {
        const fs::path file = folder_ / name;
        std::string text = app::sceneFileText(scene, source.string(), {}, file.string());
        std::ofstream(file, std::ios::binary) << text;
        return text;
    }
    SceneDesc readSaved(const std::string& name = "saved.json") const { return loadSceneFile(folder_ / name); }
    static std::uint64_t hashOf(const SceneDesc& scene) { return app::compile(scene, true)->hash; }
    void expectSavedAs(const SceneDesc& scene, const std::string& name = "saved.json") const {
        const SceneDesc read = readSaved(name);
        EXPECT_TRUE(read.objects == scene.objects);
        EXPECT_TRUE(read.prototypes == scene.prototypes);
        EXPECT_EQ(hashOf(read), hashOf(scene));
    }
    std::string errorOf(const nlohmann::json& json) const {
        const fs::path file = folder_ / "bad.json";
        std::ofstream(file) << json;
        try {
            loadSceneFile(file);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }

    test::TempFolder folder_;
};

TEST_F(ImportedSceneTest, TheModelAloneIsTheModel) {
    const fs::path file = writeModel();
    const SceneDesc model = loadModelFile(file, {});
    ASSERT_EQ(model.objects.size(), 5u) << "instances, a group and a light";
    const std::string text = save(model, file);
    expectSavedAs(model);
    EXPECT_EQ(nlohmann::json::parse(text),
              nlohmann::json::parse(R"({"version": 1, "import": {"file": "models/model.glb"}, "objects": []})"));
}

TEST_F(ImportedSceneTest, ASmallEditOfALargeModelIsASmallFile) {
    const fs::path file = writeModel("large.glb", 100);
    SceneDocument document(loadModelFile(file, {}));
    document.perform("Move", {moved(document.scene(), {"", {1}}, {Translate{{0.1, 1.0 / 3, 0}}})});
    document.perform("Move a mesh of a prototype", {moved(document.scene(), {"chair", {1}}, {Scale{{2, 2, 2}}})});
    document.perform("Delete in the group", {PlaceObject{{"", {3, 0}}, std::nullopt}});
    const MaterialDesc gold = metal({1, 0.8, 0.3}, 0.1);
    document.perform("Gold", {SetMaterial{"gold", gold}, SetMaterialOf{{"", {0}}, "gold"}});
    document.perform("Steel", {SetMaterial{"steel", gold}});
    document.perform("Hide", {SetHidden{{"", {2}}, true}});
    SphereDesc ball;
    ball.material = "oak";
    document.perform("Add", {PlaceObject{{"", {5}}, ObjectDesc{ball}}});
    document.perform("Add in between", {PlaceObject{{"", {1}}, ObjectDesc{ball}}});
    const std::string text = save(document.scene(), file);
    expectSavedAs(document.scene());
    EXPECT_LT(text.size(), 3000u) << text;
    EXPECT_GT(toJson(document.scene()).size(), 1'000'000u);
    // And once more, of the file that was saved.
    document.perform("Delete", {PlaceObject{{"", {3}}, std::nullopt}});
    const std::string again = save(document.scene(), folder_ / "saved.json", "again.json");
    expectSavedAs(document.scene(), "again.json");
    EXPECT_LT(again.size(), 3000u) << again;
}

// Whatever is done to models of whatever kind.
TEST_F(ImportedSceneTest, RandomEditsAreReadAsTheyWere) {
    std::ofstream(folder_ / "models" / "two.mtl") << "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n";
    std::ofstream(folder_ / "models" / "two.obj") << "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                                     "usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 4\nf 1 3 4\n";
    std::vector<fs::path> models = {writeModel(), folder_ / "models" / "two.obj"};
    for (const char* name : {"instances", "meshes", "round", "media", "sphere-light"})
        models.push_back(fs::path(RT_TEST_DATA_DIR) / "pbrt" / (std::string(name) + ".pbrt"));
    std::ifstream in(fs::path(RT_SOURCE_DIR) / "Assets" / "scene.schema.json");
    const test::JsonSchema schema(nlohmann::json::parse(in));
    std::mt19937 random(7);
    const auto pick = [&](std::size_t count) { return static_cast<std::uint32_t>(random() % count); };
    for (const fs::path& model : models)
        for (int round = 0; round < 6; ++round) {
            SceneDocument document(loadModelFile(model, {}));
            for (int i = 0; i < 3 * round; ++i) {
                const SceneDesc& scene = document.scene();
                if (scene.objects.empty()) break;
                ObjectPath path{"", {pick(scene.objects.size())}};
                if (!scene.prototypes.empty() && pick(3) == 0) {
                    const auto prototype = std::next(scene.prototypes.begin(), pick(scene.prototypes.size()));
                    if (!prototype->second.empty()) path = {prototype->first, {pick(prototype->second.size())}};
                }
                while (const auto* group = std::get_if<GroupDesc>(&findObject(scene, path)->shape)) {
                    if (group->objects.empty() || pick(3) == 0) break;
                    path = path.child(pick(group->objects.size()));
                }
                const ObjectDesc& object = *findObject(scene, path);
                std::vector<ObjectPath> copies;
                switch (pick(6)) {
                    case 0:
                        document.perform("Delete", removed({path}));
                        break;
                    case 1:
                        document.perform("Duplicate", duplicated(scene, {path}, copies));
                        break;
                    case 2:
                        document.perform("Hide", {SetHidden{path, !object.hidden}});
                        break;
                    case 3:
                        if (materialNameOf(object) == nullptr || scene.materials.empty()) break;
                        document.perform(
                            "Material",
                            {SetMaterialOf{path,
                                           std::next(scene.materials.begin(), pick(scene.materials.size()))->first}});
                        break;
                    default:
                        document.perform("Wrap", {WrapObject{path, Transform{Translate{{0.1 * i, 0, 0}}}}});
                }
            }
            const std::string text = save(document.scene(), model);
            const nlohmann::json json = nlohmann::json::parse(text);
            ASSERT_TRUE(json.contains("import")) << model << ' ' << round;
            EXPECT_TRUE(schema.accepts(json)) << text;
            const SceneDesc read = readSaved();
            ASSERT_TRUE(read.objects == document.scene().objects) << model << ' ' << round << '\n' << text;
            ASSERT_TRUE(read.prototypes == document.scene().prototypes) << model << ' ' << round << '\n' << text;
        }
}

TEST_F(ImportedSceneTest, WithoutItsModelASceneIsSavedWhole) {
    const fs::path file = writeModel();
    const SceneDesc model = loadModelFile(file, {});
    fs::remove(file);
    const std::string text = save(model, file);
    EXPECT_FALSE(nlohmann::json::parse(text).contains("import"));
    expectSavedAs(model);
}

// Objects are counted: in a model that has others since, the same number may be that of another one.
TEST_F(ImportedSceneTest, WhatMayBeOfOtherObjectsIsTold) {
    const fs::path file = writeModel();
    SceneDocument document(loadModelFile(file, {}));
    document.perform("Hide", {SetHidden{{"", {1}}, true}});
    document.perform("Hide in the group", {SetHidden{{"", {3, 1}}, true}});
    const std::string text = save(document.scene(), file);
    EXPECT_NE(text.find("\"chair #2 of 3\""), std::string::npos) << text;
    EXPECT_EQ(readSaved().notices, document.scene().notices);
    std::string other = text;
    other.replace(other.find("#2 of 3"), 7, "#2 of 4");
    std::ofstream(folder_ / "other.json") << other;
    const SceneDesc read = readSaved("other.json");
    EXPECT_TRUE(read.objects == document.scene().objects);
    ASSERT_EQ(read.notices.size(), document.scene().notices.size() + 1);
    EXPECT_NE(read.notices.back().find("\"chair\""), std::string::npos) << read.notices.back();
    std::string earlier = text; // programs before wrote no number of them
    earlier.replace(earlier.find("#2 of 3"), 7, "#2");
    std::ofstream(folder_ / "earlier.json") << earlier;
    EXPECT_TRUE(readSaved("earlier.json").objects == document.scene().objects);
    EXPECT_EQ(readSaved("earlier.json").notices, document.scene().notices);
}

TEST_F(ImportedSceneTest, WhatTheModelHasNotIsNamedWithItsPlace) {
    writeModel();
    const nlohmann::json good = {{"import", {{"file", "models/model.glb"}}}, {"objects", nlohmann::json::array()}};
    EXPECT_EQ(errorOf(good), "no error");
    const auto with = [&](const char* text) {
        nlohmann::json bad = good;
        bad.merge_patch(nlohmann::json::parse(text));
        return errorOf(bad);
    };
    const auto expectSaid = [&](const char* text, const char* place, const char* what) {
        const std::string error = with(text);
        EXPECT_NE(error.find("bad.json: "), std::string::npos) << error;
        EXPECT_NE(error.find(place), std::string::npos) << error;
        EXPECT_NE(error.find(what), std::string::npos) << error;
    };
    expectSaid(R"({"changes": [{"object": ["chair #4"], "becomes": []}]})", "/changes/0/object/0",
               "3 there are called \"chair\"");
    expectSaid(R"({"changes": [{"object": ["sofa #1"], "becomes": []}]})", "/changes/0/object/0",
               "0 there are called \"sofa\"");
    expectSaid(R"({"changes": [{"object": ["chair #1", "oak #1"], "becomes": []}]})", "/changes/0/object/1",
               "in a group");
    expectSaid(R"({"changes": [{"object": ["chair #1"], "becomes": []}, {"object": ["chair #1"], "becomes": []}]})",
               "/changes/1", "once before");
    expectSaid(R"({"changes": [{"object": ["group #1"], "becomes": []},
                               {"object": ["group #1", "oak #1"], "becomes": []}]})",
               "/changes/1/becomes", "in a group that another change takes away");
    expectSaid(R"({"changes": [{"prototype": "sofa", "object": ["oak #1"], "becomes": []}]})", "/changes/0/prototype",
               "prototype of the model");
    expectSaid(R"({"changes": [{"object": ["point light #1"], "becomes": [{"type": "imported", "material": "oak"}]}]})",
               "/changes/0/becomes/0/material", "no material");
    expectSaid(R"({"removed": {"materials": ["gold"]}})", "/removed/materials/0", "a name that the model has");
    expectSaid(R"({"removed": {"materials": ["oak"]}})", "\"oak\"", "is removed, and used");
    expectSaid(R"({"objects": [{"type": "imported"}]})", "/objects/0/type", "one of");
    expectSaid(R"({"import": {"file": "bad.json"}})", "/import/file", "glTF, OBJ or pbrt");
    expectSaid(R"({"import": {"file": "models/none.glb"}})", "/import/file", "an existing file");
    expectSaid(R"({"import": {"animation": "walk"}})", "/import", "no animations");
    nlohmann::json alone = {{"objects", nlohmann::json::array()}, {"changes", nlohmann::json::array()}};
    EXPECT_NE(errorOf(alone).find("neither \"import\" nor \"models\""), std::string::npos) << errorOf(alone);
}

} // namespace
} // namespace rt::scene
