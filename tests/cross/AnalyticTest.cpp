// Scenes whose radiance is known in closed form, on the GPU: the comparison with the CPU would not see a mistake that
// both make.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/Device.h"
#include "tests/image/AnalyticScenes.h"
#include "tests/image/Harness.h"
#include "tests/unit/Oracles.h"

namespace rt::test {
namespace {

using namespace rt::scene;
using glm::dvec3;

class AnalyticTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, AnalyticTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, AnalyticTest, kSecondEngine, engineName);

// Renders one scene after another with many settings. Its engine compiles shaders where they differ from those of the
// render before.
class GpuRenders {
  public:
    GpuRenders() = default;
    explicit GpuRenders(const SceneDesc& desc) { setScene(desc); }
    void setScene(const SceneDesc& desc) {
        scene_ = compileScene(desc);
        engine_->setScene(scene_, nullptr);
    }
    Estimate operator()(const app::RenderSettings& settings) { return render(*engine_, *scene_, settings); }

  private:
    std::shared_ptr<const CompiledScene> scene_;
    std::unique_ptr<app::Engine> engine_ =
        gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = AnalyticTest::GetParam()});
};

TEST_P(AnalyticTest, EnclosureHasItsClosedFormRadiance) {
    for (const bool box : {false, true}) {
        GpuRenders renders(shell(box, 0.6, 0.5));
        app::RenderSettings settings = smallSettings(4, 1024);
        for (const auto sampling : {app::LightSampling::Bsdf, app::LightSampling::Mixture, app::LightSampling::Mis,
                                    app::LightSampling::MisBalance}) {
            // Walls and estimators are no matter of each other: two of these with each at every change.
            const bool isOfBox = sampling == app::LightSampling::Mixture || sampling == app::LightSampling::Mis;
            if (isOfBox != box && !isNightly(GetParam())) continue;
            settings.lightSampling = sampling;
            for (const std::uint32_t depth : {1u, 2u, 7u}) {
                settings.maxDepth = depth;
                const double truth = enclosureRadiance(0.6, 0.5, static_cast<int>(depth));
                const Estimate estimate = renders(settings);
                EXPECT_TRUE(isMean(estimate, dvec3(truth))) << (box ? "box, " : "sphere, ") << describe(settings);
                const double cutOff = std::pow(0.6, depth - 1);
                EXPECT_NEAR(estimate.cutOffShare, cutOff, 0.05 * std::sqrt(cutOff))
                    << (box ? "box, " : "sphere, ") << describe(settings);
            }
        }
    }
}

TEST_P(AnalyticTest, RouletteChangesNothingButVariance) {
    GpuRenders renders(shell(false, 0.5, 1));
    app::RenderSettings settings = smallSettings(8, 4096);
    settings.maxDepth = 64;
    settings.lightSampling = app::LightSampling::Bsdf;
    for (const bool roulette : {false, true}) {
        settings.russianRoulette = roulette;
        EXPECT_TRUE(isMean(renders(settings), dvec3(enclosureRadiance(0.5, 1, 64)))) << roulette;
    }
}

TEST_P(AnalyticTest, ConvexLampsDoNotLightThemselves) {
    GpuRenders renders;
    for (const auto sampling : {app::LightSampling::Bsdf, app::LightSampling::Mis}) {
        for (const Transform& transform : lampTransforms()) {
            for (const double distance : {6.0, 1000.0}) {
                renders.setScene(lampAlone(transform, distance));
                app::RenderSettings settings = smallSettings(48, 4);
                settings.lightSampling = sampling;
                const Estimate estimate = renders(settings);
                const float maximum = *std::max_element(estimate.image.data.begin(), estimate.image.data.end());
                EXPECT_GT(maximum, 0.4f);
                EXPECT_LE(maximum, 1.0f) << describe(settings) << ", from " << distance;
            }
        }
    }
}

TEST_P(AnalyticTest, LosslessBodiesAreInvisibleInAWhiteSky) {
    MaterialDesc glass;
    glass.kind = MaterialKind::Dielectric;
    MaterialDesc mirror;
    mirror.kind = MaterialKind::Metal;
    app::RenderSettings settings = smallSettings(8, 1024);
    settings.maxDepth = 4096;
    for (const MaterialDesc& material : {lambertian(1), glass, mirror}) {
        EXPECT_TRUE(isMean(GpuRenders(inWhiteSky(material))(settings), dvec3(1)));
    }
}

TEST_P(AnalyticTest, DepthCutsOffWhatIsMissing) {
    MaterialDesc glass;
    glass.kind = MaterialKind::Dielectric;
    app::RenderSettings settings = smallSettings(8, 256);
    settings.russianRoulette = false;
    for (const MaterialDesc& material : {glass, lambertian(1)}) {
        GpuRenders renders(inWhiteSky(material));
        for (const std::uint32_t depth : {1u, 2u, 3u}) {
            settings.maxDepth = depth;
            const Estimate estimate = renders(settings);
            EXPECT_NEAR(estimate.mean.x + estimate.cutOffShare, 1, 1e-5) << depth;
        }
    }
}

TEST_P(AnalyticTest, PrincipledSurfacesMakeNoEnergy) {
    GpuRenders renders;
    for (const double cosine : {0.002, 0.05}) {
        renders.setScene(floorInWhiteSky(whiteSheen(0), cosine));
        const Estimate estimate = renders(smallSettings(4, 8192));
        EXPECT_LE(estimate.mean.x, 1.001 + 4 * estimate.standardError.x) << cosine;
        EXPECT_GE(estimate.mean.x, 0.98 - 4 * estimate.standardError.x) << cosine;
    }
}

TEST_P(AnalyticTest, RoughGlassOfEqualIndicesIsInvisible) {
    GpuRenders renders;
    for (const double ior : {1.0, 1.00001, 1.0001})
        for (const double roughness : {0.2, 1.0}) {
            renders.setScene(inWhiteSky(roughGlass(ior, roughness)));
            const Estimate estimate = renders(smallSettings(16, 512));
            EXPECT_NEAR(estimate.mean.x, 1, (ior == 1 ? 1e-5 : 1e-3) + 4 * estimate.standardError.x) << ior;
            EXPECT_GT(*std::min_element(estimate.image.data.begin(), estimate.image.data.end()), 0.97f) << ior;
        }
}

// With each way of placing a point on a light; the expectation is the same for all. That each of them fits each
// estimator is proved on the CPU (tests/image), and that both engines weigh alike by comparing them: at every change
// the way that is the default, whose estimator also asks for the density of a direction that it did not draw, is enough
// to see a device that does not trace what the formulas say.
void expectIrradiance(const SceneDesc& desc, double formFactor, const char* what) {
    struct Way {
        app::LightSampling sampling;
        app::ShapeSampling shape;
        bool nightly;
    };
    using enum app::LightSampling;
    using enum app::ShapeSampling;
    constexpr Way kWays[] = {{Mis, Auto, false},       {Bsdf, Auto, true},      {Mixture, Auto, true},
                             {MisBalance, Auto, true}, {Mis, SolidAngle, true}, {Mis, Projected, true},
                             {Mis, Area, true}};
    GpuRenders renders(desc);
    const dvec3 truth = dvec3(3, 2, 1) * (formFactor * kFloorAlbedo / std::numbers::pi);
    app::RenderSettings settings = smallSettings(4, 2048);
    settings.maxDepth = 2;
    for (const Way& way : kWays) {
        if (way.nightly && !isNightly(AnalyticTest::GetParam())) continue;
        settings.lightSampling = way.sampling;
        settings.sphereLight = settings.quadLight = settings.triangleLight = way.shape;
        EXPECT_TRUE(isMean(renders(settings), truth))
            << what << ", " << describe(settings) << ", shape " << static_cast<int>(way.shape);
    }
}

TEST_P(AnalyticTest, IrradianceUnderASphere) {
    const dvec3 center(1.5, 1.2, -0.5);
    SceneDesc desc = floorScene();
    desc.objects.push_back({SphereDesc{center, 0.8, {}, "light"}});
    const double d = glm::length(center);
    expectIrradiance(desc, std::numbers::pi * (0.64 / (d * d)) * center.y / d, "sphere");
}

TEST_P(AnalyticTest, IrradianceUnderAnEllipsoid) {
    SceneDesc desc = floorScene();
    GroupDesc group;
    group.transform = {Rotate{{1, 2, 3}, 50}, Scale{{-0.8, 0.1, 0.5}}, Translate{{0.5, 2, -0.4}}};
    group.objects.push_back({SphereDesc{dvec3(0), 1, {}, "light"}});
    desc.objects.push_back({group});
    const Affine map = toAffine(group.transform);
    expectIrradiance(desc, polygonIrradiance(ellipsoidOutline(map.offset, map.linear)), "ellipsoid");
}

TEST_P(AnalyticTest, IrradianceUnderAQuad) {
    const dvec3 corner(0.4, 0.1, -1);
    const dvec3 u(0.3, 1, 0.2);
    const dvec3 v(0, 0.5, 2);
    SceneDesc desc = floorScene();
    desc.objects.push_back({QuadDesc{corner, u, v, "light"}});
    expectIrradiance(desc, polygonIrradiance(std::array{corner, corner + u, corner + u + v, corner + v}), "quad");
}

TEST_P(AnalyticTest, IrradianceUnderATriangle) {
    const std::array<dvec3, 3> triangle{dvec3(-1, 0.8, 0.3), dvec3(1.2, 1.1, 0.1), dvec3(0.2, 0.9, -1.4)};
    SceneDesc desc = floorScene();
    MeshData mesh;
    mesh.positions.assign(triangle.begin(), triangle.end());
    mesh.triangles = {{0, 1, 2}};
    desc.objects.push_back({MeshDesc{mesh, "light"}});
    expectIrradiance(desc, polygonIrradiance(triangle), "triangle");
}

TEST_P(AnalyticTest, IrradianceUnderLampsThatArePartlyClear) {
    for (const ClearLamp& lamp : clearLamps()) {
        // On the device the kinds of lights are one text: the other reasons run on the CPU.
        if (isNightly(AnalyticTest::GetParam()) || lamp.what == std::string("quad") ||
            lamp.what == std::string("triangle of clear vertex colours"))
            expectIrradiance(lamp.desc, lamp.formFactor, lamp.what);
    }
}

TEST_P(AnalyticTest, IrradianceUnderPunctualLights) {
    std::vector<std::vector<ObjectDesc>> scenes = {manyPunctualLights(12), manyPunctualLights(40)};
    for (const ObjectDesc& light : punctualLights()) scenes.push_back({light});
    GpuRenders renders;
    for (const std::vector<ObjectDesc>& lights : scenes) {
        renders.setScene(floorUnder(lights));
        app::RenderSettings settings = smallSettings(4, 512);
        settings.maxDepth = 2;
        const dvec3 truth = punctualIrradiance(lights) * (kFloorAlbedo / std::numbers::pi);
        // Every estimator samples punctual lights.
        settings.lightSampling = lights.size() == 1 ? app::LightSampling::Bsdf : app::LightSampling::Mis;
        EXPECT_TRUE(isMean(renders(settings), truth)) << lights.size() << ", " << lights[0].shape.index();
    }
}

// Nothing but a medium: the acceleration structure is empty.
TEST_P(AnalyticTest, TransmittanceOfAnAbsorbingSlab) {
    GpuRenders renders;
    for (const double depth : {1e-4, 1.0, 5.0}) {
        SceneDesc desc = emptyScene({0, 0, 4}, {0, 0, 0}, 1e-3);
        desc.background = ConstantBackground{dvec3(1)};
        desc.objects.push_back({MediumDesc{BoxBoundary{dvec3(-3, -3, -1), dvec3(3, 3, 1)}, depth / 2, dvec3(0)}});
        renders.setScene(desc);
        EXPECT_TRUE(isMean(renders(smallSettings(8, 8192)), dvec3(std::exp(-depth)))) << depth;
    }
}

TEST_P(AnalyticTest, WhiteMediaAreInvisibleInAWhiteSky) {
    app::RenderSettings settings = smallSettings(8, 1024);
    settings.maxDepth = 4096;
    SceneDesc desc = emptyScene({0, 0, 4}, {0, 0, 0}, 40);
    desc.background = ConstantBackground{dvec3(1)};
    desc.objects.push_back({MediumDesc{SphereBoundary{dvec3(0), 1}, 3, dvec3(1)}});
    desc.objects.push_back({MediumDesc{BoxBoundary{dvec3(-0.5), dvec3(1.5)}, 3, dvec3(1)}});
    EXPECT_TRUE(isMean(GpuRenders(desc)(settings), dvec3(1)));
}

// Every shadow ray ends at a wall that it may graze.
TEST_P(AnalyticTest, EmittersDoNotShadowThemselves) {
    // Of long paths: a sixteenth of the nightly samples at every change.
    app::RenderSettings settings = smallSettings(16, isNightly(GetParam()) ? 4096 : 256);
    for (const char* id : {"furnace", "furnace-mixed"}) {
        const SceneDesc desc = findBuiltinScene(id);
        GpuRenders renders(desc);
        EXPECT_TRUE(isMean(renders(settings), dvec3(1))) << id;
    }
}

} // namespace
} // namespace rt::test
