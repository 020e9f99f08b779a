// Files of glTF that are wrong end in one line that names file and place, and in no more memory than they deserve.
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/TempFolder.h"
#include "tests/unit/GltfBuilder.h"

namespace rt::scene {
namespace {

using nlohmann::json;

// Gives the mesh of node 0 a skin of one joint, a morph target and an animation.
void addPose(GltfBuilder& gltf) {
    json& primitive = gltf.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["JOINTS_0"] = gltf.addAccessor(std::vector<std::uint8_t>(12, 0), "VEC4");
    primitive["attributes"]["WEIGHTS_0"] = gltf.addAccessor(std::vector<float>(12, 0.25f), "VEC4");
    primitive["targets"] = {{{"POSITION", gltf.addAccessor(std::vector<float>(9, 1), "VEC3")}}};
    const int matrices = gltf.addView(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    gltf.add("skins", {{"joints", {1}}, {"inverseBindMatrices", gltf.addAccessor(matrices, 5126, "MAT4", 1)}});
    gltf.json["nodes"][0]["skin"] = 0;
    gltf.json["nodes"][0]["weights"] = {1};
    gltf.add("nodes", json::object()); // of no scene
    const int times = gltf.addAccessor(std::vector<float>{0}, "SCALAR");
    const int values = gltf.addAccessor(std::vector<float>{1, 2, 3}, "VEC3");
    gltf.add("animations", {{"samplers", {{{"input", times}, {"output", values}}}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
    gltf.addAccessor(std::vector<std::uint8_t>(12, 5), "VEC4"); // no numbers of joints
}

// A scene with all kinds of references.
GltfBuilder sample() {
    GltfBuilder gltf;
    json primitive = gltf.triangle();
    primitive["indices"] = gltf.addAccessor(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR");
    primitive["material"] = 0;
    gltf.add("images", {{"bufferView", gltf.addView(std::vector<unsigned char>{0x89, 'P', 'N', 'G'})},
                        {"mimeType", "image/png"}});
    gltf.add("samplers", json::object());
    gltf.add("textures", {{"source", 0}, {"sampler", 0}});
    gltf.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    const int child = gltf.add("nodes", {{"mesh", gltf.addMesh(primitive)}});
    gltf.addNode({{"children", {child}}});
    gltf.addNode({{"camera", 0}, {"translation", {0, 0, 5}}});
    gltf.json["scene"] = 0;
    addPose(gltf);
    return gltf;
}

struct Mistake {
    const char* pointer; // what is replaced
    json value;
    const char* message; // a part of the error
};

TEST(GltfMalformed, EveryMistakeIsNamed) {
    const test::TempFolder folder;
    ASSERT_NO_THROW(loadGltfScene(sample().save(folder / "a.glb")));
    const Mistake mistakes[] = {
        {"/asset/version", "1.0", "/asset/version"},
        {"/asset/minVersion", "2.1", "/asset/minVersion: \"2.1\": must be 2.0"},
        {"/asset/minVersion", 2, "/asset/minVersion"},
        {"/extensionsRequired", {"X_other"}, "/extensionsRequired/0: extension X_other is not supported"},
        {"/extensionsRequired", {"KHR_texture_basisu"}, "KHR_texture_basisu is not supported"},
        {"/scene", 7, "/scene: 7"},
        {"/scenes/0/nodes/0", 17, "/scenes/0/nodes/0: 17"},
        {"/scenes/0/nodes/0", -1, "/scenes/0/nodes/0: -1"},
        {"/scenes/0/nodes/0", 0.5, "/scenes/0/nodes/0: 0.5"},
        {"/nodes/0/mesh", 1, "/nodes/0/mesh: 1: must be an index into meshes, of which there is 1"},
        {"/nodes/0/children", {1}, "must form a tree"},
        {"/nodes/1/children", {0, 0}, "must form a tree"},
        {"/nodes/1/matrix", {1, 2, 3}, "/nodes/1/matrix: must be 16 numbers"},
        {"/nodes/1/scale", {1e200, 1, 1}, "/nodes/1: its transform exceeds"},
        {"/nodes/2/camera", 4, "/nodes/2/camera: 4"},
        {"/cameras/0/perspective/yfov", 4, "/cameras/0/perspective/yfov"},
        {"/meshes/0/primitives/0/attributes/POSITION", 99, "/meshes/0/primitives/0/attributes/POSITION: 99"},
        {"/meshes/0/primitives/0/attributes/POSITION", 1, "/accessors/1: type: must be VEC3"},
        {"/meshes/0/primitives/0/indices", 0, "/accessors/0: type: must be SCALAR"},
        {"/meshes/0/primitives/0/material", 1, "/meshes/0/primitives/0/material: 1"},
        {"/accessors/0/bufferView", 44, "/accessors/0/bufferView: 44"},
        {"/accessors/0/count", 4, "/accessors/0: its 4 elements end beyond"},
        {"/accessors/0/count", -1, "/accessors/0/count: -1"},
        {"/accessors/0/count", 1e300, "/accessors/0/count"},
        {"/accessors/0/byteOffset", 1u << 31, "/accessors/0: its 3 elements"},
        {"/accessors/0/componentType", 5124, "/accessors/0/componentType"},
        {"/accessors/0/type", "VEC9", "/accessors/0/type"},
        {"/accessors/2/componentType", 5126, "/accessors/2: its 3 elements"},
        {"/accessors/0/sparse",
         {{"count", 1}, {"indices", {{"bufferView", 0}, {"componentType", 5120}}}, {"values", {{"bufferView", 0}}}},
         "/accessors/0/sparse/indices/componentType: 5120: must be 5121, 5123 or 5125"},
        {"/accessors/1/count", 2, "TEXCOORD_0: has 2 elements"},
        {"/accessors/3/count", 1, "JOINTS_0: has 1 element: must be those of POSITION, 3"},
        {"/accessors/4/count", 2, "WEIGHTS_0: has 2 elements: must be those of POSITION, 3"},
        {"/bufferViews/0/byteLength", 1000000, "/bufferViews/0: ends at byte"},
        {"/bufferViews/0/byteStride", 4096, "/bufferViews/0/byteStride"},
        {"/bufferViews/0/buffer", 1, "/bufferViews/0/buffer: 1"},
        {"/images/0/bufferView", 55, "/images/0/bufferView: 55"},
        {"/textures/0/source", 3, "/textures/0/source: 3"},
        {"/textures/0/sampler", 3, "/textures/0/sampler: 3"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", 6, "baseColorTexture/index: 6"},
        {"/skins/0/joints", {44}, "/skins/0/joints/0: 44"},
        {"/skins/0/joints", {3}, "/skins/0/joints: node 3 is not in the scene"},
        {"/skins/0/joints", json::array(), "/skins/0/joints: must be at least one node"},
        {"/skins/0/joints", {1, 0}, "/skins/0/inverseBindMatrices: must be one for each joint"},
        {"/skins/0/inverseBindMatrices", 0, "/accessors/0: type: must be MAT4"},
        {"/nodes/0/weights", {1e12}, "/meshes/0/primitives/0: its pose moves vertices beyond 1e9"},
        {"/meshes/0/primitives/0/attributes/JOINTS_0", 0, "/accessors/0: type: must be VEC4"},
        {"/meshes/0/primitives/0/attributes/JOINTS_0", 9, "JOINTS_0: element 0: the skin has 1 joint"},
        {"/meshes/0/primitives/0/targets/0/POSITION", 77, "/targets/0/POSITION: 77"},
        {"/meshes/0/primitives/0/targets/0/POSITION", 2, "/accessors/2: type: must be VEC3"},
        {"/animations/0/samplers/0/output", 99, "/animations/0/samplers/0/output: 99"},
        {"/animations/0/samplers/0/output", 2, "/accessors/2: type: must be VEC3"},
        {"/animations/0/samplers/0/interpolation", "CUBICSPLINE",
         "output: has 1 element: must be 3 for each of 1 keyframe"},
        {"/animations/0/channels/0/sampler", 1, "/animations/0/channels/0/sampler: 1"},
        {"/animations/0/channels/0/target/node", 9, "/animations/0/channels/0/target/node: 9"},
        {"/animations/0/channels/0/target/path", "rotation", "type: must be VEC4"},
        {"/images/0", {{"uri", "https://example.org/a.png"}}, "must be the relative path of a file"},
        {"/images/0", {{"uri", "/etc/a.png"}}, "must be the relative path of a file"},
    };
    for (const Mistake& mistake : mistakes) {
        SCOPED_TRACE(mistake.pointer + std::string(" = ") + mistake.value.dump());
        GltfBuilder gltf = sample();
        gltf.json[json::json_pointer(mistake.pointer)] = mistake.value;
        try {
            loadGltfScene(gltf.save(folder / "a.glb"));
            ADD_FAILURE() << "was read";
        } catch (const InputError& error) {
            const std::string text = error.what();
            EXPECT_NE(text.find("a.glb"), text.npos) << text;
            EXPECT_NE(text.find(mistake.message), text.npos) << text;
            EXPECT_EQ(text.find('\n'), text.npos) << text;
        }
    }
}

TEST(GltfMalformed, IndicesAndNumbersOfTheBufferAreChecked) {
    const test::TempFolder folder;
    GltfBuilder indices = sample();
    indices.json["meshes"][0]["primitives"][0]["indices"] =
        indices.addAccessor(std::vector<std::uint32_t>{0, 1, 0xffffffffu}, "SCALAR");
    EXPECT_THROW(loadGltfScene(indices.save(folder / "a.glb")), InputError);
    for (const float bad : {std::numeric_limits<float>::infinity(), std::nanf(""), 1e30f}) {
        GltfBuilder numbers = sample();
        numbers.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
            numbers.addAccessor(std::vector<float>{0, 0, 0, 1, 0, bad, 0, 1, 0}, "VEC3");
        EXPECT_THROW(loadGltfScene(numbers.save(folder / "a.glb")), InputError) << bad;
    }
}

// Few bytes may ask for much: zeros without a buffer, or many primitives of one array.
TEST(GltfMalformed, SmallFilesDoNotFillTheMemory) {
    const test::TempFolder folder;
    GltfBuilder zeros = sample();
    zeros.json["accessors"][0] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4'000'000'000u}};
    EXPECT_THROW(loadGltfScene(zeros.save(folder / "a.glb")), InputError);
    GltfBuilder many = sample();
    many.json["accessors"][0] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 999'999}};
    const json primitive = {{"attributes", {{"POSITION", 0}}}};
    for (int i = 0; i < 100; ++i) many.json["meshes"][0]["primitives"].push_back(primitive);
    EXPECT_THROW(loadGltfScene(many.save(folder / "a.glb")), InputError);
}

TEST(GltfMalformed, TextThatIsNoJson) {
    const test::TempFolder folder;
    for (const std::string& text :
         {std::string(), std::string("{"), std::string("[]"), std::string("glTF"), std::string(100'000, '['),
          std::string(R"({"asset":{"version":"2.0"},"scene":1e999})")}) {
        GltfBuilder::write(folder / "a.gltf", text);
        EXPECT_THROW(loadGltfScene(folder / "a.gltf"), InputError) << text.substr(0, 40);
    }
}

TEST(GltfMalformed, TruncatedAnywhere) {
    const test::TempFolder folder;
    const std::string whole = sample().binary();
    for (std::size_t length = 0; length < whole.size(); length += 1 + length / 16) {
        GltfBuilder::write(folder / "a.glb", whole.substr(0, length));
        EXPECT_THROW(loadGltfScene(folder / "a.glb"), InputError) << length;
    }
}

// Damaged files are read or refused; sanitizers see more.
TEST(GltfMalformed, DamagedAnywhere) {
    const test::TempFolder folder;
    const std::string whole = sample().binary();
    std::mt19937 random(20);
    int refused = 0;
    for (int i = 0; i < 1000; ++i) {
        std::string damaged = whole;
        for (unsigned n = 1 + random() % 3; n-- > 0;)
            damaged[random() % damaged.size()] =
                random() % 2 == 0 ? static_cast<char>(random()) : "0123456789-\"[]{}"[random() % 16];
        GltfBuilder::write(folder / "a.glb", damaged);
        try {
            loadGltfScene(folder / "a.glb");
            (void)GltfImages(folder / "a.glb").encoded(0);
        } catch (const InputError& error) {
            ++refused;
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
    EXPECT_GT(refused, 300);
    EXPECT_LT(refused, 1000);
}

// Files nobody here wrote, from Debian's package assimp-testmodels: what is good is read, and the same after an export;
// what is bad is refused.
TEST(GltfMalformed, ModelsOfOthers) {
    const std::filesystem::path models = "/usr/share/assimp/models/glTF2";
    if (!std::filesystem::exists(models)) GTEST_SKIP() << "assimp-testmodels is not installed";
    const std::set<std::string> bad = {"BoxWithInfinites.glb", "AllIndicesOutOfRange.gltf", "IndexOutOfRange.gltf",
                                       "RecursiveNodes.gltf",  "sceneWrongType.gltf",       "badArray.gltf"};
    const std::set<std::string> good = {"2CylinderEngine.glb", "ClearCoatTest.gltf", "TextureTransformTest.gltf",
                                        "Cameras.gltf", "simple_skin.gltf"};
    int read = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(models)) {
        const std::filesystem::path extension = entry.path().extension();
        if (extension != ".gltf" && extension != ".glb") continue;
        const std::string name = entry.path().filename().string();
        try {
            const SceneDesc scene = loadGltfScene(entry.path());
            EXPECT_FALSE(scene.objects.empty());
            const SceneDesc again = parseScene(toJson(scene), "a.json", entry.path().parent_path());
            EXPECT_EQ(app::compile(again, true)->hash, app::compile(scene, true)->hash) << name;
            EXPECT_EQ(bad.count(name), 0u) << name << " was read";
            ++read;
        } catch (const InputError& error) {
            EXPECT_EQ(good.count(name), 0u) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
    EXPECT_GE(read, 20);
}

} // namespace
} // namespace rt::scene
