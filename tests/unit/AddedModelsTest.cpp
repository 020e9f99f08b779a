// Models that a scene takes in: what of them has which name, that edits can be undone, and that files and autosaves
// name the model's file in place of what is in it.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/App/Interactive/ModelReading.h"
#include "Common/App/Interactive/SceneFileText.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Scene/AddedModels.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/Edit/EditStep.h"
#include "Common/Scene/Edit/ObjectMotion.h"
#include "Common/Scene/Edit/SceneDocument.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/ModelFile.h"
#include "Common/Scene/ModelPlace.h"
#include "tests/TempFolder.h"
#include "tests/unit/EditedScenes.h"
#include "tests/unit/JsonSchema.h"

namespace rt::scene {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class AddedModelsTest : public testing::Test {
  protected:
    AddedModelsTest() {
        fs::create_directories(folder_ / "models");
        write("models/two.mtl", "newmtl red\nKd 1 0 0\nmap_Kd two.png\nnewmtl glow\nKd 0 0 0\nKe 3 2 1\n");
        write("models/two.obj",
              "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
              "usemtl red\nf 1/1 2/2 3/3\nusemtl glow\nf 1 2 4\nf 1 3 4\n");
        write("base.json", toJson(sceneOfMeshes(2)));
        write("room.json", R"({"textures": {"squares": {"type": "checker", "scale": 1,
            "even": [0, 0, 0], "odd": [1, 1, 1]}}, "background": {"type": "gradient",
            "bottom": [0, 0, 0], "top": [1, 1, 1]}, "materials": {"floor": {"type": "lambertian", "albedo": "squares"}},
            "prototypes": {"ball": [{"type": "sphere", "material": "floor", "center": [0, 1, 0], "radius": 1}]},
            "objects": [{"type": "instance", "prototype": "ball", "transform": [{"scale": 2}]},
                        {"type": "group", "objects": [{"type": "instance", "prototype": "ball", "material": "floor"}]},
                        {"type": "medium", "boundary": {"type": "sphere", "center": [0, 0, 0], "radius": 1},
                         "density": 1, "albedo": "squares"},
                        {"type": "point_light", "position": [0, 9, 0], "intensity": [1, 1, 1]}]})");
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    ModelDesc model(const std::string& name) const { return {(folder_ / name).generic_string(), {}, 0}; }
    SetModel setModel(const std::string& name, const std::string& file) const {
        return {name, model(file), readModel(name, model(file))};
    }
    // In one step, as a window does.
    void add(SceneDocument& document, const std::string& name, const std::string& file) const {
        const auto end = static_cast<std::uint32_t>(document.scene().objects.size());
        const InstanceDesc instance{name, {Translate{{0.1, 1.0 / 3, 0}}}, {}};
        document.perform("Add model", {setModel(name, file), PlaceObject{{"", {end}}, ObjectDesc{instance}}});
    }
    std::string save(const SceneDesc& scene, const std::string& source = "base.json") const {
        std::string text =
            app::sceneFileText(scene, (folder_ / source).string(), {}, (folder_ / "saved.json").string());
        write("saved.json", text);
        return text;
    }
    void expectSaved(const SceneDesc& scene) const {
        const SceneDesc read = loadSceneFile(folder_ / "saved.json");
        EXPECT_TRUE(read.objects == scene.objects);
        EXPECT_TRUE(read.prototypes == scene.prototypes);
        EXPECT_TRUE(read.materials == scene.materials);
        EXPECT_EQ(toJson(read), toJson(scene));
        EXPECT_EQ(app::compile(read, true)->hash, app::compile(scene, true)->hash);
    }
    std::string errorOf(const char* text) const {
        try {
            (void)parseScene(text, "bad.json", folder_.path());
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }

    test::TempFolder folder_;
};

TEST_F(AddedModelsTest, AllOfAModelIsCalledByItsName) {
    const ModelContents room = readModel("room", model("room.json"));
    ASSERT_TRUE(room.textures.contains("room: squares"));
    ASSERT_TRUE(room.materials.contains("room: floor"));
    EXPECT_EQ(std::get<std::string>(room.materials.at("room: floor").albedo), "room: squares");
    ASSERT_EQ(room.prototypes.size(), 2u);
    const std::vector<ObjectDesc>& objects = room.prototypes.at("room");
    ASSERT_EQ(objects.size(), 4u);
    EXPECT_EQ(std::get<InstanceDesc>(objects[0].shape).prototype, "room: ball");
    const auto& inner = std::get<InstanceDesc>(std::get<GroupDesc>(objects[1].shape).objects.at(0).shape);
    EXPECT_EQ(inner.prototype, "room: ball");
    EXPECT_EQ(inner.material, "room: floor");
    EXPECT_EQ(std::get<std::string>(std::get<MediumDesc>(objects[2].shape).albedo), "room: squares");
}

TEST_F(AddedModelsTest, AModelBringsNoStudio) {
    write("models/dull.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_EQ(loadModelFile(folder_ / "models" / "dull.obj", {}).objects.size(), 2u) << "alone it stands in one";
    EXPECT_EQ(readModel("dull", model("models/dull.obj")).prototypes.at("dull").size(), 1u);
}

TEST_F(AddedModelsTest, UndoLeavesTheSceneAsItWas) {
    const SceneDesc before = sceneOfMeshes(2);
    SceneDocument document(before);
    add(document, "two", "models/two.obj");
    add(document, "room", "room.json");
    const SceneDesc after = document.scene();
    EXPECT_EQ(after.objects.size(), before.objects.size() + 2);
    EXPECT_EQ(document.stepCount(), 2u);
    document.undo();
    document.undo();
    EXPECT_TRUE(document.scene() == before);
    EXPECT_EQ(toJson(document.scene()), toJson(before));
    document.redo();
    document.redo();
    EXPECT_TRUE(document.scene() == after);
}

TEST_F(AddedModelsTest, AModelThatIsInUseStays) {
    SceneDocument document(sceneOfMeshes(2));
    const SceneDesc before = document.scene();
    const auto last = static_cast<std::uint32_t>(before.objects.size());
    add(document, "two", "models/two.obj");
    const SetModel removal{"two", std::nullopt, {}};
    EXPECT_THROW(document.perform("Remove", {removal}), InputError);
    document.perform("Use", {SetMaterialOf{{"", {0}}, "two: red"}});
    EXPECT_THROW(document.perform("Remove", {PlaceObject{{"", {last}}, std::nullopt}, removal}), InputError);
    document.undo();
    document.perform("Remove", {PlaceObject{{"", {last}}, std::nullopt}, removal});
    EXPECT_TRUE(document.scene() == before);
    document.undo();
    EXPECT_THROW(document.perform("Twice", {setModel("two", "models/two.obj")}), InputError);
    EXPECT_THROW(document.perform("Name", {setModel("a: b", "models/two.obj")}), InputError);
}

TEST_F(AddedModelsTest, NamesAreThoseOfTheFileAndFree) {
    SceneDesc scene;
    EXPECT_EQ(freeModelName(scene, "/a/two.obj"), "two");
    scene.models["two"] = {};
    scene.materials["two 2: red"] = {};
    EXPECT_EQ(freeModelName(scene, "/a/two.obj"), "two 3");
    EXPECT_TRUE(isModelName(freeModelName(scene, "/a/b: c: d.glb")));
    EXPECT_TRUE(isModelName(freeModelName(scene, "/a/: .glb")));
}

TEST_F(AddedModelsTest, ASavedSceneNamesTheFile) {
    std::ifstream in(fs::path(RT_SOURCE_DIR) / "Assets" / "scene.schema.json");
    const test::JsonSchema schema(Json::parse(in));
    SceneDocument document(sceneOfMeshes(2));
    add(document, "two", "models/two.obj");
    add(document, "room", "room.json");
    std::string text = save(document.scene());
    EXPECT_TRUE(schema.accepts(Json::parse(text))) << text;
    EXPECT_EQ(Json::parse(text)["models"], Json::parse(R"({"room": {"file": "room.json"},
                                                           "two": {"file": "models/two.obj"}})"));
    EXPECT_EQ(text.find("two: red"), text.npos) << "it is the model's: " << text;
    expectSaved(document.scene());
    // What is otherwise is written beside it.
    document.perform("Gold", {SetMaterial{"two: red", metal({1, 0.8, 0.3}, 0.1)}});
    document.perform("Use", {SetMaterialOf{{"", {0}}, "two: glow"}});
    document.perform("Hide", {SetHidden{{"two", {0}}, true}});
    document.perform("Delete", {PlaceObject{{"room", {0}}, std::nullopt}});
    text = save(document.scene());
    EXPECT_TRUE(schema.accepts(Json::parse(text))) << text;
    EXPECT_TRUE(Json::parse(text).contains("models"));
    EXPECT_EQ(text.find("room: floor"), text.npos) << text;
    expectSaved(document.scene());
    // And once more, of what was saved.
    SceneDocument again(loadSceneFile(folder_ / "saved.json"));
    again.perform("Show", {SetHidden{{"two", {0}}, false}});
    EXPECT_TRUE(Json::parse(save(again.scene(), "saved.json")).contains("models"));
    expectSaved(again.scene());
}

TEST_F(AddedModelsTest, AnImportedModelMayTakeInOthers) {
    SceneDocument document(loadModelFile(folder_ / "models" / "two.obj", {}));
    add(document, "two", "models/two.obj");
    const Json json = Json::parse(save(document.scene(), "models/two.obj"));
    EXPECT_EQ(json["import"]["file"], "models/two.obj");
    EXPECT_EQ(json["models"]["two"]["file"], "models/two.obj");
    EXPECT_FALSE(json.contains("materials"));
    expectSaved(document.scene());
}

TEST_F(AddedModelsTest, WhatHasNoFileAnyMoreIsSavedItself) {
    SceneDocument document(sceneOfMeshes(2));
    add(document, "two", "models/two.obj");
    add(document, "room", "room.json");
    fs::remove(folder_ / "models" / "two.obj");
    const Json json = Json::parse(save(document.scene()));
    EXPECT_EQ(json["models"], Json::parse(R"({"room": {"file": "room.json"}})"));
    EXPECT_TRUE(json["materials"].contains("two: red"));
    expectSaved(document.scene());
}

TEST_F(AddedModelsTest, AnEditIsKeptByTheNameOfTheFile) {
    EditStep step{EditStep::Kind::Perform, "Add model", {setModel("two", "models/two.obj")}};
    const std::string line = toText(step);
    EXPECT_LT(line.size(), 400u) << line;
    EXPECT_EQ(line.find('\n'), line.npos);
    SceneDocument first(sceneOfMeshes(2)), second(sceneOfMeshes(2));
    EditStep read = parseStep(line, "kept");
    EXPECT_EQ(std::get<SetModel>(read.edits.at(0)).value, std::get<SetModel>(step.edits.at(0)).value);
    repeat(first, std::move(step));
    repeat(second, std::move(read));
    EXPECT_TRUE(first.scene() == second.scene());
    fs::remove(folder_ / "models" / "two.obj");
    EXPECT_THROW(parseStep(line, "kept"), InputError);
}

// Prototypes of models that a model has taken in are the scene's prototypes, too.
TEST_F(AddedModelsTest, PrototypesOfInnerModelsCanBeChanged) {
    write("street.json", R"({"models": {"two": {"file": "models/two.obj"}},
                             "objects": [{"type": "instance", "prototype": "two"}]})");
    write("town.json", R"({"models": {"street": {"file": "street.json"}},
                           "prototypes": {"own": [{"type": "instance", "prototype": "street"}]},
                           "objects": [{"type": "instance", "prototype": "own"}]})");
    SceneDocument document(loadSceneFile(folder_ / "town.json"));
    ASSERT_TRUE(document.scene().prototypes.contains("street: two"));
    document.perform("Hide", {SetHidden{{"street: two", {0}}, true}});
    document.perform("Turn", {WrapObject{{"own", {0}}, Transform{Rotate{{0, 1, 0}, 30}}}});
    const Json json = Json::parse(save(document.scene(), "town.json"));
    ASSERT_EQ(json.at("changes").size(), 1u) << json;
    EXPECT_EQ(json["changes"][0]["prototype"], "street: two");
    expectSaved(document.scene());
}

// The model itself may lie anywhere, as when it was added; what it names may not.
TEST_F(AddedModelsTest, ARecoveredModelReadsNothingElsewhere) {
    write("street.json", R"({"models": {"two": {"file": "models/two.obj"}},
                             "objects": [{"type": "instance", "prototype": "two"}]})");
    const std::string line =
        toText(EditStep{EditStep::Kind::Perform, "Add model", {setModel("street", "street.json")}});
    EXPECT_NO_THROW((void)parseStep(line, "kept", (folder_ / "models").string()));
    fs::create_directories(folder_ / "elsewhere");
    try {
        (void)parseStep(line, "kept", (folder_ / "elsewhere").string());
        FAIL() << "it was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("--assets-below"), std::string::npos) << error.what();
    }
}

// ---- where it is put, and how a window reads it --------------------------------------------------------------------

TEST_F(AddedModelsTest, BoundsAreThoseOfAllThatIsSeen) {
    const ModelContents two = readModel("two", model("models/two.obj"));
    const Bounds bounds = boundsOfPrototype(two.prototypes, "two");
    EXPECT_EQ(bounds.lower, glm::dvec3(0));
    EXPECT_EQ(bounds.upper, glm::dvec3(1));
    const Bounds room = boundsOfPrototype(readModel("room", model("room.json")).prototypes, "room");
    EXPECT_EQ(room.lower, glm::dvec3(-2, -1, -2)) << "of a ball that is scaled, and a medium";
    EXPECT_EQ(room.upper, glm::dvec3(2, 4, 2));
    EXPECT_TRUE(boundsOfPrototype(two.prototypes, "none").empty());
}

TEST_F(AddedModelsTest, AModelStandsWhereItIsInSight) {
    CameraDesc camera;
    camera.lookFrom = {0, 0, 10};
    camera.lookAt = {1, 2, 0};
    const double distance = glm::length(camera.lookAt - camera.lookFrom);
    const Bounds scene{glm::dvec3(-5), glm::dvec3(5)};
    const auto placed = [&](const Bounds& bounds) {
        Bounds all;
        all.add(bounds, toAffine(placeOfModel(bounds, scene, camera)));
        return all;
    };
    EXPECT_TRUE(placeOfModel({glm::dvec3(1), glm::dvec3(2)}, scene, camera).empty()) << "within the scene";
    EXPECT_TRUE(placeOfModel({}, scene, camera).empty()) << "lights alone";
    const Bounds beside{glm::dvec3(90), glm::dvec3(91)}, speck{glm::dvec3(0), glm::dvec3(1e-6)};
    const Bounds huge{glm::dvec3(-4000), glm::dvec3(5000)}, point{glm::dvec3(70), glm::dvec3(70)};
    for (const Bounds& bounds : {beside, speck, huge, point})
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(placed(bounds).center()[axis], camera.lookAt[axis], 1e-9);
    EXPECT_NEAR(placed(beside).radius(), beside.radius(), 1e-9) << "of its own size";
    EXPECT_NEAR(placed(speck).radius(), 0.05 * distance, 1e-9);
    EXPECT_NEAR(placed(huge).radius(), 0.3 * distance, 1e-9);
    const Transform place = placeOfModel(huge, scene, camera);
    ASSERT_EQ(place.size(), 2u);
    SceneDesc alone;
    alone.objects = {{GroupDesc{place, {}}}};
    EXPECT_NO_THROW(parseScene(toJson(alone), "a", {}));
}

TEST_F(AddedModelsTest, AWindowReadsItAsideAndAddsItInOneStep) {
    SceneDocument document(sceneOfMeshes(2));
    const SceneDesc before = document.scene();
    const auto read = [&](const std::string& file) {
        app::ModelReading reading;
        reading.start(freeModelName(document.scene(), file), file, "");
        std::optional<SetModel> model;
        while (!model) model = reading.take();
        EXPECT_FALSE(reading.isUnderWay());
        return *model;
    };
    const std::string file = (folder_ / "models" / "two.obj").string();
    EXPECT_EQ(app::modelOfFile(document.scene(), file), "");
    document.perform("Add", app::editsToAdd(document.scene(), "two", read(file), {}, {}));
    EXPECT_EQ(document.scene().objects.size(), before.objects.size() + 1);
    ASSERT_EQ(app::modelOfFile(document.scene(), file), "two") << "another one is another instance of it";
    document.perform("Add", app::editsToAdd(document.scene(), "two", std::nullopt, {}, {}));
    EXPECT_EQ(document.scene().models.size(), 1u);
    // The last instance takes the model with it.
    const auto count = static_cast<std::uint32_t>(before.objects.size());
    EXPECT_TRUE(app::editsToDrop(document.scene(), {{"", {count}}}).empty());
    const std::vector<ObjectPath> both = {{"", {count}}, {"", {count + 1}}};
    std::vector<SceneEdit> edits = removed(both);
    for (const SceneEdit& edit : app::editsToDrop(document.scene(), both)) edits.push_back(edit);
    document.perform("Delete", edits);
    EXPECT_TRUE(document.scene() == before);
    for (int i = 0; i < 3; ++i) document.undo();
    EXPECT_TRUE(document.scene() == before);
    // What cannot be read says so in a line.
    write("models/broken.obj", "v 0 0 x\nf 1 2 3\n");
    write("empty.json", R"({"objects": []})");
    for (const char* name : {"models/broken.obj", "empty.json", "models/two.mtl", "none.glb"}) {
        const std::string bad = (folder_ / name).generic_string();
        try {
            (void)read(bad);
            ADD_FAILURE() << bad;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(bad), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
}

TEST_F(AddedModelsTest, WhatCannotBeTakenInIsNamedWithItsPlace) {
    const auto expectSaid = [&](const char* text, const char* place, const char* what) {
        const std::string error = errorOf(text);
        EXPECT_NE(error.find(place), std::string::npos) << error;
        EXPECT_NE(error.find(what), std::string::npos) << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    };
    expectSaid(R"({"models": {"a": {"file": "models/none.glb"}}, "objects": []})", "/models/a/file",
               "an existing file");
    expectSaid(R"({"models": {"a": {"file": "models/two.mtl"}}, "objects": []})", "/models/a/file", "or a scene file");
    expectSaid(R"({"models": {"a: b": {"file": "models/two.obj"}}, "objects": []})", "/models/a: b", "the name of a");
    expectSaid(R"({"models": {"a": {"file": "models/two.obj", "animation": "walk"}}, "objects": []})", "/models/a",
               "no animations");
    expectSaid(R"({"models": {"a": {"file": "x\u0000.obj"}}, "objects": []})", "/models/a/file", "no character 0");
    expectSaid(R"({"import": {"file": "x\u0000.obj"}, "objects": []})", "/import/file", "no character 0");
    expectSaid(R"({"models": {"a": {"file": "models/two.obj"}}, "objects":
                   [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "red"}]})",
               "/objects/0/material", "materials: a: glow, a: red");
    expectSaid(R"({"models": {"a": {"file": "models/two.obj"}}, "removed": {"materials": ["a: red"]}, "objects": []})",
               "\"a: red\"", "is removed, and used");
    write("itself.json", R"({"models": {"a": {"file": "itself.json"}}, "objects": []})");
    expectSaid(R"({"models": {"a": {"file": "itself.json"}}, "objects": []})", "itself.json", "take in itself");
}

} // namespace
} // namespace rt::scene
