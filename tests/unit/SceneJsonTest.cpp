// Scene files: exact round trips, agreement with the published schema, and an error for every kind of mistake that says
// where
// it is and what is allowed.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/JsonText.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/unit/JsonSchema.h"

namespace rt::scene {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

const test::JsonSchema& schema() {
    static const test::JsonSchema published = [] {
        std::ifstream in(fs::path(RT_SOURCE_DIR) / "Assets" / "scene.schema.json");
        return test::JsonSchema(Json::parse(in));
    }();
    return published;
}

// Of every kind of thing one.
Json everything() {
    return Json::parse(R"({
  "$schema": "scene.schema.json", "version": 1, "title": "Everything", "comment": ["For readers", "of the file."],
  "camera": {"look_from": [0, 1, 5], "look_at": [0, 0, 0], "up": [0, 1, 0], "vertical_fov": 40, "defocus_angle": 0.5,
             "focus_distance": 4},
  "background": {"type": "gradient", "bottom": [1, 1, 1], "top": [0.5, 0.7, 1]},
  "render": {"aspect": 1.5},
  "textures": {
    "plain": {"type": "solid", "color": [0.1, 0.2, 0.3]},
    "check": {"type": "checker", "scale": 0.5, "even": "plain", "odd": [1, 1, 1]},
    "stone": {"type": "noise", "kind": "marble", "scale": 2, "frequency": 4, "tint": [0.9, 0.9, 1], "seed": 7},
    "map": {"type": "image", "file": "no-such-map.jpg", "stand_in": "mars", "tint": [1, 0.9, 0.8]}
  },
  "materials": {
    "matte": {"type": "lambertian", "albedo": "check", "emission": [0.1, 0, 0], "emission_texture": "plain"},
    "shiny": {"type": "metal", "albedo": [0.8, 0.8, 0.9], "fuzz": 0.3},
    "clear": {"type": "dielectric", "ior": 1.5, "albedo": [1, 0.9, 1]},
    "lamp": {"type": "emitter", "emission": [4, 5, 6], "sides": "both"}
  },
  "prototypes": {"pair": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "clear"},
                          {"type": "box", "min": [1, 1, 1], "max": [2, 2, 2], "material": "shiny"}]},
  "objects": [
    {"type": "sphere", "center": [0, 0, 0], "center_end": [0, 1, 0], "radius": 0.5, "material": "matte", "light": false},
    {"type": "spheres", "centers": [0, 0, 1, 0, 0, 2], "radius": 0.25, "material": "shiny"},
    {"type": "quad", "corner": [0, 3, 0], "edge_u": [1, 0, 0], "edge_v": [0, 0, 1], "material": "lamp"},
    {"type": "box", "min": [-3, 0, 0], "max": [-2, 1, 1], "material": "matte"},
    {"type": "mesh", "file": "no-such-model.obj", "stand_in": "statue", "material": "shiny"},
    {"type": "mesh", "positions": [0, 0, 0, 1, 0, 0, 0, 1, 0], "normals": [0, 0, 1, 0, 0, 1, 0, 0, 1],
     "uvs": [0, 0, 1, 0, 0, 1], "triangles": [0, 1, 2], "material": "matte"},
    {"type": "medium", "boundary": {"type": "box", "min": [0, 0, 0], "max": [1, 1, 1]}, "density": 0.5, "albedo": [1, 1, 1]},
    {"type": "medium", "boundary": {"type": "sphere", "center": [0, 0, 0], "radius": 9}, "density": 0.01},
    {"type": "group", "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 15}}, {"translate": [1, 2, 3]}, {"scale": 2},
                                    {"scale": [1, 2, 3]}, {"matrix": [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7]}],
     "objects": [{"type": "instance", "prototype": "pair", "transform": [{"scale": 0.5}], "material": "shiny"}]},
    {"type": "point_light", "position": [1, 2, 3], "intensity": [3, 2, 1]},
    {"type": "spot_light", "position": [1, 2, 3], "direction": [0, -2, 1], "intensity": [1, 1, 1], "inner_angle": 20,
     "outer_angle": 30},
    {"type": "directional_light", "direction": [0, -1, 0.5], "irradiance": [2, 2, 2]}
  ],
  "importance_targets": [{"type": "sphere", "center": [0, 0, 0], "radius": 1},
                         {"type": "quad", "corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]}]
})");
}

SceneDesc parse(const std::string& text) {
    return parseScene(text, "test.json", {});
}

std::string errorOfScene(const std::string& text) {
    try {
        parse(text);
    } catch (const InputError& error) {
        std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_EQ(message.rfind("test.json:", 0), 0u) << message;
        return message;
    }
    return "no error";
}

TEST(SceneJson, EverythingSurvivesARoundTrip) {
    const SceneDesc scene = parse(everything().dump());
    const std::string written = toJson(scene);
    EXPECT_EQ(parse(written), scene);
    EXPECT_EQ(toJson(parse(written)), written);
    EXPECT_TRUE(schema().accepts(everything()));
    EXPECT_TRUE(schema().accepts(Json::parse(written)));
    EXPECT_NO_THROW(compileScene(scene));
}

TEST(SceneJson, LoadsBackToTheSameLights) {
    const SceneDesc scene = parse(everything().dump());
    EXPECT_EQ(compileScene(parse(toJson(scene)))->hash, compileScene(scene)->hash);
}

TEST(SceneJson, BackgroundImagesSurviveARoundTrip) {
    Json document = everything();
    const std::string file = (fs::path(RT_TEST_DATA_DIR) / "images" / "gradient.hdr").generic_string();
    document["background"] = {{"type", "image"}, {"file", file}, {"factor", {2, 3, 4}}, {"rotation", -70.5}};
    EXPECT_TRUE(schema().accepts(document));
    const SceneDesc scene = parse(document.dump());
    EXPECT_EQ(std::get<ImageBackground>(scene.background).rotation, -70.5);
    EXPECT_EQ(parse(toJson(scene)), scene);
    EXPECT_TRUE(schema().accepts(Json::parse(toJson(scene))));
    document["background"]["rotation"] = "east";
    EXPECT_FALSE(schema().accepts(document));
    EXPECT_NE(errorOfScene(document.dump()).find("/background/rotation: \"east\": must be a number"),
              std::string::npos);
}

TEST(SceneJson, TheSchemaKnowsSunAndSky) {
    Json document = everything();
    document["background"] = {{"type", "sun_sky"}, {"sun_elevation", 20},       {"sun_azimuth", -3},
                              {"turbidity", 5},    {"ground", {0.1, 0.2, 0.3}}, {"factor", {2, 2, 2}}};
    EXPECT_TRUE(schema().accepts(document));
    EXPECT_TRUE(schema().accepts(Json::parse(toJson(parse(document.dump())))));
    document["background"]["sun_elevation"] = 91;
    EXPECT_FALSE(schema().accepts(document));
}

TEST(SceneJson, NumbersSurviveToTheLastBit) {
    std::mt19937_64 random(1);
    SceneDesc scene = findBuiltinScene("furnace");
    for (int i = 0; i < 3000; ++i) {
        SphereDesc sphere;
        sphere.material = "wall";
        for (int axis = 0; axis < 3; ++axis) {
            const double x = std::bit_cast<double>(random());
            sphere.center[axis] = std::abs(x) < 1e9 ? x : 0.1;
        }
        sphere.radius = std::max(std::abs(sphere.center.x), 1e-9);
        scene.objects.push_back({sphere});
    }
    SceneDesc loaded = parse(toJson(scene));
    loaded.id = scene.id;
    EXPECT_EQ(loaded, scene);
}

TEST(SceneJson, BuiltinScenesObeyTheSchema) {
    for (const BuiltinScene& scene : builtinScenes())
        EXPECT_TRUE(schema().accepts(Json::parse(toJson(scene.make(std::min(scene.defaultCount, 50u)))))) << scene.id;
}

struct SceneMistake {
    const char* place;        // of the value to set, a JSON pointer
    const char* value;        // JSON
    const char* message;      // what the error must contain
    bool isStructural = true; // the schema finds it too
};

const SceneMistake kMistakes[] = {
    // wrong types
    {"", "[]", "must be an object with $schema, version"},
    {"/title", "3", "/title: 3: must be a string"},
    {"/version", "2", "/version: 2: must be 1"},
    {"/objects", "{}", "/objects: an object: must be an array"},
    {"/objects/0", "7", "/objects/0: 7: must be an object"},
    {"/materials", "[]", "/materials: an array of 0: must be an object"},
    {"/objects/0/radius", "\"big\"", "/objects/0/radius: \"big\": must be a number from 1e-09 to 1e+09"},
    {"/objects/0/light", "1", "/objects/0/light: 1: must be true or false"},
    {"/objects/0/center", "[1, 2]", "/objects/0/center: an array of 2: must be an array of 3 numbers"},
    {"/objects/0/center/1", "null", "/objects/0/center/1: null: must be a number from -1e+09 to 1e+09"},
    {"/textures/stone/seed", "-1", "/textures/stone/seed: -1: must be a whole number from 0 to 4294967295"},
    {"/textures/stone/seed", "1.5", "whole number"},
    {"/textures/stone/seed", "4294967296", "whole number"},
    // unknown and missing keys, unknown choices
    {"/colour", "1", "/: unknown key \"colour\"; allowed: $schema"},
    {"/objects/0/radios", "1", "/objects/0: unknown key \"radios\"; allowed: type, center"},
    {"/materials/shiny/ior", "1.5", "/materials/shiny: unknown key \"ior\"; allowed: type, albedo, fuzz"},
    {"/objects/0/type", "\"cone\"", "/objects/0/type: \"cone\": must be one of sphere, spheres, quad"},
    {"/objects/0", R"({"type": "sphere", "center": [0, 0, 0], "material": "matte"})",
     "/objects/0: \"radius\" is missing"},
    {"/objects/0", R"({"radius": 1})", "/objects/0: \"type\" is missing"},
    {"/materials/lamp", R"({"type": "emitter"})", "\"emission\" is missing"},
    {"/materials/lamp/sides", "\"back\"", "/materials/lamp/sides: \"back\": must be one of front, both"},
    {"/textures/map/stand_in", "\"pluto\"", "/textures/map/stand_in: \"pluto\": must be one of earth"},
    {"/textures/stone/kind", "\"wood\"", "must be one of marble, turbulence, smooth"},
    // numbers out of range
    {"/objects/0/radius", "-1", "/objects/0/radius: -1: must be a number from 1e-09 to 1e+09"},
    {"/objects/0/radius", "0", "from 1e-09 to 1e+09"},
    {"/materials/matte/albedo", "[0.5, 1.5, 0]", "/materials/matte/albedo/1: 1.5: must be a number from 0 to 1"},
    {"/materials/lamp/emission", "[1, -1, 0]", "/materials/lamp/emission/1: -1: must be a number from 0 to 1e+09"},
    {"/materials/shiny/fuzz", "1.01", "/materials/shiny/fuzz: 1.01: must be a number from 0 to 1"},
    {"/materials/clear/ior", "0", "/materials/clear/ior: 0: must be a number from 1e-09 to 1e+09"},
    {"/objects/6/density", "0", "/objects/6/density: 0: must be a number from 1e-09 to 1e+09"},
    {"/objects/0/center", "[0, 1e10, 0]", "/objects/0/center/1: 10000000000.0: must be a number from -1e+09 to 1e+09"},
    {"/camera/vertical_fov", "180", "/camera/vertical_fov: 180: must be a number between 0 and 180"},
    {"/camera/defocus_angle", "-1", "from 0 to below 180"},
    {"/camera/focus_distance", "0", "from 1e-09 to 1e+09"},
    {"/render/aspect", "-1", "from 1e-09 to 1e+09"},
    {"/background/top", "[-1, 0, 0]", "from 0 to 1e+09"},
    {"/objects/9/intensity", "[1, -1, 0]", "/objects/9/intensity/1: -1: must be a number from 0 to 1e+09"},
    {"/objects/9/radius", "1", "/objects/9: unknown key \"radius\"; allowed: type, position, intensity"},
    {"/objects/10/outer_angle", "0", "/objects/10/outer_angle: 0: must be a number from 0.001 to 90"},
    {"/objects/10/outer_angle", "91", "/objects/10/outer_angle: 91: must be a number from 0.001 to 90"},
    {"/objects/10/inner_angle", "-1", "/objects/10/inner_angle: -1: must be a number from 0 to below outer_angle"},
    {"/objects/10/inner_angle", "30", "a number from 0 to below outer_angle", false},
    {"/objects/10/direction", "[0, 0, 0]", "/objects/10/direction: an array of 3: must be a vector that is not 0",
     false},
    {"/objects/11/direction", "[0, 0, 0]", "a vector that is not 0", false},
    {"/objects/11", R"({"type": "directional_light", "direction": [0, -1, 0]})", "\"irradiance\" is missing"},
    // shapes without extent, cameras without direction
    {"/objects/2/edge_v", "[2, 0, 0]", "/objects/2: edge_u and edge_v must span an area", false},
    {"/objects/2/edge_v", "[0, 0, 0]", "must span an area", false},
    {"/objects/3/max", "[-3, 1, 1]", "/objects/3: each component of min must be below that of max", false},
    {"/objects/8/transform/2/scale", "0", "/objects/8/transform/2/scale: 0: must be numbers that are not 0", false},
    {"/objects/8/transform/0/rotate/axis", "[0, 0, 0]", "a vector that is not 0", false},
    {"/objects/8/transform/4/matrix", "[1,0,0,0, 1,0,0,0, 0,0,1,0]", "an invertible map", false},
    {"/objects/8/transform/4/matrix", "[1, 0, 0]", "multiple of 12"},
    {"/objects/8/transform/0", "{}", "/objects/8/transform/0: a step must be one of"},
    {"/camera/look_at", "[0, 1, 5]", "/camera: look_from and look_at must differ", false},
    {"/camera/up", "[0, -2, -10]", "parallel", false},
    // names, indices and files
    {"/objects/0/material", "\"wood\"",
     "/objects/0/material: \"wood\": must be a name from materials: clear, lamp, matte", false},
    {"/materials/matte/albedo", "\"none\"", "/materials/matte/albedo: \"none\": must be a name from textures: check",
     false},
    {"/textures/check/odd", "\"none\"", "/textures/check/odd: \"none\": must be a name from textures", false},
    {"/objects/8/objects/0/prototype", "\"none\"", "must be a name from prototypes: pair", false},
    {"/objects/5/triangles/1", "3", "/objects/5/triangles/1: 3: must be the index of a position, 0 to 2", false},
    {"/objects/5/triangles/1", "-1", "the index of a position, 0 to 2"},
    {"/objects/5/triangles", "[]", "multiple of 3 and not 0"},
    {"/objects/5/triangles", "[0, 1, 2, 0]", "multiple of 3 and not 0", false},
    {"/objects/5/positions", "[]",
     "/objects/5/positions: an array of 0: must be an array whose length is a multiple of 3"},
    {"/objects/5/normals", "[0, 0, 1]", "/objects/5/normals: an array of 3: must be one for each of the 3 positions",
     false},
    {"/objects/5/uvs", "[0, 0]", "one for each of the 3 positions", false},
    {"/objects/1/centers", "[1, 2]", "multiple of 3 and not 0"},
    {"/objects/4", R"({"type": "mesh", "file": "gone.obj", "material": "shiny"})",
     "/objects/4/file: \"gone.obj\": must be an existing file", false},
    {"/textures/map", R"({"type": "image", "file": "gone.png"})",
     "/textures/map/file: \"gone.png\": must be an existing file", false},
    {"/background", R"({"type": "image", "file": ""})", "/background/file: \"\": must be an existing file", false},
};

TEST(SceneJson, EveryMistakeIsNamed) {
    for (const SceneMistake& mistake : kMistakes) {
        Json document = everything();
        document[Json::json_pointer(mistake.place)] = Json::parse(mistake.value);
        EXPECT_NE(errorOfScene(document.dump()).find(mistake.message), std::string::npos)
            << mistake.place << " = " << mistake.value << " gave: " << errorOfScene(document.dump());
        EXPECT_EQ(schema().accepts(document), !mistake.isStructural) << mistake.place << " = " << mistake.value;
    }
}

TEST(SceneJson, TheElementsOfALongArrayAreParsedOneByOne) {
    const std::string file = "test.json";
    const auto count = [&file](const std::string& text) { return LongJson(text, file, "objects").elementCount(); };
    const std::string text = R"( {"a": "\"objects\": [{", "b": {"objects": [{}, {}]}, "c": 1.5, "objects" :
                                [ {"x": "]}"} ,{"y": [{}, {}]}], "d": [{"e": 2}]})";
    const LongJson json(text, file, "objects");
    ASSERT_EQ(json.elementCount(), 2u);
    EXPECT_EQ(*json.element(0), Json::parse(R"({"x": "]}"})"));
    EXPECT_EQ(*json.element(1), Json::parse(R"({"y": [{}, {}]})"));
    Json whole = Json::parse(text);
    EXPECT_EQ(parseJson(text, file), whole);
    whole["objects"] = Json::array();
    EXPECT_EQ(*json.document(), whole);
    // What is not a list of objects is left to the parser.
    for (const char* other :
         {"", "{", "[]", "[{\"objects\": [{}]}]", "{\"objects\"", "{\"objects\": {}}", "{\"objects\": []}",
          "{\"objects\": [{}, 1]}", "{\"objects\": [{}", "{\"objects\": [{}}", "{\"objects\": [{},]}",
          "{\"objects\": [{\"]}", "{\"a\": {", "{\"a", "{\"a\\", "{\"a\": \"\\"})
        EXPECT_EQ(count(other), 0u) << other;
}

TEST(SceneJson, NoKindOfObjectMakesTheOthersLarge) {
    EXPECT_LE(sizeof(ObjectDesc), 1.25 * sizeof(SphereDesc)); // what a million spheres take
    const MeshDesc mesh{MeshData{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {}, {}, {}, {{0, 1, 2}}}, "matte", true};
    MeshDesc copy = mesh;
    EXPECT_EQ(copy, mesh);
    EXPECT_EQ(std::get<Boxed<MeshData>>(copy.source)->positions[1], glm::dvec3(1, 0, 0));
    copy.source = MeshData{{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {}, {}, {}, {}, {}, {{0, 1, 2}}};
    EXPECT_NE(copy, mesh);
    EXPECT_EQ(std::get<Boxed<MeshData>>(mesh.source)->positions[1], glm::dvec3(1, 0, 0));
}

TEST(SceneJson, SyntaxErrorsHaveLineAndColumn) {
    EXPECT_EQ(errorOfScene("{\n  \"objects\": [,]\n}").rfind("test.json:2:15: ", 0), 0u)
        << errorOfScene("{\n  \"objects\": [,]\n}");
    EXPECT_EQ(errorOfScene("").rfind("test.json:1:1: ", 0), 0u) << errorOfScene("");
    EXPECT_EQ(errorOfScene("{\"objects\": [NaN]}").rfind("test.json:1:14: ", 0), 0u)
        << errorOfScene("{\"objects\": [NaN]}");
    EXPECT_EQ(errorOfScene("{\n\"objects\": [1e999]}"), "test.json:2:18: number overflow parsing '1e999'");
    EXPECT_EQ(errorOfScene("{\"objects\": [],\n\"objects\": []}"),
              "test.json:2:9: key \"objects\" appears twice in one object");
    // Objects are parsed one by one.
    EXPECT_EQ(errorOfScene("{\"objects\": [\n{\"a\": [1], \"a\": 2}]}"),
              "test.json:2:14: key \"a\" appears twice in one object");
    EXPECT_EQ(errorOfScene("{\"objects\": [\n{\"type\": tru}]}").rfind("test.json:2:13: ", 0), 0u);
    EXPECT_EQ(errorOfScene("{\"objects\": [{}, {\"type\": \"}]}").rfind("test.json:1:31: ", 0), 0u)
        << errorOfScene("{\"objects\": [{}, {\"type\": \"}]}");
    // What follows them stands where it is in the file.
    EXPECT_EQ(errorOfScene("{\"objects\": [{\"type\": 1},\n{\"type\": 2}], \"a\": tru}").rfind("test.json:2:23: ", 0),
              0u)
        << errorOfScene("{\"objects\": [{\"type\": 1},\n{\"type\": 2}], \"a\": tru}");
    EXPECT_EQ(errorOfScene("{\"objects\": [{\"type\": 1},\n{}],\n\"objects\": []}"),
              "test.json:3:9: key \"objects\" appears twice in one object");
    EXPECT_EQ(errorOfScene("{\"objects\": [{\"type\": " + std::string(300, '[') + "]}]}").find("test.json:1:"), 0u);
    EXPECT_EQ(errorOfScene(std::string(300, '[')), "test.json:1:258: values are nested deeper than 256");
    EXPECT_NE(errorOfScene(std::string("\0\0\0\0", 4)), "no error");
    EXPECT_NE(errorOfScene("{\"objects\": [], \"title\": \"\xff\xfe\"}"), "no error");
}

TEST(SceneJson, EveryTruncationIsAnError) {
    const std::string text = everything().dump();
    for (std::size_t length = 0; length < text.size(); length += 3)
        EXPECT_NE(errorOfScene(text.substr(0, length)), "no error") << length;
}

// Bytes changed at random: an error or a scene, never a crash.
TEST(SceneJson, DamagedFilesDoNoHarm) {
    const std::string text = everything().dump();
    std::mt19937 random(2);
    for (int i = 0; i < 3000; ++i) {
        std::string damaged = text;
        for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
        errorOfScene(damaged);
    }
}

TEST(SceneJson, DeepNestingIsAnErrorNotACrash) {
    for (const char* open : {"[", "{\"a\":"}) {
        std::string text = "{\"objects\": ";
        for (int i = 0; i < 1000000; ++i) text += open;
        EXPECT_NE(errorOfScene(text).find("nested deeper than 256"), std::string::npos);
    }
}

TEST(SceneJson, GroupsMayNestButPrototypesMustNotContainThemselves) {
    const auto compiled = [](const std::string& prototypes) {
        try {
            compileScene(
                parse("{\"materials\": {\"m\": {\"type\": \"lambertian\", \"albedo\": [1, 1, 1]}}, \"prototypes\": " +
                      prototypes + ", \"objects\": [{\"type\": \"instance\", \"prototype\": \"a\"}]}"));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    const auto instance = [](const std::string& name) {
        return "[{\"type\": \"group\", \"objects\": [{\"type\": \"instance\", \"prototype\": \"" + name + "\"}]}]";
    };
    EXPECT_EQ(compiled("{\"a\": " + instance("b") + ", \"b\": []}"), "no error");
    EXPECT_NE(
        compiled("{\"a\": " + instance("a") + "}").find("/prototypes/a/0/objects/0: prototype \"a\" contains itself"),
        std::string::npos);
    EXPECT_NE(compiled("{\"a\": " + instance("b") + ", \"b\": " + instance("a") + "}").find("contains itself"),
              std::string::npos);
}

// Ten levels of ten: a small file must not ask for more memory than there is.
TEST(SceneJson, ExplodingInstancesAreAnError) {
    Json document = {{"materials", {{"m", {{"type", "lambertian"}, {"albedo", {1, 1, 1}}}}}},
                     {"objects", {{{"type", "instance"}, {"prototype", "p0"}}}}};
    const auto prototype = [](int level) { return std::string("p").append(std::to_string(level)); };
    for (int level = 0; level < 10; ++level)
        for (int i = 0; i < 10; ++i)
            document["prototypes"][prototype(level)].push_back(
                {{"type", "instance"}, {"prototype", prototype(level + 1)}});
    document["prototypes"]["p10"] =
        Json::parse(R"([{"type": "sphere", "center": [0,0,0], "radius": 1, "material": "m"}])");
    const SceneDesc scene = parse(document.dump());
    EXPECT_THROW(compileScene(scene), InputError);
}

TEST(SceneJson, FilesAreFoundBesideTheScene) {
    const fs::path folder = fs::temp_directory_path() / "rt-scene-json-test";
    fs::create_directories(folder);
    std::ofstream(folder / "model.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(folder / "scene.json") << R"({"objects": [{"type": "mesh", "file": "model.obj"}]})";
    const SceneDesc scene = loadSceneFile(folder / "scene.json");
    EXPECT_EQ(scene.id, "scene.json");
    EXPECT_EQ(compileScene(scene)->triangles.size(), 1u);
    EXPECT_EQ(parse(toJson(scene)).objects, scene.objects);
    fs::remove_all(folder);
    EXPECT_THROW(loadSceneFile(folder / "scene.json"), InputError);
    EXPECT_THROW(loadSceneFile(fs::temp_directory_path()), InputError);
    EXPECT_THROW(compileScene(scene), InputError);
}

} // namespace
} // namespace rt::scene
