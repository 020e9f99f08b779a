// Paths that neighbouring pixels share: the light stays what it is, and there is less noise.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Image/Statistics.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Shared/Base/Features.h"
#include "tests/image/AnalyticScenes.h"
#include "tests/image/Harness.h"
#include "tests/image/ImageEquivalence.h"

namespace rt::test {
namespace {

// Of the methods in use those that have to do with shared paths.
constexpr shared::uint kReuseScattered = shared::kMethodReuse.methods;
constexpr shared::uint kReuseAimed = kReuseScattered | shared::kMethodAiming.methods;

shared::uint methodsOf(const scene::CompiledScene& scene, const app::RenderSettings& settings) {
    return app::makeRenderParams(scene, settings).methods & kReuseAimed;
}

using namespace rt::scene;
using app::PathReuse;

std::shared_ptr<const CompiledScene> compiledScene(const char* id) {
    return app::compile(app::loadScene(id), true);
}

// Of the images' mean, summed over their values.
double varianceOf(const std::vector<image::Image>& images) {
    double sum = 0;
    for (std::size_t i = 0; i < images[0].data.size(); ++i) {
        std::vector<double> values;
        values.reserve(images.size());
        for (const image::Image& picture : images) values.push_back(static_cast<double>(picture.data[i]));
        sum += rt::image::estimate(values).varianceOfMean;
    }
    return sum;
}

// A bright box: every vertex receives from every other.
TEST(PathReuse, EnclosureHasItsClosedFormRadiance) {
    for (bool box : {false, true}) {
        const auto scene = compileScene(shell(box, 0.6, 0.5));
        for (app::RenderSettings settings : estimatorsInPairs(smallSettings(6, 1024))) {
            settings.pathReuse = PathReuse::On;
            for (std::uint32_t depth : {1u, 2u, 3u, 7u}) {
                settings.maxDepth = depth;
                const double truth = enclosureRadiance(0.6, 0.5, static_cast<int>(depth));
                EXPECT_TRUE(isMean(render(*scene, settings), glm::dvec3(truth)))
                    << (box ? "box, " : "sphere, ") << depth << ", " << describe(settings);
            }
        }
    }
}

// 4 standard errors, as AgreementTest.cpp. An odd size leaves groups of two pixels and of one. Glass and mirrors in
// front of first vertices, connections behind second ones, normals that are interpolated, boxes in instances, lights
// that are seen by scattering alone, numbers of samples that a plan gives.
TEST(PathReuse, ChangesNothingButNoise) {
    const auto expectSame = [](const char* id, app::RenderSettings settings) {
        const auto scene = compiledScene(id);
        const auto engine = cpu::makeCpuEngine({});
        engine->setScene(scene, nullptr);
        const auto images = [&](PathReuse reuse, std::uint32_t firstSeed) {
            settings.pathReuse = reuse;
            auto result = independentImages(*engine, *scene, settings, firstSeed);
            EXPECT_EQ(engine->report().rays.reuse > 0, reuse == PathReuse::On) << id;
            return result;
        };
        const auto result = image::testImages(images(PathReuse::On, 100), images(PathReuse::Off, 1000));
        EXPECT_GT(result.globalP, 1e-4) << id << ", " << result.summary();
        EXPECT_EQ(result.tileDiscoveries, 0u) << id << ", " << result.summary();
    };
    app::RenderSettings settings;
    settings.width = settings.height = 17;
    settings.spp = 16;
    for (const char* id : {"cornell-box-lights", "rest-of-life-cornell-box-glass", "rest-of-life-cornell-box-mirror",
                           "cornell-box-lucy", "many-lights:200", "triangle-lights"})
        expectSame(id, settings);
    settings.adaptive = true;
    settings.replicates = 2;
    settings.spp = 64;
    expectSame("cornell-box-lights", settings);
    settings.adaptive = false;
    settings.replicates = 1;
    settings.spp = 64;
    settings.lightSampling = app::LightSampling::Bsdf;
    expectSame("rest-of-life-cornell-box", settings);
}

// Less than longer renders of as many rays would leave.
TEST(PathReuse, LeavesLessNoise) {
    const auto scene = compiledScene("rest-of-life-cornell-box");
    const auto engine = cpu::makeCpuEngine({});
    engine->setScene(scene, nullptr);
    const auto noiseInAllRays = [&](PathReuse reuse) {
        app::RenderSettings settings;
        settings.width = settings.height = 48;
        settings.spp = 64;
        settings.pathReuse = reuse;
        std::vector<image::Image> images;
        std::uint64_t rays = 0;
        for (settings.seed = 1; settings.seed <= 8; ++settings.seed) {
            images.push_back(renderImage(*engine, *scene, settings));
            rays += engine->report().rays.all();
        }
        return varianceOf(images) * static_cast<double>(rays);
    };
    EXPECT_GT(noiseInAllRays(PathReuse::Off), noiseInAllRays(PathReuse::On));
}

// On the floor of a grey box, where a ball of glass in the air focuses a lamp that is too wide for connections.
SceneDesc ballInBox() {
    SceneDesc desc = emptyScene({1.3, -1.9, 1.3}, {0, -3, 0}, 50);
    desc.id = "ball";
    desc.materials["grey"] = lambertian(0.6);
    desc.materials["glass"] = scene::glass(1.5);
    desc.materials["lamp"] = lambertian(0, 10);
    desc.objects = {{BoxDesc{glm::dvec3(-3), glm::dvec3(3), "grey"}},
                    {QuadDesc{{-0.9, 2.99, -0.9}, {1.8, 0, 0}, {0, 0, 1.8}, "lamp"}},
                    {SphereDesc{{0, -1, 0}, 0.7, {}, "glass"}}};
    return desc;
}

// Paths that are shared aim at the ball, and leave less noise than longer renders of as many rays would.
TEST(PathReuse, AimsAtGlass) {
    const auto scene = compileScene(ballInBox());
    const auto engine = cpu::makeCpuEngine({});
    engine->setScene(scene, nullptr);
    app::RenderSettings settings;
    settings.width = settings.height = 32;
    settings.spp = 64;
    const auto images = [&](bool aims, std::uint32_t firstSeed, double& raysAnImage) {
        settings.specularConnections = aims;
        EXPECT_EQ(methodsOf(*scene, settings), aims ? kReuseAimed : kReuseScattered);
        auto result = independentImages(*engine, *scene, settings, firstSeed);
        raysAnImage = static_cast<double>(engine->report().rays.all());
        return result;
    };
    double aimedRays = 0, scatteredRays = 0;
    const auto aimed = images(true, 100, aimedRays), scattered = images(false, 1000, scatteredRays);
    const auto result = image::testImages(aimed, scattered);
    EXPECT_GT(result.globalP, 1e-4) << result.summary();
    EXPECT_EQ(result.tileDiscoveries, 0u) << result.summary();
    EXPECT_GT(varianceOf(scattered) * scatteredRays, varianceOf(aimed) * aimedRays);
}

// Where the light at vertices is known, to compare what comes by way of the ball with.
TEST(PathReuse, AimsWhereItKnowsTheLight) {
    const auto reuse = [](const char* id, app::RenderSettings settings) {
        return methodsOf(*compiledScene(id), settings);
    };
    app::RenderSettings settings = smallSettings(16, 16);
    EXPECT_EQ(reuse("cornell-box-lights", settings), kReuseAimed);
    EXPECT_EQ(reuse("rest-of-life-cornell-box", settings), kReuseScattered);
    settings.lightSelection = app::LightSelection::Power;
    EXPECT_EQ(reuse("cornell-box-lights", settings), kReuseScattered);
    settings = smallSettings(16, 16);
    settings.lightSampling = app::LightSampling::Bsdf;
    EXPECT_EQ(reuse("cornell-box-lights", settings), kReuseScattered);
}

// Where indirect light makes the noise. What moves, is in a medium or drawn by Shirley's mixture is never shared.
TEST(PathReuse, IsChosenWhereItGains) {
    const auto shares = [](const char* id, PathReuse reuse, app::LightSampling sampling = app::LightSampling::Mis) {
        const auto scene = compiledScene(id);
        app::RenderSettings settings = smallSettings(16, 16);
        settings.pathReuse = reuse;
        settings.lightSampling = sampling;
        const bool isShared = methodsOf(*scene, settings) != 0;
        EXPECT_EQ(shared::has(app::renderFeatures(*scene, scene->camera, settings), shared::kMethodReuse), isShared);
        return isShared;
    };
    for (const char* id : {"cornell-box-lights", "rest-of-life-cornell-box", "rest-of-life-cornell-box-glass",
                           "cornell-box-lucy", "next-week-simple-light"})
        EXPECT_TRUE(shares(id, PathReuse::Auto)) << id;
    for (const char* id : {"one-weekend-final", "veach-mis", "many-lights:200"}) {
        EXPECT_FALSE(shares(id, PathReuse::Auto)) << id;
        EXPECT_TRUE(shares(id, PathReuse::On)) << id;
    }
    for (const char* id : {"next-week-cornell-smoke", "next-week-random-spheres"})
        EXPECT_FALSE(shares(id, PathReuse::On)) << id;
    EXPECT_FALSE(shares("cornell-box-lights", PathReuse::On, app::LightSampling::Mixture));
    EXPECT_FALSE(shares("cornell-box-lights", PathReuse::Off));
}

} // namespace
} // namespace rt::test
