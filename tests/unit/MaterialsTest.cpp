// What holds for every row of the table of materials, whoever adds one: it is sampled as its density says, survives a
// scene file, and the published schema describes it.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/MaterialTypes.h"
#include "Common/Shared/Material/Bsdf.h"
#include "tests/unit/JsonSchema.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/Statistics.h"

namespace rt::scene {
namespace {

using Json = nlohmann::json;
using glm::dvec3;
using shared::vec3;
using test::kPi;

class Materials : public testing::TestWithParam<std::size_t> {
  protected:
    const MaterialType& type_ = materialTypes()[GetParam()];

    // Its numbers at this share of their ranges.
    shared::Material record(double share) const {
        shared::Material m{};
        m.kind = static_cast<std::uint32_t>(type_.kind);
        m.albedo = vec3(0.2f, 0.5f, 0.9f);
        m.texture = m.emissionTexture = shared::kNone;
        forEachNumber(type_, [&](const MaterialParameter& p, std::size_t i) {
            m.parameter[i] = static_cast<float>(std::lerp(p.least, p.most, share));
        });
        return m;
    }
};

// ---- sampling ------------------------------------------------------------------------------------------------------

constexpr int kRows = 16, kColumns = 16; // cells of equal solid angle around the normal

dvec3 onSphere(double u, double v) {
    const double z = 2 * u - 1, r = std::sqrt((1 - z) * (1 + z)), phi = 2 * kPi * v;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

std::size_t cellOf(const vec3& w) {
    const double u = 0.5 * (double(w.z) + 1);
    const double v = std::atan2(double(w.y), double(w.x)) / (2 * kPi);
    const int row = std::clamp(int(u * kRows), 0, kRows - 1);
    const int column = std::clamp(int((v < 0 ? v + 1 : v) * kColumns), 0, kColumns - 1);
    return static_cast<std::size_t>(row * kColumns + column);
}

// Over a square of side `side`, which is divided where the density varies: metal's is infinite at the rim of its lobe.
template <typename Density>
double integrate(const Density& density, double u, double v, double side, int depth = 0) {
    constexpr int kLeast = 3, kMost = 9;
    const double half = 0.5 * side;
    double sum = 0, low = 1e30, high = 0;
    for (const double du : {0.0, half})
        for (const double dv : {0.0, half}) {
            const double value = density(u + du + 0.5 * half, v + dv + 0.5 * half);
            sum += value;
            low = std::min(low, value);
            high = std::max(high, value);
        }
    if (depth >= kLeast && (depth == kMost || high <= 1.2 * low)) return 0.25 * sum * side * side;
    sum = 0;
    for (const double du : {0.0, half})
        for (const double dv : {0.0, half}) sum += integrate(density, u + du, v + dv, half, depth + 1);
    return sum;
}

TEST_P(Materials, AreSampledAsTheirDensitySays) {
    const vec3 n(0, 0, 1);
    test::Uniforms uniform(21);
    for (const double share : {0.5, 0.8, 1.0}) {
        const shared::Material m = record(share);
        if (!shared::scattersWidely(m)) continue;
        for (const double cosine : {0.95, 0.3}) {
            const vec3 wo(onSphere(0.5 * (cosine + 1), 0.1));
            const auto density = [&](double u, double v) {
                return double(shared::evalBsdf(shared::kFeatureAll, m, m.albedo, n, wo, vec3(onSphere(u, v))).w);
            };
            std::vector<double> expected;
            for (int row = 0; row < kRows; ++row)
                for (int column = 0; column < kColumns; ++column)
                    expected.push_back(4 * kPi *
                                       integrate(density, double(row) / kRows, double(column) / kColumns, 1.0 / kRows));
            const double integral = std::accumulate(expected.begin(), expected.end(), 0.0);
            // At the rim of metal the midpoints miss a few percent.
            EXPECT_NEAR(integral, 1, 0.05) << "numbers at " << share << " of their ranges, cosine " << cosine;

            std::vector<std::uint64_t> counts(expected.size());
            for (int i = 0; i < 1 << 14; ++i) {
                const shared::vec2 u = uniform.pair();
                const shared::BsdfSample s = sampleBsdf(shared::kFeatureAll, m, m.albedo, n, 1, wo, u, u.x);
                ASSERT_EQ(s.delta, 0u);
                ++counts[cellOf(s.wi)];
                const shared::vec4 f = evalBsdf(shared::kFeatureAll, m, m.albedo, n, wo, s.wi);
                ASSERT_NEAR(f.w, s.pdf, 1e-4f * s.pdf);
                if (s.weight == vec3(0)) continue;
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(s.weight[c] * s.pdf, f[c], 1e-4f * f[c]);
            }
            EXPECT_GT(test::chiSquareP(counts, expected), test::kSignificance)
                << "numbers at " << share << " of their ranges, cosine " << cosine;
        }
    }
}

// ---- scene files ---------------------------------------------------------------------------------------------------

TEST_P(Materials, SurviveASceneFile) {
    Json material = {{"type", type_.name}, {"emission", {1, 2, 3}}};
    if (const MaterialParameter* color = colorOf(type_)) material[color->name] = "check";
    forEachNumber(
        type_, [&](const MaterialParameter& p, std::size_t) { material[p.name] = std::lerp(p.least, p.most, 0.25); });
    const Json file = {
        {"version", 1},
        {"textures", {{"check", {{"type", "checker"}, {"scale", 1}, {"even", {1, 0, 0}}, {"odd", {0, 1, 0}}}}}},
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
        EXPECT_EQ(made.parameter[i], static_cast<float>(std::lerp(p.least, p.most, 0.25))) << p.name;
    });
    EXPECT_EQ(compiled->features & type_.feature, type_.feature);
}

Json schemaOf(const MaterialParameter& parameter) {
    const std::string help = parameter.help;
    if (parameter.type == MaterialParameter::Type::Color) {
        const Json reference = {{"$ref", "#/definitions/color_or_texture"}};
        return help.empty() ? reference : Json{{"description", help}, {"allOf", Json::array({reference})}};
    }
    Json schema = {{"type", "number"}, {"minimum", parameter.least}, {"maximum", parameter.most}};
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
