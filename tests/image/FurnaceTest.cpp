// Scenes whose radiance is known everywhere: whatever a path does, it must gather the same light.
#include <algorithm>
#include <cmath>

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
                EXPECT_TRUE(isMean(render(*scene, settings), glm::dvec3(truth)))
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
