// What holds for every row of the table of textures, whoever adds one: it survives a scene file, with all of its
// parameters and with none but those that it needs, and the published schema describes it.
#include <filesystem>
#include <fstream>
#include <type_traits>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Json/TextureTypes.h"
#include "Common/Shared/Base/Features.h"
#include "tests/unit/SceneParameters.h"

namespace rt::scene {
namespace {

using Json = nlohmann::json;
using test::described;
using test::sample;
using test::schemaOf;

// ---- what holds ----------------------------------------------------------------------------------------------------

template <typename Texture>
void expectRoundTrip(bool onlyRequired) {
    Json texture = {{"type", TextureType<Texture>::name}};
    TextureType<Texture>::forEachParameter([&](const SceneParameter& p, auto member) {
        const bool replacesFile = std::string(p.name) == "stand_in"; // there is no such file
        if (p.isRequired || replacesFile || !onlyRequired) texture[p.name] = sample(p, Texture().*member);
    });
    const Json file = {{"version", 1},
                       {"textures", {{"it", texture}, {"other", {{"type", "solid"}, {"color", {1, 0, 0}}}}}},
                       {"objects", Json::array()}};
    const SceneDesc scene = parseScene(file.dump(), "test.json", {});
    EXPECT_TRUE(std::holds_alternative<Texture>(scene.textures.at("it")));
    EXPECT_EQ(parseScene(toJson(scene), "test.json", {}), scene);
    EXPECT_EQ(Json::parse(toJson(scene))["textures"]["it"], texture);
}

TEST(TextureTypes, SurviveASceneFile) {
    forEachTextureType([]<typename Texture>(const Texture&) {
        SCOPED_TRACE(TextureType<Texture>::name);
        for (const bool onlyRequired : {false, true}) expectRoundTrip<Texture>(onlyRequired);
    });
}

// Kernels look no texture up where the scene has none of these features.
TEST(TextureTypes, HaveAFeature) {
    const Json file = {{"version", 1},
                       {"textures", {{"it", {{"type", "solid"}, {"color", {1, 0, 0}}}}}},
                       {"materials", {{"m", {{"type", "lambertian"}, {"albedo", "it"}}}}},
                       {"objects", {{{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 1}, {"material", "m"}}}}};
    SceneDesc scene = parseScene(file.dump(), "test.json", {});
    forEachTextureType([&]<typename Texture>(const Texture& usual) {
        // The first becomes a constant, the second reads a file.
        if (std::is_same_v<Texture, SolidTexture> || std::is_same_v<Texture, ImageTexture>) return;
        scene.textures["it"] = usual;
        EXPECT_TRUE(shared::has(compileScene(scene)->features, shared::kTexturedFeatures))
            << TextureType<Texture>::name;
    });
}

TEST(TextureTypes, AreTheSchemas) {
    std::ifstream in(std::filesystem::path(RT_SOURCE_DIR) / "Assets" / "scene.schema.json");
    const Json published = Json::parse(in)["definitions"]["texture"]["oneOf"];
    Json expected = Json::array();
    forEachTextureType([&]<typename Texture>(const Texture& usual) {
        Json properties = {{"type", {{"const", TextureType<Texture>::name}}}};
        Json required = {"type"};
        TextureType<Texture>::forEachParameter([&](const SceneParameter& p, auto member) {
            properties[p.name] = described(p, schemaOf(p, usual.*member));
            if (p.isRequired) required.push_back(p.name);
        });
        expected.push_back({{"description", TextureType<Texture>::help},
                            {"type", "object"},
                            {"properties", properties},
                            {"required", required},
                            {"additionalProperties", false}});
    });
    EXPECT_EQ(published, expected) << "definitions/texture/oneOf has to be\n" << expected.dump(2);
}

} // namespace
} // namespace rt::scene
