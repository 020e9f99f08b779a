// Camera rays split at edges of lights: where these are found, and that nothing changes but the noise.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/LightsInSpheres.h"
#include "Common/Scene/Silhouettes.h"
#include "Common/Shared/Technique/EdgeRays.h"
#include "tests/image/AnalyticScenes.h"
#include "tests/image/Harness.h"
#include "tests/image/ImageEquivalence.h"

namespace rt::test {
namespace {

using namespace rt::scene;
using glm::dvec3;

constexpr std::uint32_t kLampSide = 48;

// A lamp alone in front of the camera, in the middle of its view.
struct Lamp {
    const char* name;
    ObjectDesc object;
    double defocusAngle = 0;
};

MeshDesc square() {
    MeshData mesh;
    mesh.positions = {{-0.8, -0.7, 0.2}, {0.9, -0.6, 0}, {0.7, 0.8, -0.1}, {-0.6, 0.7, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return {Boxed<MeshData>(mesh), "lamp"};
}

GroupDesc squashed() {
    GroupDesc group;
    group.transform.push_back(Scale{{1, 0.4, 0.7}});
    group.transform.push_back(Rotate{{0.3, 0.5, 1}, 40});
    group.objects.push_back({SphereDesc{{0, 0, 0}, 0.9, {}, "lamp"}});
    return group;
}

std::vector<Lamp> lamps() {
    const QuadDesc quad{{-0.8, -0.6, 0}, {1.5, 0.3, 0.4}, {-0.2, 1.2, -0.9}, "lamp"};
    return {{"sphere", {SphereDesc{{0.1, -0.1, 0}, 0.8, {}, "lamp"}}},
            {"small sphere", {SphereDesc{{0.1, -0.1, 0}, 0.02, {}, "lamp"}}},
            {"near sphere", {SphereDesc{{0.9, 0, 2.2}, 0.8, {}, "lamp"}}},
            {"moving sphere", {SphereDesc{{-0.6, -0.1, 0}, 0.4, dvec3(0.5, 0.3, 0.1), "lamp"}}},
            {"ellipsoid", {squashed()}},
            {"quad", {quad}},
            {"quad that reaches behind the camera", {QuadDesc{{-0.5, -0.6, -4}, {1, 0, 0}, {0, 0.3, 9}, "lamp"}}},
            {"mesh", {square()}},
            {"sphere out of focus", {SphereDesc{{0.1, -0.1, -1}, 0.8, {}, "lamp"}}, 6},
            {"quad out of focus", {quad}, 6}};
}

std::shared_ptr<const CompiledScene> compileLamp(const Lamp& lamp) {
    SceneDesc desc = emptyScene({0, 0, 3}, {0, 0, 0}, 50);
    desc.id = lamp.name;
    desc.camera.defocusAngle = lamp.defocusAngle;
    desc.camera.focusDistance = 2;
    desc.materials["lamp"] = lambertian(0.5, 1);
    desc.objects = {lamp.object};
    return app::compile(desc, false);
}

app::RenderSettings lampSettings(std::uint32_t spp) {
    app::RenderSettings settings;
    settings.width = settings.height = kLampSide;
    settings.spp = spp;
    settings.maxDepth = 1;
    return settings;
}

bool isIn(const Silhouettes& edges, std::uint32_t pixel) {
    return !edges.parts.empty() && edges.parts[pixel] != 0;
}

// What an error is worth: there is as much of it in as many rays.
struct EdgeEffort {
    double error = 0;
    std::uint64_t rays = 0;

    double inAll() const { return error * static_cast<double>(rays); }
};

double areaOf(const Silhouettes& edges, std::uint32_t pixel) {
    const shared::PixelPart part = shared::pixelPart(edges.parts[pixel]);
    return static_cast<double>(part.size.x) * static_cast<double>(part.size.y);
}

// A lamp of radiance 1 before black: what is neither is a pixel with an edge, and no more of it is covered than the
// part of it that is sampled; of the small sphere that is little else.
TEST(EdgeRays, EdgesAreWhereLightsBeginAndEnd) {
    for (const Lamp& lamp : lamps()) {
        const auto scene = compileLamp(lamp);
        const auto engine = cpu::makeCpuEngine({});
        engine->setScene(scene, nullptr);
        app::RenderSettings settings = lampSettings(256);
        settings.edgeRays = false;
        const image::Image picture = renderImage(*engine, *scene, settings);
        const Silhouettes edges = findSilhouettes(
            *scene, makeCamera(scene->camera, kLampSide, kLampSide, scene->origin), kLampSide, kLampSide);
        std::uint64_t mixed = 0, count = 0;
        double covered = 0, sampled = 0;
        for (std::uint32_t pixel = 0; pixel < kLampSide * kLampSide; ++pixel) {
            const float value = picture.data[3 * pixel];
            const bool isMixed = value > 0.0f && value < 1.0f;
            const bool isEdge = isIn(edges, pixel);
            EXPECT_TRUE(isEdge || !isMixed) << lamp.name << ": " << pixel % kLampSide << ", " << pixel / kLampSide;
            mixed += isMixed ? 1 : 0;
            count += isEdge ? 1 : 0;
            if (!isEdge) continue;
            const double area = areaOf(edges, pixel), coverage = static_cast<double>(value);
            EXPECT_GE(area + 0.04, coverage) << lamp.name << ": " << pixel; // of 256 samples
            covered += coverage;
            sampled += area;
        }
        const bool isSmall = lamp.name == std::string("small sphere");
        EXPECT_LE(sampled, isSmall ? 1.6 * covered : static_cast<double>(count)) << lamp.name;
        EXPECT_EQ(edges.count, count) << lamp.name;
        EXPECT_GT(mixed, 0u) << lamp.name;
        EXPECT_LT(count, 1.6 * static_cast<double>(mixed) + 4) << lamp.name; // corners that 256 samples missed
    }
}

TEST(EdgeRays, ThereAreNoneInScenesWithoutThem) {
    const auto edgesOf = [](const SceneDesc& desc) {
        const auto scene = app::compile(desc, true);
        return findSilhouettes(*scene, makeCamera(scene->camera, kLampSide, kLampSide, scene->origin), kLampSide,
                               kLampSide);
    };
    EXPECT_EQ(edgesOf(app::loadScene("one-weekend-final")).count, 0u); // no lights
    EXPECT_EQ(edgesOf(shell(false, 0.5, 1)).count, 0u);                // the camera is inside
    SceneDesc behind = floorScene();                                   // a lamp behind the camera
    behind.objects.push_back({SphereDesc{{0, 1, 9}, 0.5, {}, "light"}});
    EXPECT_EQ(edgesOf(behind).count, 0u);
    SceneDesc back = floorScene(); // the back of a lamp
    back.materials["light"].sides = Sides::Front;
    back.camera.verticalFov = 60;
    back.objects.push_back({QuadDesc{{-1, 0.2, 0}, {0, 1, 0}, {1, 0, 0}, "light"}});
    EXPECT_EQ(edgesOf(back).count, 0u);
}

// Of a lamp's coverage of its edge pixels: with edge rays there is less error than camera rays of that number leave.
TEST(EdgeRays, ErrorsOfEdgesFall) {
    for (const Lamp& lamp : lamps()) {
        const auto scene = compileLamp(lamp);
        const auto engine = cpu::makeCpuEngine({});
        engine->setScene(scene, nullptr);
        const image::Image truth = renderImage(*engine, *scene, lampSettings(4096));
        const auto errorOf = [&](bool edgeRays) {
            app::RenderSettings few = lampSettings(16);
            few.edgeRays = edgeRays;
            EdgeEffort effort;
            for (few.seed = 1; few.seed <= 16; ++few.seed) {
                const image::Image picture = renderImage(*engine, *scene, few);
                for (std::size_t i = 0; i < truth.data.size(); ++i)
                    effort.error +=
                        std::pow(static_cast<double>(picture.data[i]) - static_cast<double>(truth.data[i]), 2);
                effort.rays += engine->report().rays.all();
            }
            EXPECT_EQ(engine->report().rays.camera, std::uint64_t{kLampSide} * kLampSide * 16) << lamp.name;
            EXPECT_EQ(engine->report().rays.edge > 0, edgeRays) << lamp.name;
            return effort;
        };
        EXPECT_GT(errorOf(false).inAll(), errorOf(true).inAll()) << lamp.name;
    }
}

// A ball in front of the camera, and lamps behind, below and above it that it shows; `isInstance`: a larger one, moved
// and made smaller.
SceneDesc ballScene(MaterialKind kind, bool isInstance = false) {
    SceneDesc desc = emptyScene({0, 0, 3}, {0, 0, 0}, 50);
    desc.id = "ball";
    desc.materials["lamp"] = lambertian(0, 1);
    desc.materials["ball"].kind = kind;
    GroupDesc ball;
    ball.objects.push_back({SphereDesc{{0, 0, 0}, 0.9, {}, "ball"}});
    if (isInstance) {
        ball.objects = {{SphereDesc{{1, 1, 1}, 1.8, {}, "ball"}}};
        ball.transform = {Translate{{-1, -1, -1}}, Scale{{0.5, 0.5, 0.5}}};
    }
    desc.objects = {{QuadDesc{{-2, 0.2, -1.5}, {4, 0, 0}, {0, 0.4, 0}, "lamp"}},
                    {SphereDesc{{0.5, -2, -0.3}, 0.7, {}, "lamp"}},
                    {SphereDesc{{-1, 1.5, 4}, 0.8, {}, "lamp"}},
                    {ball}};
    return desc;
}

// Where samples differ, without edge rays, is where a ball shows a lamp in some directions, by some chance. Most of
// that noise is found, and few pixels without it: what edge rays leave is less than other rays of that number would
// leave.
TEST(EdgeRays, SpheresShowLights) {
    for (const SceneDesc& desc : {ballScene(MaterialKind::Metal), ballScene(MaterialKind::Dielectric),
                                  ballScene(MaterialKind::Dielectric, true)}) {
        const auto scene = app::compile(desc, false);
        const auto engine = cpu::makeCpuEngine({});
        engine->setScene(scene, nullptr);
        const auto variancesOf = [&](bool edgeRays, std::uint64_t& rays) {
            constexpr std::uint32_t kSeeds = 64;
            app::RenderSettings settings = lampSettings(1);
            settings.maxDepth = 10;
            settings.edgeRays = edgeRays;
            std::vector<double> sum(kLampSide * kLampSide), squares(kLampSide * kLampSide);
            for (settings.seed = 1; settings.seed <= kSeeds; ++settings.seed) {
                const image::Image picture = renderImage(*engine, *scene, settings);
                rays += engine->report().rays.all();
                for (std::size_t pixel = 0; pixel < sum.size(); ++pixel) {
                    const double value = picture.data[3 * pixel];
                    sum[pixel] += value;
                    squares[pixel] += value * value;
                }
            }
            for (std::size_t pixel = 0; pixel < sum.size(); ++pixel)
                squares[pixel] = (squares[pixel] - sum[pixel] * sum[pixel] / kSeeds) / (kSeeds - 1);
            return squares;
        };
        const shared::Camera camera = makeCamera(scene->camera, kLampSide, kLampSide, scene->origin);
        Silhouettes inSphere;
        inSphere.parts.resize(kLampSide * kLampSide);
        addLightsInSpheres(*scene, camera, kLampSide, kLampSide, inSphere);
        ASSERT_GT(inSphere.count, 0u);
        EdgeEffort without, with;
        const std::vector<double> before = variancesOf(false, without.rays), after = variancesOf(true, with.rays);
        for (const double variance : before) without.error += variance;
        for (const double variance : after) with.error += variance;
        EXPECT_GT(without.inAll(), with.inAll());
    }
}

// A plate of metal with some fuzz that shows small lamps.
SceneDesc plateScene(double fuzz) {
    SceneDesc desc = emptyScene({0, 0, 3}, {0, 0, 0}, 50);
    desc.id = "plate";
    desc.materials["lamp"] = lambertian(0.2, 1);
    desc.materials["plate"].kind = MaterialKind::Metal;
    desc.materials["plate"].parameters[shared::kMetalFuzz] = fuzz;
    desc.objects = {{QuadDesc{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, "plate"}},
                    {SphereDesc{{0.9, 0.8, 2.5}, 0.03, {}, "lamp"}},
                    {QuadDesc{{-1.2, 0.5, 2.4}, {0.06, 0, 0}, {0, -0.05, 0.01}, "lamp"}}};
    return desc;
}

// Spots that are about as large as pixels: less noise than other rays of that number would leave, and the light is what
// it was (4 standard errors of the mean), also where paths must end behind the plate.
TEST(EdgeRays, BlurredMirrorsShowLights) {
    for (const double fuzz : {0.002, 0.02}) {
        const auto scene = app::compile(plateScene(fuzz), false);
        const auto engine = cpu::makeCpuEngine({});
        engine->setScene(scene, nullptr);
        for (const std::uint32_t depth : {2u, 10u}) {
            constexpr std::uint32_t kSeeds = 64;
            struct Noise {
                double mean = 0, errorOfMean = 0;
                EdgeEffort effort;
            };
            const auto noiseOf = [&](bool edgeRays) {
                app::RenderSettings settings = lampSettings(16);
                settings.maxDepth = depth;
                settings.edgeRays = edgeRays;
                std::vector<double> sum(3 * kLampSide * kLampSide), squares(sum.size());
                double ofImages = 0, squaresOfImages = 0;
                Noise noise;
                for (settings.seed = 1; settings.seed <= kSeeds; ++settings.seed) {
                    const image::Image picture = renderImage(*engine, *scene, settings);
                    noise.effort.rays += engine->report().rays.all();
                    double image = 0;
                    for (std::size_t i = 0; i < sum.size(); ++i) {
                        const double value = picture.data[i];
                        image += value;
                        sum[i] += value;
                        squares[i] += value * value;
                    }
                    ofImages += image;
                    squaresOfImages += image * image;
                }
                for (std::size_t i = 0; i < sum.size(); ++i)
                    noise.effort.error += squares[i] - sum[i] * sum[i] / kSeeds;
                noise.mean = ofImages / kSeeds;
                const double variance = squaresOfImages / kSeeds - noise.mean * noise.mean;
                noise.errorOfMean = std::sqrt(variance / (kSeeds - 1));
                return noise;
            };
            const Noise before = noiseOf(false), after = noiseOf(true);
            EXPECT_LT(after.effort.inAll(), before.effort.inAll()) << fuzz << ", " << depth;
            EXPECT_NEAR(after.mean, before.mean, 4 * std::hypot(before.errorOfMean, after.errorOfMean))
                << fuzz << ", " << depth;
        }
    }
}

// 4 standard errors, as AgreementTest.cpp.
TEST(EdgeRays, ChangeNothingButNoise) {
    for (const char* id : {"cornell-box-lights", "many-lights:200", "veach-mis", "next-week-final",
                           "rest-of-life-cornell-box-glass", "furnace-mixed"}) {
        const auto scene = app::compile(app::loadScene(id), true);
        const auto engine = cpu::makeCpuEngine({});
        engine->setScene(scene, nullptr);
        const auto images = [&](bool edgeRays, std::uint32_t firstSeed) {
            app::RenderSettings settings;
            settings.width = settings.height = 16;
            settings.spp = 16;
            settings.edgeRays = edgeRays;
            return independentImages(*engine, *scene, settings, firstSeed);
        };
        const auto result = image::testImages(images(true, 100), images(false, 1000));
        EXPECT_GT(result.globalP, 1e-4) << id << ", " << result.summary();
        EXPECT_EQ(result.tileDiscoveries, 0u) << id << ", " << result.summary();
    }
}

// No more of them than a camera ray a sample, in the mean, however many lights there are, and no fewer than need be.
TEST(EdgeRays, AreFewerWhereThereAreManyEdges) {
    const auto raysOf = [](const char* id, std::uint32_t side) {
        const auto scene = app::compile(app::loadScene(id), true);
        app::RenderSettings settings = smallSettings(side, 16);
        shared::RenderParams params = app::makeRenderParams(*scene, settings);
        const shared::Camera camera = makeCamera(scene->camera, side, side, scene->origin);
        const Silhouettes edges = app::splitAtEdges(*scene, camera, settings, params);
        EXPECT_LE(params.edgeRays * edges.count, side * side) << id;
        EXPECT_EQ(edges.count == 0, params.edgeRays == 0) << id;
        const std::uint64_t twice = std::max(2 * params.edgeRays, 2u);
        const bool wouldBeTooMany = twice * findSilhouettes(*scene, camera, side, side).count > side * side;
        return std::pair(params.edgeRays, wouldBeTooMany);
    };
    const std::uint32_t few = raysOf("cornell-box-lights", 200).first;
    EXPECT_GT(few, 0u);
    const auto [rays, isLimited] = raysOf("many-lights:1000", 64);
    EXPECT_LT(rays, few);
    EXPECT_TRUE(isLimited);
    EXPECT_LT(raysOf("many-lights:20000", 64).first, few);
    EXPECT_EQ(raysOf("one-weekend-final", 64).first, 0u);
}

} // namespace
} // namespace rt::test
