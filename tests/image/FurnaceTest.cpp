// Scenes whose radiance is known everywhere: whatever a path does, it must gather the same light.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "Common/App/Interactive/MaterialPresets.h"
#include "tests/image/AnalyticScenes.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using namespace rt::scene;

TEST(Furnace, EnclosureHasItsClosedFormRadiance) {
    for (bool box : {false, true}) {
        const auto scene = compileScene(shell(box, 0.6, 0.5));
        for (app::RenderSettings settings : allEstimators(smallSettings(4, 1024))) {
            for (std::uint32_t depth : {1u, 2u, 7u}) {
                settings.maxDepth = depth;
                const double truth = enclosureRadiance(0.6, 0.5, static_cast<int>(depth));
                const double cutOff = std::pow(0.6, depth - 1);
                const Estimate estimate = render(*scene, settings);
                EXPECT_TRUE(isMean(estimate, glm::dvec3(truth))) << (box ? "box, " : "sphere, ") << describe(settings);
                EXPECT_NEAR(estimate.cutOffShare, cutOff, 0.05 * std::sqrt(cutOff))
                    << (box ? "box, " : "sphere, ") << describe(settings);
            }
        }
    }
}

TEST(Furnace, RouletteChangesNothingButVariance) {
    app::RenderSettings settings = smallSettings(8, 4096);
    settings.maxDepth = 64;
    settings.lightSampling = app::LightSampling::Bsdf;
    for (bool roulette : {false, true}) {
        settings.russianRoulette = roulette;
        EXPECT_TRUE(isMean(render(shell(false, 0.5, 1), settings), glm::dvec3(enclosureRadiance(0.5, 1, 64))))
            << roulette;
    }
}

// Far from the origin rounding would decide whether a ray starts inside: half a lamp is as thick there as 170
// roundings.
TEST(Furnace, ConvexLampsDoNotLightThemselves) {
    for (const Transform& transform : lampTransforms()) {
        for (const double distance : {6.0, 1000.0}) {
            const auto scene = compileScene(lampAlone(transform, distance));
            for (const app::RenderSettings& settings : allEstimators(smallSettings(48, 4))) {
                const Estimate estimate = render(*scene, settings);
                const auto [minimum, maximum] =
                    std::minmax_element(estimate.image.data.begin(), estimate.image.data.end());
                EXPECT_EQ(*minimum, 0.0f);
                EXPECT_GT(*maximum, 0.4f); // the thinnest do not fill a pixel
                EXPECT_LE(*maximum, 1.0f) << describe(settings) << ", from " << distance;
            }
        }
    }
}

TEST(Furnace, LosslessBodiesAreInvisibleInAWhiteSky) {
    MaterialDesc glass;
    glass.kind = MaterialKind::Dielectric;
    MaterialDesc mirror;
    mirror.kind = MaterialKind::Metal;
    app::RenderSettings settings = smallSettings(8, 2048);
    settings.maxDepth = 4096;
    for (const MaterialDesc& material : {lambertian(1), glass, mirror}) {
        EXPECT_TRUE(isMean(render(inWhiteSky(material), settings), glm::dvec3(1)));
    }
}

TEST(Furnace, MaterialsOfTheLibraryMakeNoLight) {
    std::vector<std::string> failures;
    const auto presets = app::readMaterialPresets(std::string(RT_SOURCE_DIR) + "/Assets/materials", failures);
    EXPECT_GE(presets.size(), 30u);
    for (const app::MaterialPreset& preset : presets) {
        const MaterialDesc& material = preset.scene->materials.at(preset.name);
        const Estimate estimate = render(inWhiteSky(material), smallSettings(8, 512));
        for (int c = 0; c < 3; ++c) // white surfaces are white to the percent that tables leave
            EXPECT_LE(estimate.mean[c], 1.01 + 4 * estimate.standardError[c]) << preset.name << ' ' << c;
    }
}

// What was cut off of white paths is what the picture lacks.
TEST(Furnace, DepthCutsOffWhatIsMissing) {
    MaterialDesc glass;
    glass.kind = MaterialKind::Dielectric;
    app::RenderSettings settings = smallSettings(8, 256);
    settings.russianRoulette = false;
    for (const std::uint32_t depth : {1u, 2u, 3u, 4096u}) {
        settings.maxDepth = depth;
        for (const MaterialDesc& material : {glass, lambertian(1)}) {
            const Estimate estimate = render(inWhiteSky(material), settings);
            EXPECT_NEAR(estimate.mean.x + estimate.cutOffShare, 1, 1e-5) << depth;
        }
    }
}

// However grazing light is, and however smooth the fibres.
TEST(Furnace, SheenMakesNoEnergy) {
    for (const double roughness : {0.0, 0.15, 0.3})
        for (const double cosine : {0.002, 0.05}) {
            const Estimate estimate = render(floorInWhiteSky(whiteSheen(roughness), cosine), smallSettings(4, 8192));
            EXPECT_LE(estimate.mean.x, 1.001 + 4 * estimate.standardError.x) << roughness << ", cosine " << cosine;
            EXPECT_GE(estimate.mean.x, 0.98 - 4 * estimate.standardError.x) << roughness << ", cosine " << cosine;
        }
}

TEST(Furnace, RoughGlassOfEqualIndicesIsInvisible) {
    for (const double ior : {1.0, 1.00001, 1.0001})
        for (const double roughness : {0.2, 0.5, 1.0}) {
            const Estimate estimate = render(inWhiteSky(roughGlass(ior, roughness)), smallSettings(16, 512));
            const double allowed = ior == 1 ? 1e-5 : 1e-3;
            EXPECT_NEAR(estimate.mean.x, 1, allowed + 4 * estimate.standardError.x) << ior << ' ' << roughness;
            const auto [least, most] = std::ranges::minmax(estimate.image.data);
            EXPECT_GT(least, 0.97f) << ior << ' ' << roughness;
            EXPECT_LT(most, 1.01f) << ior << ' ' << roughness;
        }
}

TEST(Furnace, WhiteMediumIsInvisibleInAWhiteSky) {
    app::RenderSettings settings = smallSettings(8, 2048);
    settings.maxDepth = 4096;
    for (double density : {0.1, 3.0}) {
        SceneDesc desc = emptyScene({0, 0, 4}, {0, 0, 0}, 40);
        desc.background = ConstantBackground{glm::dvec3(1)};
        desc.objects.push_back({MediumDesc{SphereBoundary{glm::dvec3(0), 1}, density, glm::dvec3(1)}});
        desc.objects.push_back({MediumDesc{BoxBoundary{glm::dvec3(-0.5), glm::dvec3(1.5)}, density, glm::dvec3(1)}});
        EXPECT_TRUE(isMean(render(desc, settings), glm::dvec3(1))) << density;
    }
}

// A ray that meets rough metal at cosine c loses the fraction max(0, (1 - c / fuzz) / 2) to directions below the
// surface.
TEST(Furnace, RoughMetalLosesWhatLeavesItsHemisphere) {
    for (double fuzz : {0.3, 1.0}) {
        for (double cosine : {0.1, 0.5, 0.9}) {
            SceneDesc desc = emptyScene({4 * std::sqrt(1 - cosine * cosine), 4 * cosine, 0}, {0, 0, 0}, 1e-3);
            desc.background = ConstantBackground{glm::dvec3(1)};
            MaterialDesc metal;
            metal.kind = MaterialKind::Metal;
            metal.albedo = glm::dvec3(0.8, 0.6, 0.4);
            metal.parameters[shared::kMetalFuzz] = fuzz;
            desc.materials["metal"] = metal;
            desc.objects.push_back({QuadDesc{{-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, "metal"}});
            const double kept = 1 - std::max(0.0, (1 - cosine / fuzz) / 2);
            EXPECT_TRUE(isMean(render(desc, smallSettings(4, 8192)), kept * glm::dvec3(0.8, 0.6, 0.4)))
                << "fuzz " << fuzz << ", cosine " << cosine;
        }
    }
}

} // namespace
} // namespace rt::test
