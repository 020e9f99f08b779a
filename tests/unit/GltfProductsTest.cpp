// What multiplies what in materials of glTF 2.0 and its extensions, and which of its values have no upper limit: as the
// renderer's own formulas see a surface.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Shared/Path/Emission.h"
#include "Common/Shared/Path/Vertex.h"
#include "Common/Shared/Texture/Color.h"
#include "tests/TempFolder.h"
#include "tests/unit/GltfBuilder.h"

namespace rt::scene {
namespace {

using glm::dvec3;
using nlohmann::json;

// What the one texel in use is, linear and decoded of sRGB, and the colour of all vertices.
const dvec3 kLinear(200 / 255.0, 100 / 255.0, 50 / 255.0);
const double kAlpha = 128 / 255.0;
const dvec3 kVertex(0.5, 0.25, 0.75);
const double kVertexAlpha = 0.625;

dvec3 decoded(const dvec3& srgb) {
    dvec3 linear;
    for (int c = 0; c < 3; ++c) linear[c] = std::pow((srgb[c] + 0.055) / 1.055, 2.4);
    return linear;
}
const dvec3 kSrgb = decoded(kLinear);

// A point of a triangle of this material.
struct SeenSurface {
    dvec3 albedo, emission;
    double opacity;
    shared::PrincipledValues values;
    shared::Principled record;
    bool isInLightTable;
    double f0(int channel) const { // of the dielectric
        const double root = (double(values.ior) - 1) / (double(values.ior) + 1);
        return std::min(double(values.specularColor[channel]) * root * root, 1.0) * double(values.specular);
    }
};

class GltfProducts : public testing::Test {
  protected:
    SeenSurface see(const json& material, bool isExported = false) {
        GltfBuilder gltf;
        gltf.add("images", {{"bufferView", gltf.addView(kPng)}, {"mimeType", "image/png"}});
        gltf.add("textures", {{"source", 0}});
        gltf.add("materials", material);
        json primitive = gltf.triangle();
        primitive["material"] = 0;
        primitive["attributes"]["TEXCOORD_0"] =
            gltf.addAccessor(std::vector<float>{0.25f, 0.5f, 0.25f, 0.5f, 0.25f, 0.5f}, "VEC2");
        std::vector<float> colors;
        for (int vertex = 0; vertex < 3; ++vertex) {
            for (int c = 0; c < 3; ++c) colors.push_back(static_cast<float>(kVertex[c]));
            colors.push_back(static_cast<float>(kVertexAlpha));
        }
        primitive["attributes"]["NORMAL"] = gltf.addAccessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        primitive["attributes"]["TANGENT"] =
            gltf.addAccessor(std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
        primitive["attributes"]["COLOR_0"] = gltf.addAccessor(colors, "VEC4");
        gltf.addNode({{"mesh", gltf.addMesh(primitive)}});
        desc = loadGltfScene(gltf.save(folder / "a.glb"));
        if (isExported) desc = parseScene(toJson(desc), "a.json", folder.path());
        return look();
    }
    // Of an opaque material with this extension.
    SeenSurface extended(const char* name, const json& values) {
        return see({{"alphaMode", "OPAQUE"}, {"extensions", {{name, values}}}});
    }

    test::TempFolder folder;
    SceneDesc desc;

  private:
    static shared::PrincipledValues valuesAt(const shared::SceneView& view, const shared::Principled& p,
                                             const shared::Surface& s) {
        shared::PrincipledValues values = shared::principledValues(shared::kFeatureAll, view, p, s);
        shared::addRareValues(shared::kFeatureAll, view, p, s, s.shading, 1, values);
        return values;
    }
    SeenSurface look() const {
        const auto compiled = app::compile(desc, true);
        std::vector<float> linear(256);
        for (shared::uint byte = 0; byte < 256; ++byte) linear[byte] = shared::srgbToLinear(float(byte) / 255.0f);
        shared::SceneView view = shared::viewOf(*compiled, compiled->globals);
        view.srgbToLinear = linear.data();
        shared::Hit hit{};
        hit.kind = shared::kTriangle;
        hit.instance = shared::kNone;
        hit.t = 1;
        hit.u = hit.v = 0.25f;
        const shared::Features all = shared::kFeatureAll;
        shared::Ray ray{};
        ray.origin = shared::vec3(0.25f, 0.25f, 1);
        ray.direction = shared::vec3(0, 0, -1);
        const shared::Surface s = shared::makeSurface(all, view, ray, hit);
        const shared::Material& material = compiled->materials.at(s.material);
        const shared::Principled& p = compiled->principled.at(s.material);
        return {dvec3(shared::surfaceAlbedo(all, view, material, s)),
                dvec3(shared::surfaceEmission(all, view, material, s)),
                double(shared::surfaceOpacity(all, view, p, s)),
                valuesAt(view, p, s),
                p,
                s.light != shared::kNone};
    }
};

const json kTexture = {{"index", 0}};

constexpr double kRounding = 1e-5; // of the formulas, in single precision

void expectColor(const dvec3& seen, const dvec3& expected) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], expected[c], kRounding * std::max(1.0, expected[c])) << c;
}

TEST_F(GltfProducts, OfMetallicRoughness) {
    const SeenSurface s = see({{"alphaMode", "BLEND"},
                               {"pbrMetallicRoughness",
                                {{"baseColorFactor", {0.9, 0.8, 0.7, 0.6}},
                                 {"baseColorTexture", kTexture},
                                 {"metallicFactor", 0.6},
                                 {"roughnessFactor", 0.9},
                                 {"metallicRoughnessTexture", kTexture}}},
                               {"emissiveFactor", {1, 0.5, 0.25}},
                               {"emissiveTexture", kTexture},
                               {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}}}}});
    expectColor(s.albedo, dvec3(0.9, 0.8, 0.7) * kSrgb * kVertex);
    EXPECT_NEAR(s.opacity, 0.6 * kAlpha * kVertexAlpha, kRounding);
    EXPECT_NEAR(s.values.metallic, 0.6 * kLinear.b, kRounding);
    EXPECT_NEAR(s.values.roughness, 0.9 * kLinear.g, kRounding);
    expectColor(s.emission, dvec3(3, 1.5, 0.75) * kSrgb); // without vertex colours
    EXPECT_TRUE(s.isInLightTable);
}

TEST_F(GltfProducts, OfUnlit) {
    const json pbr = {{"baseColorFactor", {0.9, 0.8, 0.7, 0.6}}, {"baseColorTexture", kTexture}};
    json material = {{"pbrMetallicRoughness", pbr},
                     {"emissiveFactor", {1, 1, 1}}, // counts for nothing
                     {"extensions", {{"KHR_materials_unlit", json::object()}}}};
    for (const bool isExported : {false, true})
        for (const char* mode : {"OPAQUE", "MASK", "BLEND"}) {
            SCOPED_TRACE(mode);
            material["alphaMode"] = mode;
            material["alphaCutoff"] = 0.1;
            const SeenSurface s = see(material, isExported);
            expectColor(s.emission, dvec3(0.9, 0.8, 0.7) * kSrgb * kVertex);
            expectColor(s.albedo, dvec3(0));
            EXPECT_EQ(s.values.specular, 0.0f);
            EXPECT_NEAR(s.opacity, mode[0] == 'B' ? 0.6 * kAlpha * kVertexAlpha : 1, kRounding);
            EXPECT_FALSE(s.isInLightTable);
        }
}

// Whoever says in a scene file that it is a light: light sampling would leave out the colours.
TEST_F(GltfProducts, EmissionOfVertexColorsIsInNoLightTable) {
    see({{"extensions", {{"KHR_materials_unlit", json::object()}}}});
    std::get<MeshDesc>(desc.objects.at(0).shape).light = true;
    EXPECT_TRUE(app::compile(desc, true)->lights.empty());
    desc.materials.begin()->second.principled.emitsColors = false;
    EXPECT_EQ(app::compile(desc, true)->lights.size(), 1u);
}

TEST_F(GltfProducts, OfNumbersOfExtensions) {
    using V = shared::PrincipledValues;
    using Factor = float V::*;
    struct Product {
        const char* extension;
        const char* factor;
        const char* texture;
        Factor value;
        double texel;
    };
    const Product products[] = {
        {"KHR_materials_transmission", "transmissionFactor", "transmissionTexture", &V::transmission, kLinear.r},
        {"KHR_materials_specular", "specularFactor", "specularTexture", &V::specular, kAlpha},
        {"KHR_materials_clearcoat", "clearcoatFactor", "clearcoatTexture", &V::clearcoat, kLinear.r},
        {"KHR_materials_clearcoat", "clearcoatRoughnessFactor", "clearcoatRoughnessTexture", &V::clearcoatRoughness,
         kLinear.g},
        {"KHR_materials_sheen", "sheenRoughnessFactor", "sheenRoughnessTexture", &V::sheenRoughness, kAlpha},
    };
    for (const Product& p : products) {
        SCOPED_TRACE(p.factor);
        EXPECT_NEAR(extended(p.extension, {{p.factor, 0.75}, {p.texture, kTexture}}).values.*p.value, 0.75 * p.texel,
                    kRounding);
    }
}

TEST_F(GltfProducts, OfAnisotropy) {
    const shared::PrincipledValues values =
        extended("KHR_materials_anisotropy",
                 {{"anisotropyStrength", 0.75}, {"anisotropyRotation", 0.5}, {"anisotropyTexture", kTexture}})
            .values;
    EXPECT_NEAR(values.rare.anisotropy, 0.75 * kLinear.b, kRounding);
    // The frame of the normal is any; the angle to where the tangent lies in it is what counts.
    const double direction = std::atan2(2 * kLinear.g - 1, 2 * kLinear.r - 1) + 0.5;
    const auto angleOf = [](const shared::vec2& v) { return std::atan2(double(v.y), double(v.x)); };
    const shared::RareValues plain = extended("KHR_materials_anisotropy", {{"anisotropyStrength", 1}}).values.rare;
    const double seen = angleOf(values.rare.stretch) - angleOf(plain.stretch);
    EXPECT_NEAR(std::cos(seen - direction), 1, 1e-6) << seen << ' ' << direction;
}

TEST_F(GltfProducts, OfIridescenceAndDiffuseTransmission) {
    shared::PrincipledValues values = extended("KHR_materials_iridescence", {{"iridescenceFactor", 0.5},
                                                                             {"iridescenceTexture", kTexture},
                                                                             {"iridescenceThicknessMinimum", 200},
                                                                             {"iridescenceThicknessMaximum", 600},
                                                                             {"iridescenceThicknessTexture", kTexture}})
                                          .values;
    EXPECT_NEAR(values.rare.film, 0.5 * kLinear.r, kRounding);
    EXPECT_NEAR(values.rare.filmThickness, 200 + 400 * kLinear.g, 1e-3);
    EXPECT_NEAR(values.rare.filmIor, 1.3, kRounding);
    values = extended("KHR_materials_iridescence", {{"iridescenceFactor", 1}}).values;
    EXPECT_NEAR(values.rare.filmThickness, 400, 1e-3);
    values = extended("KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.75},
                                                             {"diffuseTransmissionTexture", kTexture},
                                                             {"diffuseTransmissionColorFactor", {0.9, 0.6, 0.3}},
                                                             {"diffuseTransmissionColorTexture", kTexture}})
                 .values;
    EXPECT_NEAR(values.rare.beyond, 0.75 * kAlpha, kRounding);
    expectColor(dvec3(values.rare.beyondColor), dvec3(0.9, 0.6, 0.3) * kSrgb);
}

// By channel at Fraunhofer's lines, only where light is bent.
TEST_F(GltfProducts, OfDispersion) {
    json extensions = {{"KHR_materials_ior", {{"ior", 1.6}}},
                       {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                       {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                       {"KHR_materials_dispersion", {{"dispersion", 2}}}};
    const shared::Principled glass = see({{"extensions", extensions}}).record;
    EXPECT_NEAR(glass.channelIor.x, 1.6 + 0.6 * 2 / 20 * (523655 / (656.3 * 656.3) - 1.5168), 1e-4);
    EXPECT_NEAR(glass.channelIor.y, 1.6, 1e-6);
    EXPECT_NEAR(glass.channelIor.z, 1.6 + 0.6 * 2 / 20 * (523655 / (486.1 * 486.1) - 1.5168), 1e-4);
    EXPECT_EQ(glass.glass, glass.channelGlass.y);
    EXPECT_NE(glass.channelGlass.x, glass.channelGlass.z);
    extensions.erase("KHR_materials_volume");
    EXPECT_EQ(see({{"extensions", extensions}}).record.channelIor, shared::vec3(0));
}

TEST_F(GltfProducts, OfColorsOfExtensions) {
    const dvec3 factor(0.9, 0.6, 0.3);
    const json values = {0.9, 0.6, 0.3};
    expectColor(dvec3(extended("KHR_materials_sheen", {{"sheenColorFactor", values}, {"sheenColorTexture", kTexture}})
                          .values.sheenColor),
                factor * kSrgb);
    expectColor(
        dvec3(extended("KHR_materials_specular", {{"specularColorFactor", values}, {"specularColorTexture", kTexture}})
                  .values.specularColor),
        factor * kSrgb);
}

// By the extension: reflectance at normal incidence is the specular colour, roughness 1 - glossiness.
TEST_F(GltfProducts, OfSpecularGlossiness) {
    json gloss = {
        {"diffuseFactor", {0.9, 0.8, 0.7, 0.6}}, {"specularFactor", {0.8, 0.4, 0.2}}, {"glossinessFactor", 0.75}};
    const json textures = {{"diffuseTexture", kTexture}, {"specularGlossinessTexture", kTexture}};
    for (const bool isTextured : {false, true})
        for (const bool isExported : {false, true}) {
            json all = gloss;
            if (isTextured) all.update(textures);
            const SeenSurface s = see({{"alphaMode", "BLEND"},
                                       {"pbrMetallicRoughness", {{"metallicFactor", 1}}}, // for other programs
                                       {"extensions", {{"KHR_materials_pbrSpecularGlossiness", all}}}},
                                      isExported);
            const dvec3 texel = isTextured ? kSrgb : dvec3(1);
            const double alpha = isTextured ? kAlpha : 1;
            expectColor(s.albedo, dvec3(0.9, 0.8, 0.7) * texel * kVertex);
            EXPECT_NEAR(s.opacity, 0.6 * alpha * kVertexAlpha, kRounding);
            EXPECT_EQ(s.values.metallic, 0.0f);
            EXPECT_NEAR(s.values.roughness, 1 - 0.75 * alpha, kRounding);
            const dvec3 specular = dvec3(0.8, 0.4, 0.2) * texel;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(s.f0(c), specular[c], 5e-4 * specular[c]); // of kLargestIor
        }
    const SeenSurface usual = extended("KHR_materials_pbrSpecularGlossiness", json::object());
    EXPECT_EQ(usual.values.roughness, 0.0f);
    EXPECT_NEAR(usual.f0(0), 1, 5e-4);
}

// ---- values without an upper limit ---------------------------------------------------------------------------------

TEST_F(GltfProducts, CutoffsAboveOneHideAll) {
    for (const bool isExported : {false, true})
        for (const double cutoff : {0.0, 0.25, 1.0, 1.5, 1e6}) {
            const SeenSurface s =
                see({{"alphaMode", "MASK"}, {"alphaCutoff", cutoff}}, isExported); // opacity is that of vertices
            EXPECT_EQ(s.opacity, kVertexAlpha >= cutoff ? 1 : 0) << cutoff;
        }
}

TEST_F(GltfProducts, IndexOfRefraction) {
    for (const double ior : {1.0, 1.33, 10.0, 12.0, 1000.0})
        EXPECT_EQ(extended("KHR_materials_ior", {{"ior", ior}}).values.ior, float(ior));
    EXPECT_NEAR(extended("KHR_materials_ior", {{"ior", 0}}).f0(0), 1, 5e-4); // by the extension all reflects
    const auto glass = see({{"extensions",
                             {{"KHR_materials_ior", {{"ior", 1e9}}},
                              {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                              {"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
    EXPECT_EQ(glass.values.ior, float(kLargestIor));
    const auto compiled = app::compile(desc, true);
    for (const float albedo : compiled->glassAlbedos) EXPECT_TRUE(albedo >= 0 && albedo <= 1.01f) << albedo;
}

TEST_F(GltfProducts, SpecularColor) {
    struct Row {
        double factor, f0;
    };
    for (const Row& row : {Row{0.5, 0.02}, Row{1, 0.04}, Row{2, 0.08}, Row{20, 0.8}, Row{30, 1}, Row{1e6, 1}}) {
        const SeenSurface s =
            extended("KHR_materials_specular", {{"specularColorFactor", {row.factor, row.factor / 2, 0}}});
        EXPECT_NEAR(s.f0(0), row.f0, 1e-3 * row.f0) << row.factor;
        const double second = std::min(row.factor / 2 * 0.04, 1.0);
        EXPECT_NEAR(s.f0(1), second, 1e-3 * second) << row.factor;
        EXPECT_EQ(s.f0(2), 0) << row.factor;
    }
    const SeenSurface textured =
        extended("KHR_materials_specular", {{"specularColorFactor", {20, 10, 5}}, {"specularColorTexture", kTexture}});
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(textured.f0(c), 0.04 * dvec3(20, 10, 5)[c] * kSrgb[c], 1e-3 * textured.f0(c)) << c;
}

TEST_F(GltfProducts, OtherNumbersWithoutALimit) {
    const auto emission = see({{"emissiveFactor", {1, 1, 1}},
                               {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2e5}}}}}});
    expectColor(emission.emission, dvec3(2e5));
    for (const double distance : {1e-6, 1.0, 1e6}) {
        const auto volume = see(
            {{"extensions",
              {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
               {"KHR_materials_volume",
                {{"thicknessFactor", 1e7}, {"attenuationDistance", distance}, {"attenuationColor", {0.5, 1, 1}}}}}}});
        EXPECT_EQ(volume.values.thin, 0u);
        EXPECT_NEAR(double(volume.record.absorption.x) * distance, std::log(2.0), 1e-6);
    }
    const auto bumps =
        see({{"normalTexture", {{"index", 0}, {"scale", 500}}},
             {"extensions",
              {{"KHR_materials_clearcoat",
                {{"clearcoatFactor", 1}, {"clearcoatNormalTexture", {{"index", 0}, {"scale", -700}}}}}}}});
    EXPECT_EQ(bumps.record.normalScale, 500.0f);
    EXPECT_EQ(bumps.record.coatScale, -700.0f);
    const json transform = {{"offset", {1000, 2000}}, {"scale", {5000, 6000}}, {"rotation", 100}};
    see({{"pbrMetallicRoughness",
          {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}});
    const auto& rows = std::get<ImageTexture>(desc.textures.begin()->second).uvTransform;
    EXPECT_NEAR(rows[0], std::cos(100.0) * 5000, 1e-9);
    EXPECT_NEAR(rows[2], 1000 + std::sin(100.0) * 6000, 1e-9);
}

TEST_F(GltfProducts, Lights) {
    GltfBuilder gltf;
    gltf.addNode({{"mesh", gltf.addMesh(gltf.triangle())}});
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 1e6}, {"color", {1, 0.5, 0.25}}},
        {{"type", "directional"}, {"intensity", 1e5}}};
    for (int i = 0; i < 2; ++i) gltf.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    desc = loadGltfScene(gltf.save(folder / "a.glb"));
    EXPECT_EQ(std::get<PointLightDesc>(desc.objects.at(1).shape).intensity, dvec3(1e6, 5e5, 2.5e5));
    EXPECT_EQ(std::get<DirectionalLightDesc>(desc.objects.at(2).shape).irradiance, dvec3(1e5));
}

} // namespace
} // namespace rt::scene
