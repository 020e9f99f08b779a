// What holds for every row of the table of textures, whoever adds one: it survives a scene file, with all of its
// parameters and with none but those that it needs, and the published schema describes it.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Json/TextureTypes.h"

namespace rt::scene {
namespace {

using Json = nlohmann::json;

const Json kColor = {{"$ref", "#/definitions/color"}};

// ---- a value that no parameter has by default, and the schema of each kind of parameter ---------------------------

Json sample(const TextureParameter& p, const std::string&) {
    return p.choices ? p.choices().back() : "none.jpg";
}
Json sample(const TextureParameter&, const glm::dvec3&) {
    return {0.125, 0.25, 0.5};
}
Json sample(const TextureParameter&, const ColorOrTexture&) {
    return "other";
}
Json sample(const TextureParameter& p, NoiseKind) {
    return p.choices().back();
}
Json sample(const TextureParameter& p, double) {
    EXPECT_GE(2.5, p.least);
    EXPECT_LE(2.5, p.most);
    return 2.5;
}
Json sample(const TextureParameter&, std::uint32_t) {
    return 7u;
}

Json schemaOf(const TextureParameter& p, const std::string&) {
    return p.choices ? Json{{"enum", p.choices()}} : Json{{"type", "string"}};
}
Json schemaOf(const TextureParameter&, const glm::dvec3&) {
    return kColor;
}
Json schemaOf(const TextureParameter&, const ColorOrTexture&) {
    return {{"$ref", "#/definitions/color_or_texture"}};
}
Json schemaOf(const TextureParameter& p, NoiseKind) {
    return {{"enum", p.choices()}};
}
Json schemaOf(const TextureParameter& p, double usual) {
    Json schema = {{"type", "number"}, {"minimum", p.least}, {"maximum", p.most}};
    if (!p.isRequired) schema["default"] = usual;
    return schema;
}
Json schemaOf(const TextureParameter&, std::uint32_t usual) {
    return {{"type", "integer"}, {"minimum", 0}, {"maximum", 4294967295u}, {"default", usual}};
}

// ---- what holds ----------------------------------------------------------------------------------------------------

template <typename Texture>
void expectRoundTrip(bool onlyRequired) {
    Json texture = {{"type", TextureType<Texture>::name}};
    TextureType<Texture>::forEachParameter([&](const TextureParameter& p, auto member) {
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

TEST(TextureTypes, AreTheSchemas) {
    std::ifstream in(std::filesystem::path(RT_SOURCE_DIR) / "Assets" / "scene.schema.json");
    const Json published = Json::parse(in)["definitions"]["texture"]["oneOf"];
    Json expected = Json::array();
    forEachTextureType([&]<typename Texture>(const Texture& usual) {
        Json properties = {{"type", {{"const", TextureType<Texture>::name}}}};
        Json required = {"type"};
        TextureType<Texture>::forEachParameter([&](const TextureParameter& p, auto member) {
            properties[p.name] = schemaOf(p, usual.*member);
            if (*p.help) properties[p.name]["description"] = p.help;
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
