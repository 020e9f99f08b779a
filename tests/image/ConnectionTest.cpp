// Connections through spheres of glass, and by reflection on smooth ones, change the noise and nothing else.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Shared/Base/Features.h"
#include "tests/ConnectedScene.h"
#include "tests/image/AnalyticScenes.h"
#include "tests/image/Harness.h"
#include "tests/image/ImageEquivalence.h"
#include "tests/unit/Statistics.h"

namespace rt::test {
namespace {

using namespace rt::scene;
using glm::dvec3;

MaterialDesc glassOf(double ior) {
    MaterialDesc glass;
    glass.kind = MaterialKind::Dielectric;
    glass.albedo = dvec3(0.9, 1, 0.8);
    glass.parameters[shared::kDielectricIor] = ior;
    return glass;
}

MaterialDesc mirrorOf(const dvec3& albedo) {
    MaterialDesc mirror;
    mirror.kind = MaterialKind::Metal;
    mirror.albedo = albedo;
    mirror.parameters[shared::kMetalFuzz] = 0;
    return mirror;
}

// Side and samples of the images, of which 32 are compared.
struct Effort {
    std::uint32_t side, spp;
};

std::vector<image::Image> images(app::Engine& engine, const CompiledScene& scene, app::RenderSettings settings,
                                 bool connected, std::uint32_t firstSeed) {
    settings.specularConnections = connected;
    return independentImages(engine, scene, settings, firstSeed);
}

// 4 standard errors, as AgreementTest.cpp; without connections the light is that of scattering alone.
void expectSameLight(const SceneDesc& desc, Effort effort, std::uint32_t maxDepth = 50) {
    const auto scene = connectedThroughAll(*app::compile(desc, true, true));
    ASSERT_FALSE(scene->specularCasters.empty()) << desc.id;
    const auto engine = cpu::makeCpuEngine({});
    engine->setScene(scene, nullptr);
    app::RenderSettings settings;
    settings.width = settings.height = effort.side;
    settings.spp = effort.spp;
    settings.maxDepth = maxDepth;
    const auto reference = images(*engine, *scene, settings, false, 100);
    EXPECT_FALSE(shared::has(engine->report().features, shared::kMethodConnections));
    for (const auto heuristic : {app::LightSampling::Mis, app::LightSampling::MisBalance}) {
        settings.lightSampling = heuristic;
        const auto result = image::testImages(
            images(*engine, *scene, settings, true, heuristic == app::LightSampling::Mis ? 1000 : 2000), reference);
        EXPECT_TRUE(shared::has(engine->report().features, shared::kMethodConnections));
        EXPECT_GT(result.globalP, 1e-4) << desc.id << ", " << result.summary();
        EXPECT_EQ(result.tileDiscoveries, 0u) << desc.id << ", " << result.summary();
    }
}

// A floor on which a sphere of glass focuses a light, both seen from above.
SceneDesc caustic(const ObjectDesc::Shape& lamp) {
    SceneDesc desc = emptyScene({0, 3, 4}, {0, 0, 0}, 40);
    desc.id = "caustic";
    desc.materials["floor"] = lambertian(0.7);
    desc.materials["glass"] = glassOf(1.5);
    desc.materials["lamp"] = lambertian(0, 30);
    desc.objects = {
        {QuadDesc{{-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, "floor"}}, {SphereDesc{{0, 1.2, 0}, 0.7, {}, "glass"}}, {lamp}};
    return desc;
}

// The sun of a sky image through a ball of glass, and on two balls of metal.
constexpr const char* kSun = RT_TEST_DATA_DIR "/scenes/sun.json";

const QuadDesc kPanel{{-0.3, 5, -0.3}, {0.6, 0, 0}, {0, 0, 0.6}, "lamp"};

// Balls of glass in instances of one prototype.
constexpr const char* kInstances = RT_TEST_DATA_DIR "/scenes/glass-instances.json";

TEST(Connection, ChangesNothingButNoise) {
    for (const char* id : {"cornell-box-lights", "rest-of-life-cornell-box-glass", "next-week-final"})
        expectSameLight(findBuiltinScene(id), {16, 16});
    expectSameLight(caustic(kPanel), {16, 64});
    expectSameLight(caustic(kPanel), {16, 64}, 5); // paths that end early
    expectSameLight(app::loadScene(kSun), {16, 64});
    expectSameLight(app::loadScene(kSun), {16, 64}, 4);
    expectSameLight(app::loadScene("many-lights:100"), {16, 64});
}

TEST(NightlyConnection, ChangesNothingButNoise) {
    for (const char* id :
         {"cornell-box-lights", "rest-of-life-cornell-box-glass", "next-week-final", "many-lights:100", kSun})
        expectSameLight(app::loadScene(id), {32, 256});
}

// Of the differences between images with connections and without, of equal seeds: the mean over each of 16 regions.
struct Differences {
    std::vector<Mean> regions;
    double largest = 0; // of a region and a seed
};

Differences differences(const char* id, std::uint32_t seeds) {
    const auto scene = connectedThroughAll(*app::compile(app::loadScene(id), true, true));
    const auto engine = cpu::makeCpuEngine({});
    engine->setScene(scene, nullptr);
    app::RenderSettings settings;
    settings.width = settings.height = 16;
    settings.spp = 4;
    constexpr std::size_t kRegions = 16;
    Differences differences;
    differences.regions.resize(kRegions);
    for (settings.seed = 0; settings.seed < seeds; ++settings.seed) {
        double sums[kRegions] = {};
        for (const bool connected : {false, true}) {
            settings.specularConnections = connected;
            const image::Image image = renderImage(*engine, *scene, settings);
            for (std::size_t i = 0; i < image.data.size(); ++i) {
                const std::size_t x = i / 3 % 16, y = i / 48;
                sums[y / 4 * 4 + x / 4] += (connected ? 1.0 : -1.0) * double(image.data[i]);
            }
        }
        for (std::size_t r = 0; r < kRegions; ++r) {
            differences.regions[r].add(sums[r]);
            differences.largest = std::max(differences.largest, std::abs(sums[r]));
        }
    }
    return differences;
}

// By 16 regions and 6 scenes fewer than one in 1500 true sets of images fail. Scattering finds some light that rarely
// that no seed may have it: a difference as large as the largest one, expected in 10 of the seeds, is in none of them
// once in 20 000 times.
void expectSameMeans(std::uint32_t seeds) {
    for (const char* id : {"cornell-box-lights", "rest-of-life-cornell-box-glass", "next-week-final", kInstances, kSun,
                           "many-lights:100"}) {
        int differing = 0;
        const Differences found = differences(id, seeds);
        for (const Mean& mean : found.regions) {
            EXPECT_LE(std::abs(mean.mean()), 4.5 * mean.standardError() + 10 * found.largest / seeds) << id;
            if (mean.variance() > 0) ++differing;
        }
        EXPECT_GT(differing, 4) << id;
    }
    for (const Mean& mean : differences("veach-mis", 3).regions)
        EXPECT_EQ(mean.variance(), 0) << "without glass nothing changes";
}

TEST(Connection, MeansOfManySeedsAreTheSame) {
    expectSameMeans(100);
}

TEST(NightlyConnection, MeansOfManySeedsAreTheSame) {
    expectSameMeans(1000);
}

TEST(Connection, ToEveryShapeOfLight) {
    expectSameLight(caustic(SphereDesc{{0.4, 4, -0.2}, 0.3, {}, "lamp"}), {16, 64});
    SceneDesc desc =
        caustic(GroupDesc{{Scale{{1, 0.2, 0.6}}, Translate{{0, 4, 0}}}, {{SphereDesc{{0, 0, 0}, 0.5, {}, "lamp"}}}});
    expectSameLight(desc, {16, 64});
}

// What connections do not cover, or only with care: moving, hollow, nested, occluded inside, around a light, in fog.
TEST(Connection, ThroughSpheresOfEveryKind) {
    SceneDesc moving = caustic(kPanel);
    moving.objects[1] = {SphereDesc{{-0.5, 1.2, 0}, 0.7, dvec3(0.5, 1.4, 0.3), "glass"}};
    expectSameLight(moving, {16, 64});
    SceneDesc hollow = caustic(kPanel);
    hollow.materials["bubble"] = glassOf(1 / 1.5);
    hollow.objects.push_back({SphereDesc{{0, 1.2, 0}, 0.6, {}, "bubble"}});
    hollow.objects.push_back({SphereDesc{{1.2, 0.8, 1}, 0.5, {}, "glass"}});
    expectSameLight(hollow, {16, 64});
    SceneDesc inside = caustic(kPanel);
    inside.objects.push_back({SphereDesc{{0.2, 1.2, 0}, 0.3, {}, "floor"}});
    inside.objects.push_back({SphereDesc{{0.9, 1.2, 0}, 0.7, {}, "glass"}});
    inside.objects.push_back({SphereDesc{{-1.5, 0.5, 0}, 0.5, {}, "glass"}});
    inside.objects.push_back({SphereDesc{{-1.5, 0.5, 0}, 0.1, {}, "lamp"}});
    expectSameLight(inside, {16, 64});
    SceneDesc fog = caustic(kPanel);
    fog.objects.push_back({MediumDesc{BoxBoundary{dvec3(-3, 0, -3), dvec3(3, 4, 3)}, 0.2, dvec3(0.9)}});
    expectSameLight(fog, {16, 64});
}

// As they are, and with the prototype so far from its origin that its instances round places by a ten-thousandth.
TEST(Connection, ThroughSpheresOfInstances) {
    SceneDesc desc = app::loadScene(kInstances);
    ASSERT_EQ(app::compile(desc, true, true)->instances.size(), 5u);
    expectSameLight(desc, {16, 64});
    const dvec3 offset(3000, -2000, 1000);
    for (ObjectDesc& object : desc.prototypes.at("ball")) {
        if (auto* sphere = std::get_if<SphereDesc>(&object.shape)) sphere->center += offset;
        if (auto* beads = std::get_if<SphereSetDesc>(&object.shape))
            for (dvec3& center : beads->centers) center += offset;
    }
    for (ObjectDesc& object : desc.objects)
        if (auto* instance = std::get_if<InstanceDesc>(&object.shape))
            instance->transform.insert(instance->transform.begin(), Translate{-offset});
    expectSameLight(desc, {16, 64});
}

// A mirror in the place of the glass: at rest; moving, beside a sphere that emits; in fog, beside glass.
TEST(Connection, ReflectedOnMirrors) {
    SceneDesc mirror = caustic(kPanel);
    mirror.materials["mirror"] = mirrorOf(dvec3(0.9, 0.8, 0.7));
    mirror.objects[1] = {SphereDesc{{0, 1.2, 0}, 0.7, {}, "mirror"}};
    expectSameLight(mirror, {16, 32});
    SceneDesc moving = mirror;
    moving.objects[1] = {SphereDesc{{-0.5, 1.2, 0}, 0.7, dvec3(0.5, 1.4, 0.3), "mirror"}};
    moving.objects[2] = {SphereDesc{{1.4, 2.2, -0.2}, 0.3, {}, "lamp"}};
    expectSameLight(moving, {16, 32});
    SceneDesc fog = mirror;
    fog.objects.push_back({SphereDesc{{1.4, 0.6, 0.7}, 0.6, {}, "glass"}});
    fog.objects.push_back({MediumDesc{BoxBoundary{dvec3(-3, 0, -3), dvec3(3, 4, 3)}, 0.2, dvec3(0.9)}});
    expectSameLight(fog, {16, 32});
}

// Mean over the pixels of the variance of 32 images, relative to their means as relMSE is.
double relativeVariance(const std::vector<image::Image>& images) {
    const std::size_t values = images.front().data.size();
    double sum = 0;
    for (std::size_t i = 0; i < values; ++i) {
        Mean mean;
        for (const image::Image& image : images) mean.add(double(image.data[i]));
        sum += mean.variance() / (mean.mean() * mean.mean() + 0.01);
    }
    return sum / double(values);
}

// What a ball of glass reflects, outside or inside, is a seventh of the light that goes on from it, and a third and
// more of the noise where refraction alone is connected to.
TEST(Connection, WhatGlassReflectsIsConnectedTo) {
    const auto scene = app::compile(findBuiltinScene("rest-of-life-cornell-box-glass"), true, true);
    ASSERT_EQ(scene->specularCasters.size(), 3u);
    auto refracting = std::make_shared<CompiledScene>(*scene);
    std::erase_if(refracting->specularCasters,
                  [](const shared::SpecularCaster& sphere) { return sphere.crossings != shared::kRefracted; });
    const auto engine = cpu::makeCpuEngine({});
    app::RenderSettings settings;
    settings.width = settings.height = 32;
    settings.spp = 32;
    const auto noise = [&](const std::shared_ptr<const CompiledScene>& of) {
        engine->setScene(of, nullptr);
        return relativeVariance(images(*engine, *of, settings, true, 1));
    };
    EXPECT_LT(noise(scene), 0.8 * noise(refracting));
}

// Walls that emit and reflect light each other, and a sphere of clear glass among them, which changes nothing.
TEST(Connection, AFurnaceStaysOne) {
    SceneDesc desc = shell(true, 0.5, 0.5);
    desc.materials["glass"].kind = MaterialKind::Dielectric;
    desc.objects.push_back({SphereDesc{{0.5, -0.4, -0.2}, 0.3, {}, "glass"}});
    app::RenderSettings settings = smallSettings(8, 2048);
    settings.maxDepth = 4096;
    settings.specularConnections = true;
    EXPECT_TRUE(isMean(render(*connectedThroughAll(*scene::compileScene(desc)), settings), dvec3(1)));
}

// Through the sphere itself a lamp of area A at distance d brings the irradiance L A / d^2: of what scattering finds of
// it a sample's relative variance is pi d^2 / A - 1, here 126, 19 and 4.
TEST(Connection, OnlyWhereScatteringIsNoisy) {
    const auto connectedSpheres = [](double side, bool isMirror) {
        const QuadDesc panel{{-side / 2, 5, -side / 2}, {side, 0, 0}, {0, 0, side}, "lamp"};
        SceneDesc desc = caustic(panel);
        if (isMirror) desc.materials["glass"] = mirrorOf(dvec3(0.9));
        return scene::compileScene(desc)->specularCasters.size();
    };
    EXPECT_EQ(connectedSpheres(0.6, false), 3u);
    EXPECT_EQ(connectedSpheres(1.5, false), 0u);
    EXPECT_EQ(connectedSpheres(0.6, true), 1u);
    EXPECT_EQ(connectedSpheres(1.5, true), 1u);
    EXPECT_EQ(connectedSpheres(3, true), 0u);
    for (const char* id : {"rest-of-life-cornell-box-glass", "cornell-box-lucy", "many-lights:200", kSun})
        EXPECT_FALSE(app::compile(app::loadScene(id), true, true)->specularCasters.empty()) << id;
    for (const char* id : {"cornell-box-lights", "next-week-final", "many-lights"})
        EXPECT_TRUE(app::compile(findBuiltinScene(id), true, true)->specularCasters.empty()) << id;
}

} // namespace
} // namespace rt::test
