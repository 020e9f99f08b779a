// Materials and textures that are written as glTF are the same when they are read again.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/CompiledScene.h"
#include "tests/unit/GltfBuilder.h"
#include "tests/unit/WrittenGltf.h"

namespace rt::scene {
namespace {

using glm::dvec3;
using nlohmann::json;

class GltfMaterialWriterTest : public WrittenGltf {
  protected:
    // A triangle of this material with all that vertices can have.
    SceneDesc seen(const json& material) {
        GltfBuilder gltf;
        gltf.add("images", {{"bufferView", gltf.addView(kPng)}, {"mimeType", "image/png"}});
        gltf.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}});
        gltf.add("textures", {{"source", 0}, {"sampler", 0}});
        gltf.add("materials", material);
        json primitive = gltf.triangle();
        primitive["material"] = 0;
        json& attributes = primitive["attributes"];
        attributes["NORMAL"] = gltf.addAccessor(std::vector<float>{0, 0, 1, 0, 0.6f, 0.8f, 0, 0, 1}, "VEC3");
        attributes["TEXCOORD_1"] = gltf.addAccessor(std::vector<float>{0.1f, 0.7f, 1e-12f, 1, 0, 3}, "VEC2");
        attributes["COLOR_0"] =
            gltf.addAccessor(std::vector<float>{1, 0.5f, 0, 0.25f, 1, 1, 1, 1, 0.125f, 0, 1, 0.5f}, "VEC4");
        gltf.addNode({{"mesh", gltf.addMesh(primitive)}, {"translation", {1, 2, 3}}});
        return loadGltfScene(gltf.save(folder.path() / "source.glb"));
    }
    static const MaterialDesc& onlyMaterial(const SceneDesc& scene) { return scene.materials.begin()->second; }
};

// But for where an image lies.
std::map<std::string, TextureDesc> placeless(std::map<std::string, TextureDesc> textures) {
    for (auto& [name, texture] : textures) {
        std::get<ImageTexture>(texture).file.clear();
        std::get<ImageTexture>(texture).image.reset();
    }
    return textures;
}

// As a file of floats has it: tangents are computed in double precision.
std::vector<ObjectDesc> roundedTangents(std::vector<ObjectDesc> objects) {
    for (ObjectDesc& object : objects) {
        if (auto* group = std::get_if<GroupDesc>(&object.shape)) group->objects = roundedTangents(group->objects);
        auto* mesh = std::get_if<MeshDesc>(&object.shape);
        if (mesh == nullptr) continue;
        MeshData data = *std::get<Boxed<MeshData>>(mesh->source);
        for (glm::dvec4& tangent : data.tangents) tangent = glm::vec4(tangent);
        mesh->source = Boxed<MeshData>(data);
    }
    return objects;
}

const json kWrittenTexture = {{"index", 0}};

TEST_F(GltfMaterialWriterTest, EveryParameterOfGltfSurvives) {
    const json turned = {{"index", 0},
                         {"texCoord", 1},
                         {"extensions", {{"KHR_texture_transform", {{"offset", {0.25, 0.5}}, {"scale", {2, -3}}}}}}};
    const json materials[] = {
        json::object(),
        {{"name", "a b"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}, {"metallicFactor", 0.3}}}},
        {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", kWrittenTexture}, {"roughnessFactor", 0.7}}},
         {"normalTexture", {{"index", 0}, {"scale", 0.5}}}},
        {{"emissiveFactor", {0.5, 1, 0.25}},
         {"emissiveTexture", kWrittenTexture},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 7.3}}}}}},
        {{"emissiveFactor", {0.1, 0.2, 0.3}}},
        {{"alphaMode", "MASK"},
         {"alphaCutoff", 0.25},
         {"pbrMetallicRoughness", {{"baseColorTexture", kWrittenTexture}, {"baseColorFactor", {1, 0.5, 1, 0.75}}}}},
        {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}},
        {{"alphaMode", "BLEND"}},
        {{"pbrMetallicRoughness", {{"baseColorTexture", turned}}}},
        {{"extensions", {{"KHR_materials_unlit", json::object()}}},
         {"pbrMetallicRoughness", {{"baseColorTexture", kWrittenTexture}, {"baseColorFactor", {1, 0.5, 0.25, 1}}}}},
        {{"extensions", {{"KHR_materials_ior", {{"ior", 1.8}}}}}},
        {{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}},
        {{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.4}}}}}},
        {{"extensions", {{"KHR_materials_transmission", json::object()}}}},
        {{"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", kWrittenTexture}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 0.1}, {"attenuationDistance", 0.7}, {"attenuationColor", {0.1, 0.5, 0.9}}}},
           {"KHR_materials_dispersion", {{"dispersion", 0.3}}}}}},
        {{"extensions",
          {{"KHR_materials_specular",
            {{"specularFactor", 0.5},
             {"specularTexture", kWrittenTexture},
             {"specularColorFactor", {0.2, 0.4, 0.6}},
             {"specularColorTexture", kWrittenTexture}}}}}},
        {{"extensions", {{"KHR_materials_specular", {{"specularColorFactor", {3, 2, 1}}}}}}},
        {{"extensions",
          {{"KHR_materials_clearcoat",
            {{"clearcoatFactor", 0.9},
             {"clearcoatTexture", kWrittenTexture},
             {"clearcoatRoughnessFactor", 0.2},
             {"clearcoatRoughnessTexture", kWrittenTexture},
             {"clearcoatNormalTexture", {{"index", 0}, {"scale", -2}}}}}}}},
        {{"extensions",
          {{"KHR_materials_sheen",
            {{"sheenColorFactor", {0.3, 0.2, 0.1}},
             {"sheenColorTexture", kWrittenTexture},
             {"sheenRoughnessFactor", 0.4},
             {"sheenRoughnessTexture", kWrittenTexture}}}}}},
        {{"extensions",
          {{"KHR_materials_anisotropy",
            {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 1.1}, {"anisotropyTexture", kWrittenTexture}}}}}},
        {{"extensions",
          {{"KHR_materials_iridescence",
            {{"iridescenceFactor", 0.8},
             {"iridescenceTexture", kWrittenTexture},
             {"iridescenceIor", 1.7},
             {"iridescenceThicknessMinimum", 150},
             {"iridescenceThicknessMaximum", 777.7},
             {"iridescenceThicknessTexture", kWrittenTexture}}}}}},
        {{"extensions",
          {{"KHR_materials_diffuse_transmission",
            {{"diffuseTransmissionFactor", 0.6},
             {"diffuseTransmissionTexture", kWrittenTexture},
             {"diffuseTransmissionColorFactor", {0.9, 0.8, 0.7}},
             {"diffuseTransmissionColorTexture", kWrittenTexture}}}}}},
        {{"extensions",
          {{"KHR_materials_pbrSpecularGlossiness",
            {{"diffuseFactor", {0.5, 0.25, 0.125, 1}},
             {"specularFactor", {0.2, 0.3, 0.4}},
             {"glossinessFactor", 0.6},
             {"specularGlossinessTexture", kWrittenTexture}}}}}},
        {{"extensions",
          {{"KHR_materials_pbrSpecularGlossiness", {{"specularFactor", {0.2, 0.3, 0.4}}, {"glossinessFactor", 0.6}}}}}},
    };
    for (const json& material : materials) {
        const SceneDesc scene = seen(material);
        for (const char* name : {"again.glb", "again.gltf"}) {
            const SceneDesc read = again(scene, name);
            EXPECT_TRUE(notices.empty()) << material << ": " << notices.front();
            EXPECT_EQ(onlyMaterial(read), onlyMaterial(scene)) << material;
            EXPECT_EQ(read.materials.begin()->first, scene.materials.begin()->first);
            EXPECT_EQ(roundedTangents(read.objects), roundedTangents(scene.objects)) << material;
            EXPECT_EQ(read.prototypes, scene.prototypes);
            EXPECT_NEAR(read.camera.verticalFov, scene.camera.verticalFov, 1e-12);
            EXPECT_EQ(placeless(read.textures), placeless(scene.textures)) << material;
            if (std::string(name) == "again.glb") continue;
            for (const auto& [unused, texture] : read.textures)
                EXPECT_EQ(writtenText(std::get<ImageTexture>(texture).file), std::string(kPng.begin(), kPng.end()));
        }
    }
}

TEST_F(GltfMaterialWriterTest, ChannelsThatLieElsewhereAreGathered) {
    std::ofstream(folder.path() / "image.png", std::ios::binary) << std::string(kPng.begin(), kPng.end());
    const SceneDesc scene = parse(R"({"textures": {
          "image": {"type": "image", "file": "image.png", "color_space": "linear"},
          "stripes": {"type": "checker", "scale": 1, "even": [1, 0, 0], "odd": [0, 1, 0]}},
        "materials": {"a": {"type": "principled", "base_color": "stripes",
          "roughness": {"texture": "image", "channel": "red", "factor": -1}, "metallic": 0.5}},
        "objects": [{"type": "quad", "corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0],
          "material": "a"}]})");
    const SceneDesc read = again(scene);
    EXPECT_TRUE(isNoticed("texture \"stripes\": glTF has no formulas"));
    const MaterialDesc& material = onlyMaterial(read);
    EXPECT_EQ(std::get<dvec3>(material.albedo), dvec3(0.5, 0.5, 0));
    const PrincipledDesc& p = material.principled;
    EXPECT_EQ(p.metallic.factor, 0.5);
    EXPECT_EQ(p.roughness.factor, 1);
    EXPECT_EQ(p.roughness.channel, Channel::Green);
    const auto compiled = app::compile(read, true);
    ASSERT_EQ(compiled->images.size(), 1u);
    const shared::uint word = compiled->texels.at(compiled->images[0].firstTexel);
    EXPECT_EQ(word >> 8 & 255u, 55u) << "1 - 200 / 255";
    EXPECT_EQ(word >> 16 & 255u, 255u) << "metallic is constant";
}

} // namespace
} // namespace rt::scene
