// Materials, textures and images of glTF as they become those of a scene, and what is exported of them.
#include <cmath>

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

class GltfMaterials : public testing::Test {
  protected:
    // The scene of a triangle of this material.
    SceneDesc load(const json& material) {
        GltfBuilder gltf = images();
        gltf.add("materials", material);
        json primitive = gltf.triangle();
        primitive["material"] = 0;
        gltf.addNode({{"mesh", gltf.addMesh(primitive)}});
        return loadGltfScene(gltf.save(folder / "a.glb"));
    }
    MaterialDesc material(const json& source) {
        scene = load(source);
        return scene.materials.begin()->second;
    }
    MaterialDesc extended(const char* extension, const json& values) {
        return material({{"extensions", {{extension, values}}}});
    }
    const ImageTexture& image(const std::string& name) const { return std::get<ImageTexture>(scene.textures.at(name)); }
    static GltfBuilder images() {
        GltfBuilder gltf;
        gltf.add("images", {{"bufferView", gltf.addView(kPng)}, {"mimeType", "image/png"}, {"name", "paint"}});
        gltf.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}});
        gltf.add("textures", {{"source", 0}});
        gltf.add("textures", {{"source", 0}, {"sampler", 0}});
        return gltf;
    }

    test::TempFolder folder;
    SceneDesc scene;
};

TEST_F(GltfMaterials, CoreFactorsAndTextures) {
    const MaterialDesc m = material({{"name", "skin"},
                                     {"pbrMetallicRoughness",
                                      {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                                       {"baseColorTexture", {{"index", 0}}},
                                       {"metallicFactor", 0.6},
                                       {"roughnessFactor", 0.7},
                                       {"metallicRoughnessTexture", {{"index", 1}, {"texCoord", 1}}}}},
                                     {"normalTexture", {{"index", 1}, {"scale", 0.5}}},
                                     {"emissiveFactor", {1, 0.5, 0}},
                                     {"emissiveTexture", {{"index", 0}}}});
    EXPECT_EQ(scene.materials.begin()->first, "skin");
    EXPECT_EQ(m.kind, MaterialKind::Principled);
    const ImageTexture& base = image(std::get<std::string>(m.albedo));
    EXPECT_EQ(base.tint, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(base.colorSpace, ColorSpace::Srgb);
    EXPECT_EQ(base.wrapU, Wrap::Repeat);
    EXPECT_EQ(base.image, 0u);
    EXPECT_EQ(m.principled.metallic.factor, 0.6);
    EXPECT_EQ(m.principled.metallic.channel, Channel::Blue);
    EXPECT_EQ(m.principled.roughness.factor, 0.7);
    EXPECT_EQ(m.principled.roughness.channel, Channel::Green);
    const ImageTexture& surface = image(m.principled.roughness.texture);
    EXPECT_EQ(m.principled.metallic.texture, m.principled.roughness.texture);
    EXPECT_EQ(surface.colorSpace, ColorSpace::Linear);
    EXPECT_EQ(surface.wrapU, Wrap::Clamp);
    EXPECT_EQ(surface.wrapV, Wrap::Mirror);
    EXPECT_EQ(surface.uvSet, 1u);
    EXPECT_EQ(image(m.principled.normalTexture).uvSet, 0u);
    EXPECT_EQ(m.principled.normalScale, 0.5);
    EXPECT_EQ(m.emission, glm::dvec3(1, 0.5, 0));
    EXPECT_EQ(image(m.emissionTexture).tint, glm::dvec3(1));
    EXPECT_EQ(m.sides, Sides::Both);
    EXPECT_EQ(m.principled.opacity, NumberOrTexture{}); // the mode is OPAQUE
}

TEST_F(GltfMaterials, DefaultsAreThoseOfTheFormat) {
    const MaterialDesc m = material(json::object());
    EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(1));
    EXPECT_EQ(m.principled.metallic.factor, 1);
    EXPECT_EQ(m.principled.roughness.factor, 1);
    EXPECT_EQ(m.principled.ior, 1.5);
    EXPECT_EQ(m.emission, glm::dvec3(0));
}

TEST_F(GltfMaterials, AlphaModes) {
    const json pbr = {{"baseColorFactor", {1, 1, 1, 0.25}}, {"baseColorTexture", {{"index", 0}}}};
    const PrincipledDesc blend = material({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", pbr}}).principled;
    EXPECT_EQ(blend.opacity.factor, 0.25);
    EXPECT_EQ(blend.opacity.channel, Channel::Alpha);
    EXPECT_FALSE(blend.opacity.texture.empty());
    EXPECT_FALSE(blend.alphaCutoff);
    const PrincipledDesc mask = material({{"alphaMode", "MASK"}, {"pbrMetallicRoughness", pbr}}).principled;
    EXPECT_EQ(mask.alphaCutoff, 0.5);
    EXPECT_EQ(mask.opacity, blend.opacity);
}

TEST_F(GltfMaterials, Extensions) {
    EXPECT_EQ(extended("KHR_materials_ior", {{"ior", 1.33}}).principled.ior, 1.33);
    PrincipledDesc p =
        extended("KHR_materials_transmission", {{"transmissionFactor", 0.9}, {"transmissionTexture", {{"index", 1}}}})
            .principled;
    EXPECT_EQ(p.transmission.factor, 0.9);
    EXPECT_EQ(p.transmission.channel, Channel::Red);
    EXPECT_TRUE(p.isThin);
    p = material({{"extensions",
                   {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                    {"KHR_materials_volume",
                     {{"thicknessFactor", 0.5}, {"attenuationDistance", 2}, {"attenuationColor", {0.1, 0.5, 1}}}}}}})
            .principled;
    EXPECT_FALSE(p.isThin);
    EXPECT_EQ(p.attenuationDistance, 2);
    EXPECT_EQ(p.attenuationColor, glm::dvec3(0.1, 0.5, 1));
    p = extended("KHR_materials_specular",
                 {{"specularFactor", 0.2}, {"specularColorFactor", {1, 0.5, 0}}, {"specularTexture", {{"index", 0}}}})
            .principled;
    EXPECT_EQ(p.specular.factor, 0.2);
    EXPECT_EQ(p.specular.channel, Channel::Alpha);
    EXPECT_EQ(std::get<glm::dvec3>(p.specularColor), glm::dvec3(1, 0.5, 0));
    p = extended("KHR_materials_clearcoat", {{"clearcoatFactor", 0.8}, {"clearcoatRoughnessFactor", 0.3}}).principled;
    EXPECT_EQ(p.clearcoat.factor, 0.8);
    EXPECT_EQ(p.clearcoatRoughness.factor, 0.3);
    p = extended("KHR_materials_clearcoat",
                 {{"clearcoatFactor", 1}, {"clearcoatNormalTexture", {{"index", 1}, {"scale", 0.4}}}})
            .principled;
    EXPECT_EQ(image(p.clearcoatNormalTexture).colorSpace, ColorSpace::Linear);
    EXPECT_EQ(p.clearcoatNormalScale, 0.4);
    EXPECT_TRUE(p.normalTexture.empty());
    p = extended("KHR_materials_sheen", {{"sheenColorFactor", {0.5, 0.4, 0.3}}, {"sheenRoughnessFactor", 0.6}})
            .principled;
    EXPECT_EQ(std::get<glm::dvec3>(p.sheenColor), glm::dvec3(0.5, 0.4, 0.3));
    EXPECT_EQ(p.sheenRoughness.factor, 0.6);
    p = extended("KHR_materials_anisotropy",
                 {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 1.57}, {"anisotropyTexture", {{"index", 0}}}})
            .principled;
    EXPECT_EQ(p.anisotropy.factor, 0.6);
    EXPECT_EQ(p.anisotropy.channel, Channel::Blue);
    EXPECT_EQ(p.anisotropyRotation, 1.57);
    EXPECT_EQ(p.anisotropyTexture, p.anisotropy.texture);
    EXPECT_EQ(image(p.anisotropyTexture).colorSpace, ColorSpace::Linear);
    p = extended("KHR_materials_iridescence", {{"iridescenceFactor", 0.5},
                                               {"iridescenceIor", 1.7},
                                               {"iridescenceThicknessMinimum", 200},
                                               {"iridescenceThicknessMaximum", 900},
                                               {"iridescenceThicknessTexture", {{"index", 1}}}})
            .principled;
    EXPECT_EQ(p.iridescence.factor, 0.5);
    EXPECT_EQ(p.iridescenceIor, 1.7);
    EXPECT_EQ(p.iridescenceThickness.channel, Channel::Green);
    EXPECT_EQ(p.iridescenceThickness.factor, 1);
    EXPECT_EQ(p.iridescenceThicknessMinimum, 200);
    EXPECT_EQ(p.iridescenceThicknessMaximum, 900);
    p = extended("KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.25},
                                                        {"diffuseTransmissionTexture", {{"index", 0}}},
                                                        {"diffuseTransmissionColorFactor", {1, 0.9, 0.85}}})
            .principled;
    EXPECT_EQ(p.diffuseTransmission.factor, 0.25);
    EXPECT_EQ(p.diffuseTransmission.channel, Channel::Alpha);
    EXPECT_EQ(std::get<glm::dvec3>(p.diffuseTransmissionColor), glm::dvec3(1, 0.9, 0.85));
    EXPECT_EQ(extended("KHR_materials_dispersion", {{"dispersion", 0.36}}).principled.dispersion, 0.36);
    const MaterialDesc glow =
        material({{"emissiveFactor", {1, 1, 0}},
                  {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 7}}}}}});
    EXPECT_EQ(glow.emission, glm::dvec3(7, 7, 0));
    EXPECT_EQ(scene.background, Background(ConstantBackground{})); // it is a light
    const MaterialDesc unlit = material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.3, 0.4, 1}}}},
                                         {"extensions", {{"KHR_materials_unlit", json::object()}}}});
    EXPECT_EQ(unlit.emission, glm::dvec3(0.2, 0.3, 0.4));
    EXPECT_EQ(std::get<glm::dvec3>(unlit.albedo), glm::dvec3(0));
    EXPECT_FALSE(std::get<MeshDesc>(scene.objects.at(0).shape).light);
}

// Against the formula of the extension with v running downwards.
TEST_F(GltfMaterials, TextureTransform) {
    const double angle = 0.3;
    const json transform = {{"offset", {0.1, 0.2}}, {"rotation", angle}, {"scale", {2, 3}}, {"texCoord", 1}};
    const MaterialDesc m =
        material({{"pbrMetallicRoughness",
                   {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}});
    const ImageTexture& texture = image(std::get<std::string>(m.albedo));
    EXPECT_EQ(texture.uvSet, 1u);
    const double u = 0.7, v = 0.4;
    const double expectedU = std::cos(angle) * 2 * u + std::sin(angle) * 3 * v + 0.1;
    const double expectedV = -std::sin(angle) * 2 * u + std::cos(angle) * 3 * v + 0.2;
    const auto& r = texture.uvTransform;
    EXPECT_NEAR(r[0] * u + r[1] * (1 - v) + r[2], expectedU, 1e-12);
    EXPECT_NEAR(r[3] * u + r[4] * (1 - v) + r[5], 1 - expectedV, 1e-12);
}

TEST_F(GltfMaterials, OfVariantsTheDefaultCounts) {
    GltfBuilder gltf;
    gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_materials_variants"};
    gltf.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "blue"}}};
    gltf.add("materials", {{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
    gltf.add("materials", {{"name", "blue"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 1, 1}}}}});
    json primitive = gltf.triangle();
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}}};
    gltf.addNode({{"mesh", gltf.addMesh(primitive)}});
    scene = loadGltfScene(gltf.save(folder / "a.glb"));
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(std::get<MeshDesc>(scene.objects[0].shape).material, "red");
}

TEST_F(GltfMaterials, NamesAreUniqueAndPrintable) {
    GltfBuilder gltf;
    for (const char* name : {"a", "a", "", "a (2)", "bell\a"}) {
        gltf.add("materials", {{"name", name}});
        json primitive = gltf.triangle();
        primitive["material"] = gltf.json["materials"].size() - 1;
        gltf.addNode({{"mesh", gltf.addMesh(primitive)}});
    }
    scene = loadGltfScene(gltf.save(folder / "a.glb"));
    EXPECT_EQ(scene.materials.size(), 5u);
    EXPECT_EQ(scene.materials.count("material 2"), 1u);
    EXPECT_EQ(scene.materials.count("bell\\u{7}") + scene.materials.count("bell\\x07"), 1u);
}

TEST_F(GltfMaterials, WhatIsLeftOutGetsANotice) {
    scene = load({{"occlusionTexture", {{"index", 0}}}, {"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}});
    std::string all;
    for (const std::string& notice : scene.notices) all += notice + "\n";
    EXPECT_NE(all.find("occlusion map"), all.npos);
    EXPECT_NE(all.find("index of refraction"), all.npos);
}

TEST_F(GltfMaterials, ImagesInsideTheFileAreDecodedWithTheirOpacity) {
    const json pbr = {{"baseColorTexture", {{"index", 0}}}};
    const auto compiled = app::compile(load({{"alphaMode", "MASK"}, {"pbrMetallicRoughness", pbr}}), true);
    ASSERT_EQ(compiled->images.size(), 1u);
    EXPECT_EQ(compiled->texels, (std::vector<std::uint32_t>{0x803264c8, 0x00ffffff}));
    EXPECT_THROW(GltfImages(folder / "a.glb").encoded(1), InputError);
}

TEST_F(GltfMaterials, ExportedScenesAreTheSameToTheBit) {
    scene = load({{"alphaMode", "BLEND"},
                  {"pbrMetallicRoughness",
                   {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                    {"baseColorTexture", {{"index", 1}}},
                    {"roughnessFactor", 0.123}}},
                  {"extensions",
                   {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.8}, {"clearcoatTexture", {{"index", 0}}}}}}}});
    const SceneDesc again = parseScene(toJson(scene), "a.json", folder.path());
    EXPECT_EQ(again.materials, scene.materials);
    EXPECT_EQ(again.textures, scene.textures);
    EXPECT_EQ(again.objects, scene.objects);
    EXPECT_EQ(again.camera, scene.camera);
    EXPECT_EQ(app::compile(again, true)->hash, app::compile(scene, true)->hash);
}

TEST_F(GltfMaterials, CamerasAreChosenByName) {
    load(json::object());
    scene.cameras["eye"].verticalFov = 12;
    EXPECT_EQ(app::cameraOf("eye", scene).verticalFov, 12);
    EXPECT_EQ(app::cameraOf(R"({"vertical_fov": 30})", scene).verticalFov, 30);
    try {
        app::cameraOf("ear", scene);
        ADD_FAILURE() << "there is no such camera";
    } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("eye"), std::string::npos);
    }
}

} // namespace
} // namespace rt::scene
