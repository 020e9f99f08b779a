// CPU and GPU trace the same paths: with the same seed their images agree sample for sample, until rounding makes a
// path decide differently. Every built-in scene; the validation layers watch, synchronization included.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Shared/Base/Features.h"
#include "RayTracingCPU/CpuEngine.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/ConnectedScene.h"
#include "tests/SceneCases.h"
#include "tests/cross/Device.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using image::Image;

constexpr std::uint32_t kPictureSide = 48; // pixels

std::shared_ptr<const scene::CompiledScene> smallScene(const scene::BuiltinScene& builtin) {
    return app::compile(app::loadScene(smallSceneId(builtin)), true);
}

std::shared_ptr<const scene::CompiledScene> sceneOfFile(const std::string& name) {
    return app::compile(app::loadScene(RT_TEST_DATA_DIR "/scenes/" + name + ".json"), true, true);
}

app::RenderSettings pairSettings(std::uint32_t spp) {
    app::RenderSettings settings;
    settings.width = kPictureSide;
    settings.height = kPictureSide;
    settings.spp = spp;
    return settings;
}

struct Pair {
    Image cpu;
    Image gpu;
};

class EnginePair {
  public:
    EnginePair(std::shared_ptr<const scene::CompiledScene> scene, app::GpuEngineKind engine)
        : scene_(std::move(scene)),
          cpu_(cpu::makeCpuEngine({})),
          gpu_(gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = engine})) {
        cpu_->setScene(scene_, nullptr);
        gpu_->setScene(scene_, nullptr);
    }
    Pair render(const app::RenderSettings& settings) {
        return {renderImage(*cpu_, *scene_, settings), renderImage(*gpu_, *scene_, settings)};
    }

    // Features of what was rendered last.
    std::vector<Pair> features() {
        app::AovRequest all{{true, true, true}};
        all.wide = {true, true, true};
        all.emission = true;
        app::AovImages cpu = cpu_->renderAovs(all, 4);
        app::AovImages gpu = gpu_->renderAovs(all, 4);
        app::AovRequest adaptive{{true, true, true}};
        adaptive.isAdaptive = true;
        app::AovImages cpuAdaptive = cpu_->renderAovs(adaptive, 8);
        app::AovImages gpuAdaptive = gpu_->renderAovs(adaptive, 8);
        std::vector<Pair> pairs{Pair{cpu.emission, gpu.emission}};
        const auto add = [&pairs](const app::SurfaceImages& a, const app::SurfaceImages& b) {
            pairs.insert(pairs.end(), {{a.albedo, b.albedo}, {a.normal, b.normal}, {a.depth, b.depth}});
        };
        add(cpu, gpu);
        add(cpu.wide, gpu.wide);
        add(cpuAdaptive, gpuAdaptive);
        return pairs;
    }

  private:
    std::shared_ptr<const scene::CompiledScene> scene_;
    std::unique_ptr<app::Engine> cpu_;
    std::unique_ptr<app::Engine> gpu_;
};

// Share of pixels that are within 1e-3 of each other, relatively, in all channels.
double agreement(const Pair& images) {
    std::size_t agree = 0;
    const std::size_t channels = images.cpu.channels;
    for (std::size_t i = 0; i < images.cpu.data.size(); i += channels) {
        bool same = true;
        for (std::size_t c = i; c < i + channels; ++c) {
            const float a = images.cpu.data[c];
            const float b = images.gpu.data[c];
            same = same && std::abs(a - b) <= 1e-3f * std::max(std::abs(a), std::abs(b)) + 1e-6f;
        }
        if (same) ++agree;
    }
    return static_cast<double>(agree) / (kPictureSide * kPictureSide);
}

double minAgreement(const scene::CompiledScene& scene) {
    return shared::has(scene.features, shared::kFeatureDielectric | shared::kFeatureVolumes) ? 0.98 : 0.99;
}

// The mean difference within 4 standard errors + 1e-5 of the mean: common random numbers cancel nearly all noise.
::testing::AssertionResult pairedMeansAgree(const Pair& images) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const double n = kPictureSide * kPictureSide;
        double mean = 0;
        double sum = 0;
        double squares = 0;
        for (std::size_t i = channel; i < images.cpu.data.size(); i += 3) {
            const double d = static_cast<double>(images.gpu.data[i]) - static_cast<double>(images.cpu.data[i]);
            mean += static_cast<double>(images.cpu.data[i]) / n;
            sum += d;
            squares += d * d;
        }
        const double difference = sum / n;
        const double standardError = std::sqrt(std::max(0.0, squares / n - difference * difference) / (n - 1));
        if (std::abs(difference) <= 4 * standardError + 1e-5 * mean) continue;
        return ::testing::AssertionFailure() << "channel " << channel << ": the GPU's mean is off by " << difference
                                             << " +- " << standardError << " of " << mean;
    }
    return ::testing::AssertionSuccess();
}

// Paths and features (of what is seen through glass, too) in at least this share of pixels, and the means.
void expectAgreement(EnginePair& engines, double share) {
    EXPECT_GE(agreement(engines.render(pairSettings(1))), share);
    EXPECT_TRUE(pairedMeansAgree(engines.render(pairSettings(16))));
    for (const Pair& feature : engines.features()) EXPECT_GE(agreement(feature), share);
    EXPECT_EQ(device().validationMessages(), 0u);
}

// A scene by its index, and an engine.
using SceneAndEngine = std::tuple<std::size_t, app::GpuEngineKind>;
class AgreementTest : public ::testing::TestWithParam<SceneAndEngine> {};

TEST_P(AgreementTest, SampleForSample) {
    const auto [index, engine] = GetParam();
    if (lacks(engine)) return;
    const auto scene = smallScene(scene::builtinScenes()[index]);
    EnginePair engines(scene, engine);
    expectAgreement(engines, minAgreement(*scene));
}

std::string sceneName(const ::testing::TestParamInfo<SceneAndEngine>& info) {
    const auto [index, engine] = info.param;
    return caseName(std::string(scene::builtinScenes()[index].id) + "_" + app::nameOf(app::kGpuEngines, engine));
}

const auto kEveryScene = ::testing::Range(std::size_t{0}, scene::builtinScenes().size());
template <class Condition>
std::vector<std::size_t> scenesWhoseId(const Condition& holds) {
    std::vector<std::size_t> scenes;
    for (std::size_t i = 0; i < scene::builtinScenes().size(); ++i)
        if (holds(scene::builtinScenes()[i].id)) scenes.push_back(i);
    return scenes;
}
const auto kVaried = ::testing::ValuesIn(scenesWhoseId(isVaried));
const auto kOthers = ::testing::ValuesIn(scenesWhoseId(std::not_fn(isVaried)));
INSTANTIATE_TEST_SUITE_P(Scenes, AgreementTest, ::testing::Combine(kVaried, kFirstEngine), sceneName);
INSTANTIATE_TEST_SUITE_P(NightlyScenes, AgreementTest, ::testing::Combine(kOthers, kFirstEngine), sceneName);
INSTANTIATE_TEST_SUITE_P(Nightly, AgreementTest, ::testing::Combine(kEveryScene, kSecondEngine), sceneName);

// Ray queries: spheres and quads, spheres that move, instances and media, a mesh.
std::vector<std::size_t> fewScenes() {
    const std::set<std::string> ids{"cornell-box-lights", "next-week-default", "next-week-final", "cornell-box-lucy"};
    const auto scenes = scenesWhoseId([&](std::string_view id) { return ids.count(std::string(id)) != 0; });
    EXPECT_EQ(scenes.size(), ids.size());
    return scenes;
}
const auto kQueries = ::testing::Values(app::GpuEngineKind::Query);
INSTANTIATE_TEST_SUITE_P(Queries, AgreementTest, ::testing::Combine(::testing::ValuesIn(fewScenes()), kQueries),
                         sceneName);
INSTANTIATE_TEST_SUITE_P(NightlyQueries, AgreementTest, ::testing::Combine(kEveryScene, kQueries), sceneName);

// Turned boxes, which the compute engine's lists hold whole.
TEST(CuboidAgreementTest, SampleForSample) {
    const auto scene = app::compile(app::loadScene(RT_TEST_DATA_DIR "/scenes/cuboids.json"), true);
    EnginePair engines(scene, app::GpuEngineKind::Compute);
    expectAgreement(engines, minAgreement(*scene));
}

// More features than a scene needs change nothing but rounding: code that nothing needs, arrays that are not there.
// Nightly: drivers take long over the largest shaders there are.
class SupersetTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Nightly, SupersetTest, kBothEngines, engineName);

TEST_P(SupersetTest, SampleForSample) {
    for (const char* id : {"cornell-box-lights", "furnace-mixed"}) {
        const auto scene = app::compile(app::loadScene(id), true);
        const auto engine = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = GetParam()});
        engine->setScene(scene, nullptr);
        Pair images[2]; // at 1 and at 16 samples
        for (const bool all : {false, true}) {
            for (std::size_t i = 0; i < 2; ++i) {
                app::RenderSettings settings = pairSettings(i == 0 ? 1 : 16);
                if (all) settings.features = shared::kFeatureAll;
                (all ? images[i].gpu : images[i].cpu) = renderImage(*engine, *scene, settings);
            }
        }
        EXPECT_GE(agreement(images[0]), minAgreement(*scene)) << id;
        EXPECT_TRUE(pairedMeansAgree(images[1])) << id;
    }
}

// How a light is chosen is no matter of how it is weighed, nor what samplers give one of lights: at every change each
// of these is tried with the usual ones of the others, all together with the second engine alone, nightly.
bool isTried(const app::RenderSettings& s, app::GpuEngineKind engine) {
    const bool isUsualSampling = s.lightSampling == app::LightSampling::Mis;
    const bool isUsualSelection = s.lightSelection == app::LightSelection::Contribution;
    const bool isBsdf = s.lightSampling == app::LightSampling::Bsdf; // which chooses no light
    const int unusual = !isUsualSampling + (!isUsualSelection && !isBsdf) + (s.sampler != app::SamplerKind::Sobol);
    return unusual <= 1 || isNightly(engine);
}

// Every way of sampling lights and pixels, on the default scene.
class EstimatorAgreementTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, EstimatorAgreementTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, EstimatorAgreementTest, kSecondEngine, engineName);

TEST_P(EstimatorAgreementTest, SampleForSample) {
    const auto scene = app::compile(app::loadScene("cornell-box-lights"), true);
    EnginePair engines(scene, GetParam());
    for (const app::RenderSettings& settings : allEstimators(pairSettings(1))) {
        if (!isTried(settings, GetParam())) continue;
        EXPECT_GE(agreement(engines.render(settings)), minAgreement(*scene)) << describe(settings);
    }
}

// Lights that are connected to by way of spheres of glass and mirrors: at rest, moving, among media, in instances; the
// sun of a sky image, and more lights than a table holds.
class ConnectionAgreementTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, ConnectionAgreementTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(NightlyQueries, ConnectionAgreementTest, kQueries, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, ConnectionAgreementTest, kSecondEngine, engineName);

TEST_P(ConnectionAgreementTest, SampleForSample) {
    if (lacks(GetParam())) return;
    const std::string folder = RT_TEST_DATA_DIR "/scenes/";
    const std::string files[] = {folder + "glass-instances.json", folder + "sun.json"};
    for (const std::string& id : {std::string("rest-of-life-cornell-box-glass"), std::string("many-lights:100"),
                                  std::string("next-week-final"), files[0], files[1]}) {
        // Which every built-in scene's test (above) connects by default.
        const bool isTriedByDefault = id.starts_with("rest-of-life") || id.starts_with("many-lights");
        if (isTriedByDefault && GetParam() == app::GpuEngineKind::Compute) continue;
        const auto scene = connectedThroughAll(*app::compile(app::loadScene(id), true));
        EnginePair engines(scene, GetParam());
        app::RenderSettings one = pairSettings(1), many = pairSettings(16);
        one.specularConnections = many.specularConnections = true;
        EXPECT_GE(agreement(engines.render(one)), minAgreement(*scene)) << id;
        EXPECT_TRUE(pairedMeansAgree(engines.render(many))) << id;
    }
    EXPECT_EQ(device().validationMessages(), 0u);
}

// Emissive spheres under every kind of transform.
class EllipsoidAgreementTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, EllipsoidAgreementTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, EllipsoidAgreementTest, kSecondEngine, engineName);

TEST_P(EllipsoidAgreementTest, SampleForSample) {
    const auto scene = sceneOfFile("ellipsoid-lights");
    EnginePair engines(scene, GetParam());
    for (const app::RenderSettings& settings : allEstimators(pairSettings(1))) {
        // How a point on an ellipsoid is drawn and weighed is no matter of how the ellipsoid was chosen.
        const bool isUsual = settings.lightSelection == app::LightSelection::Contribution || isNightly(GetParam());
        if (settings.sampler != app::SamplerKind::Sobol || !isUsual || !isTried(settings, GetParam())) continue;
        EXPECT_GE(agreement(engines.render(settings)), minAgreement(*scene)) << describe(settings);
    }
    EXPECT_TRUE(pairedMeansAgree(engines.render(pairSettings(16))));
    for (const app::ShapeSampling shape : {app::ShapeSampling::Area, app::ShapeSampling::Projected}) {
        app::RenderSettings settings = pairSettings(1);
        settings.sphereLight = shape;
        EXPECT_GE(agreement(engines.render(settings)), minAgreement(*scene)) << static_cast<int>(shape);
    }
    EXPECT_EQ(device().validationMessages(), 0u);
}

// Every lobe, textures of numbers, a normal map, layers.
class PrincipledAgreementTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, PrincipledAgreementTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, PrincipledAgreementTest, kSecondEngine, engineName);

TEST_P(PrincipledAgreementTest, CoatsWithNormalsOfTheirOwn) {
    const auto scene = sceneOfFile("lacquer");
    EnginePair engines(scene, GetParam());
    EXPECT_GE(agreement(engines.render(pairSettings(1))), minAgreement(*scene));
    EXPECT_EQ(device().validationMessages(), 0u);
}

// Brushed metal, thin films, leaves, glass that disperses.
TEST_P(PrincipledAgreementTest, Extensions) {
    const auto scene = sceneOfFile("gltf-extensions");
    EnginePair engines(scene, GetParam());
    constexpr double kAgreeThroughGlass = 0.98;
    expectAgreement(engines, kAgreeThroughGlass);
}

TEST_P(PrincipledAgreementTest, SampleForSample) {
    const auto scene = sceneOfFile("principled");
    EnginePair engines(scene, GetParam());
    for (const app::LightSampling estimator :
         {app::LightSampling::Mis, app::LightSampling::Mixture, app::LightSampling::Bsdf}) {
        // The one that evaluates, draws and weighs every lobe, at every change.
        if (estimator != app::LightSampling::Mis && !isNightly(GetParam())) continue;
        app::RenderSettings settings = pairSettings(1);
        settings.lightSampling = estimator;
        EXPECT_GE(agreement(engines.render(settings)), minAgreement(*scene)) << static_cast<int>(estimator);
    }
    EXPECT_TRUE(pairedMeansAgree(engines.render(pairSettings(16))));
    // Some show what is seen through glass, which one rounding makes another path, as in pictures.
    for (const Pair& feature : engines.features()) EXPECT_GE(agreement(feature), minAgreement(*scene));
    EXPECT_EQ(device().validationMessages(), 0u);
}

// Punctual lights of every kind beside a lamp, and a turned sky.
class PunctualAgreementTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, PunctualAgreementTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, PunctualAgreementTest, kSecondEngine, engineName);

TEST_P(PunctualAgreementTest, SampleForSample) {
    const auto scene = sceneOfFile("punctual-lights");
    EnginePair engines(scene, GetParam());
    for (const app::RenderSettings& settings : allEstimators(pairSettings(1))) {
        if (settings.sampler != app::SamplerKind::Sobol || !isTried(settings, GetParam())) continue;
        EXPECT_GE(agreement(engines.render(settings)), minAgreement(*scene)) << describe(settings);
    }
    EXPECT_TRUE(pairedMeansAgree(engines.render(pairSettings(16))));
    EXPECT_EQ(device().validationMessages(), 0u);
}

// The image that sun and sky are made into, a sun of three texels in it, and what it lights.
class SunSkyAgreementTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, SunSkyAgreementTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, SunSkyAgreementTest, kSecondEngine, engineName);

TEST_P(SunSkyAgreementTest, SampleForSample) {
    const auto scene = sceneOfFile("sun-sky");
    EnginePair engines(scene, GetParam());
    EXPECT_GE(agreement(engines.render(pairSettings(1))), minAgreement(*scene));
    EXPECT_TRUE(pairedMeansAgree(engines.render(pairSettings(16))));
    EXPECT_EQ(device().validationMessages(), 0u);
}

// As lights and as what they light, round and elliptic, through lists, the tree, the pipeline and queries.
class RoundAgreementTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, RoundAgreementTest, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(OtherEngines, RoundAgreementTest, kSecondEngine, engineName);
INSTANTIATE_TEST_SUITE_P(NightlyQueries, RoundAgreementTest, kQueries);

TEST_P(RoundAgreementTest, SampleForSample) {
    const auto scene = sceneOfFile("disks-and-cylinders");
    EnginePair engines(scene, GetParam());
    EXPECT_GE(agreement(engines.render(pairSettings(1))), minAgreement(*scene));
    EXPECT_TRUE(pairedMeansAgree(engines.render(pairSettings(16))));
    EXPECT_EQ(device().validationMessages(), 0u);
}

// So many that there is a tree, instanced too.
TEST_P(RoundAgreementTest, OfInstances) {
    scene::SceneDesc desc = app::loadScene(RT_TEST_DATA_DIR "/scenes/disks-and-cylinders.json");
    std::vector<scene::ObjectDesc>& stack = desc.prototypes["stack"];
    for (int i = 0; i < 40; ++i) {
        stack.push_back({scene::DiskDesc{{0, 0.05 * i, 0}, {0.1, 1, 0}, 0.3, i % 2 == 0 ? 0.2 : 0, "red"}});
        stack.push_back({scene::CylinderDesc{{0.5, 0.05 * i, 0}, {0.52, 0.05 * i + 0.03, 0}, 0.1, "steel"}});
    }
    for (const double x : {-1.0, 0.0, 1.0})
        desc.objects.push_back(
            {scene::InstanceDesc{"stack", {scene::Rotate{{1, 0, 1}, 20 * x}, scene::Translate{{x, 0.3, -1}}}, {}}});
    const auto scene = app::compile(desc, true, true);
    EnginePair engines(scene, GetParam());
    EXPECT_GE(agreement(engines.render(pairSettings(1))), minAgreement(*scene));
    EXPECT_EQ(device().validationMessages(), 0u);
}

// Lights sampled by projected solid angle take shaders of their own: without that code they would stay dark.
class ProjectedAgreementTest : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Triangles, ProjectedAgreementTest, ::testing::Values("triangle-lights"));
INSTANTIATE_TEST_SUITE_P(Nightly, ProjectedAgreementTest, ::testing::Values("cornell-box-lights"));

TEST_P(ProjectedAgreementTest, SampleForSample) {
    const auto scene = app::compile(app::loadScene(GetParam()), true);
    EnginePair engines(scene, app::GpuEngineKind::Pipeline);
    app::RenderSettings settings = pairSettings(1);
    settings.sphereLight = settings.quadLight = settings.triangleLight = app::ShapeSampling::Projected;
    EXPECT_GE(agreement(engines.render(settings)), minAgreement(*scene));
}

} // namespace
} // namespace rt::test
