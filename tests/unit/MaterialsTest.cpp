// What holds for every row of the table of materials, whoever adds one: it is sampled as its density says, survives a
// scene file, and the published schema describes it.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/PrincipledType.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/MaterialTypes.h"
#include "Common/Shared/Material/Bsdf.h"
#include "tests/unit/DirectionCells.h"
#include "tests/unit/JsonSchema.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/SceneParameters.h"
#include "tests/unit/Statistics.h"

namespace rt::scene {
namespace {

using Json = nlohmann::json;
using glm::dvec3;
using shared::vec3;

class Materials : public testing::TestWithParam<std::size_t> {
  protected:
    const MaterialType& type_ = materialTypes()[GetParam()];

    // Its numbers at this share of their ranges.
    shared::Bsdf bsdf(double share) const {
        shared::Bsdf m{};
        m.kind = static_cast<std::uint32_t>(type_.kind);
        m.albedo = vec3(0.2f, 0.5f, 0.9f);
        forEachNumber(type_, [&](const MaterialParameter& p, std::size_t i) {
            m.parameter[i] = static_cast<float>(std::lerp(p.minimum, p.maximum, share));
        });
        return m;
    }
};

// ---- sampling ------------------------------------------------------------------------------------------------------

TEST_P(Materials, AreSampledAsTheirDensitySays) {
    const vec3 n(0, 0, 1);
    test::Uniforms uniform(21);
    for (const double share : {0.5, 0.8, 1.0}) {
        const shared::Bsdf m = bsdf(share);
        if (!shared::scattersWidely(m) || type_.kind == MaterialKind::Principled) continue; // PrincipledTest.cpp
        for (const double cosine : {0.95, 0.3}) {
            const vec3 wo(test::onSphere(0.5 * (cosine + 1), 0.1));
            const auto density = [&](double u, double v) {
                return double(shared::evalBsdf(shared::kFeatureAll, m, n, wo, vec3(test::onSphere(u, v))).w);
            };
            const std::vector<double> expected = test::cellMasses(density);
            const double integral = std::accumulate(expected.begin(), expected.end(), 0.0);
            // At the rim of metal the midpoints miss a few percent.
            EXPECT_NEAR(integral, 1, 0.05) << "numbers at " << share << " of their ranges, cosine " << cosine;

            std::vector<std::uint64_t> counts(expected.size());
            for (int i = 0; i < 1 << 14; ++i) {
                const shared::vec2 u = uniform.pair();
                const shared::BsdfSample s = sampleBsdf(shared::kFeatureAll, m, n, 1, wo, u, u.x);
                ASSERT_EQ(s.delta, 0u);
                ++counts[test::cellOf(s.wi)];
                const shared::vec4 f = evalBsdf(shared::kFeatureAll, m, n, wo, s.wi);
                ASSERT_NEAR(f.w, s.pdf, 1e-4f * s.pdf);
                if (s.weight == vec3(0)) continue;
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(s.weight[c] * s.pdf, f[c], 1e-4f * f[c]);
            }
            EXPECT_GT(test::chiSquareP(counts, expected), test::kSignificance)
                << "numbers at " << share << " of their ranges, cosine " << cosine;
        }
    }
}

// Pixels share paths by that formula where the row says so.
TEST_P(Materials, ScatterEvenlyWhereTheirRowSaysSo) {
    const vec3 n(0, 0, 1);
    test::Uniforms uniform(23);
    for (const double share : {0.0, 0.5, 1.0}) {
        const shared::Bsdf m = bsdf(share);
        if (!shared::scattersEvenly(shared::kFeatureAll, m)) continue;
        EXPECT_TRUE(shared::scattersDiffusely(shared::kFeatureAll, m) &&
                    shared::hasDiffuseLobe(shared::kFeatureAll, m));
        for (int i = 0; i < 1000; ++i) {
            const shared::vec2 u = uniform.pair(), v = uniform.pair();
            const vec3 wo(test::onSphere(0.5 * (1 + u.x), u.y)), wi(test::onSphere(0.5 * (1 + v.x), v.y));
            const vec3 expected = m.albedo * (wi.z * shared::kInvPi);
            const shared::vec4 f = evalBsdf(shared::kFeatureAll, m, n, wo, wi);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(f[c], expected[c], 1e-5f * expected[c]);
        }
    }
}

// What is white reflects at most what it receives.
TEST_P(Materials, MakeNoLight) {
    const vec3 n(0, 0, 1);
    test::Uniforms uniform(22);
    for (const double share : {0.0, 0.25, 0.5, 1.0}) {
        shared::Bsdf m = bsdf(share);
        m.albedo = vec3(1);
        if (type_.kind == MaterialKind::Principled) continue; // PrincipledEnergyTest.cpp
        for (const double cosine : {0.95, 0.3}) {
            test::Mean reflected;
            for (int i = 0; i < 1 << 12; ++i) {
                const shared::vec2 u = uniform.pair();
                const float lobe = uniform.pair().x;
                const vec3 wo(test::onSphere(0.5 * (cosine + 1), 0.1));
                reflected.add(sampleBsdf(shared::kFeatureAll, m, n, 1, wo, u, lobe).weight.x);
            }
            EXPECT_TRUE(reflected.mean() <= 1 || test::agrees(reflected, 1, 1e-4)) << share << ", " << cosine;
        }
    }
}

// ---- scene files ---------------------------------------------------------------------------------------------------

TEST_P(Materials, SurviveASceneFile) {
    Json material = {{"type", type_.name}, {"emission", {1, 2, 3}}};
    if (const MaterialParameter* color = colorOf(type_)) material[color->name] = "check";
    forEachNumber(type_, [&](const MaterialParameter& p, std::size_t) {
        material[p.name] = std::lerp(p.minimum, p.maximum, 0.25);
    });
    if (type_.kind == MaterialKind::Principled)
        forEachPrincipledParameter([&](const SceneParameter& p, auto member) {
            material[p.name] = test::sample(p, PrincipledDesc().*member);
        });
    const Json check = {{"type", "checker"}, {"scale", 1}, {"even", {1, 0, 0}}, {"odd", {0, 1, 0}}};
    const Json file = {{"version", 1},
                       {"textures", {{"check", check}, {"other", check}}},
                       {"materials", {{"it", material}}},
                       {"objects", {{{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 1}, {"material", "it"}}}}};
    const SceneDesc scene = parseScene(file.dump(), "test.json", {});
    EXPECT_EQ(parseScene(toJson(scene), "test.json", {}), scene);
    EXPECT_EQ(Json::parse(toJson(scene))["materials"]["it"], material);

    const auto compiled = compileScene(scene);
    const shared::Material& made = compiled->materials.at(0);
    EXPECT_EQ(made.kind, static_cast<std::uint32_t>(type_.kind));
    EXPECT_EQ(made.texture != shared::kNone, colorOf(type_) != nullptr);
    forEachNumber(type_, [&](const MaterialParameter& p, std::size_t i) {
        EXPECT_EQ(made.parameter[i], static_cast<float>(std::lerp(p.minimum, p.maximum, 0.25))) << p.name;
    });
    EXPECT_EQ(compiled->features & type_.feature, type_.feature);
}

Json schemaOf(const MaterialParameter& parameter) {
    const std::string help = parameter.help;
    if (parameter.type == MaterialParameter::Type::Color) {
        const Json reference = {{"$ref", "#/definitions/color_or_texture"}};
        return help.empty() ? reference : Json{{"description", help}, {"allOf", Json::array({reference})}};
    }
    Json schema = {{"type", "number"}, {"minimum", parameter.minimum}, {"maximum", parameter.maximum}};
    if (!parameter.isRequired) schema["default"] = parameter.usual;
    if (!help.empty()) schema["description"] = help;
    return schema;
}

Json schemaOf(const MaterialType& type) {
    Json properties = {
        {"type", {{"const", type.name}}},
        {"emission", {{"$ref", "#/definitions/radiance"}}},
        {"emission_texture", {{"type", "string"}, {"description", "a name from textures; multiplies emission"}}},
        {"sides",
         {{"enum", {"front", "both"}},
          {"description", "which sides emit; by the flag --one-sided-lights where it is missing"}}}};
    Json required = {"type"};
    for (const MaterialParameter& parameter : type.parameters) {
        properties[parameter.name] = schemaOf(parameter);
        if (parameter.isRequired) required.push_back(parameter.name);
    }
    if (type.kind == MaterialKind::Principled)
        forEachPrincipledParameter([&](const SceneParameter& p, auto member) {
            properties[p.name] = test::described(p, test::schemaOf(p, PrincipledDesc().*member));
        });
    if (!type.scatters) required.push_back("emission");
    return {{"description", type.help},
            {"type", "object"},
            {"properties", properties},
            {"required", required},
            {"additionalProperties", false}};
}

TEST(MaterialTable, IsTheSchemas) {
    std::ifstream in(std::filesystem::path(RT_SOURCE_DIR) / "Assets" / "scene.schema.json");
    const Json published = Json::parse(in)["definitions"]["material"]["oneOf"];
    Json expected = Json::array();
    for (const MaterialType& type : materialTypes()) expected.push_back(schemaOf(type));
    EXPECT_EQ(published, expected) << "definitions/material/oneOf has to be\n" << expected.dump(2);
}

INSTANTIATE_TEST_SUITE_P(Table, Materials, testing::Range(std::size_t{0}, materialTypes().size()),
                         [](const auto& info) {
                             std::string name = materialTypes()[info.param].name;
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

} // namespace
} // namespace rt::scene
