// The preview by rasterisation against the ray tracer's first hits: the same surfaces at the same distances, in the
// same colours.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Shared/Base/Features.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/SceneCases.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

using image::Image;
using Scene = std::shared_ptr<const scene::CompiledScene>;

constexpr std::uint32_t kWidth = 96, kHeight = 72;

std::unique_ptr<app::Engine> makeEngine(const Scene& scene, app::GpuEngineKind kind = app::GpuEngineKind::Compute) {
    auto engine = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = kind});
    engine->setScene(scene, nullptr);
    return engine;
}

Scene fromText(const std::string& text) {
    return app::compile(scene::parseScene(text, "test.json", {}), true);
}

// First hits of the scene when the shutter opens, one ray a pixel through a pinhole.
app::AovImages firstHits(const Scene& scene, scene::CameraDesc camera, std::uint32_t width = kWidth,
                         std::uint32_t height = kHeight) {
    auto still = std::make_shared<scene::CompiledScene>(*scene);
    still->sphereMotions.clear();
    still->features &= ~shared::kFeatureMovingSpheres;
    camera.defocusAngle = 0;
    app::RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.spp = 1;
    settings.lightSampling = app::LightSampling::Bsdf; // of the paths, which are not traced, the smallest shader
    const auto engine = makeEngine(still);
    engine->reset(camera, settings);
    return engine->renderAovs({{true, true, true}}, 1);
}

struct Range {
    float low = 1e30f, high = 0;
};

// Of the values of a channel in and around a pixel.
Range rangeAround(const Image& image, std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    Range range;
    for (std::uint32_t j = y > 0 ? y - 1 : 0; j < std::min(y + 2, image.height); ++j) {
        for (std::uint32_t i = x > 0 ? x - 1 : 0; i < std::min(x + 2, image.width); ++i) {
            range.low = std::min(range.low, image.pixel(i, j)[channel]);
            range.high = std::max(range.high, image.pixel(i, j)[channel]);
        }
    }
    return range;
}

// Whether each value of `traced` in a pixel is, up to this relative margin, among those that `preview` has in the pixel
// and around it: the ray of a sample does not go through the pixel's middle.
bool agrees(const Image& preview, const Image& traced, std::uint32_t x, std::uint32_t y, float margin) {
    for (std::uint32_t channel = 0; channel < traced.channels; ++channel) {
        const auto [low, high] = rangeAround(preview, x, y, channel);
        const float value = traced.pixel(x, y)[channel];
        if (!(value >= (1 - margin) * low && value <= (1 + margin) * high)) return false;
    }
    return true;
}

// Share of the pixels with the same distance.
double depthAgreement(const Image& preview, const Image& traced) {
    std::size_t same = 0;
    for (std::uint32_t y = 0; y < preview.height; ++y) {
        for (std::uint32_t x = 0; x < preview.width; ++x) same += agrees(preview, traced, x, y, 0.001f);
    }
    return static_cast<double>(same) / (static_cast<double>(preview.width) * preview.height);
}

// Whether the values in and around a pixel differ by less than a fifth: no outline runs through it, where the mean of a
// pixel's samples has a colour that no ray finds.
bool isAwayFromOutlines(const Image& image, std::uint32_t x, std::uint32_t y) {
    for (std::uint32_t c = 0; c < image.channels; ++c) {
        const auto [low, high] = rangeAround(image, x, y, c);
        if (high > 1.2f * low) return false;
    }
    return true;
}

// The direction through the middle of a pixel.
glm::dvec3 directionOf(const Scene& scene, std::uint32_t x, std::uint32_t y) {
    const shared::Camera c = scene::makeCamera(scene->camera, kWidth, kHeight, scene->origin);
    const double u = (x + 0.5) / kWidth, v = (y + 0.5) / kHeight;
    return glm::normalize(glm::dvec3(c.corner) + glm::dvec3(c.across) * u + glm::dvec3(c.down) * v);
}

// ---- distances -----------------------------------------------------------------------------------------------------

class PreviewDepthTest : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, PreviewDepthTest,
                         ::testing::Values("cornell-box-lights", "one-weekend-final", "next-week-random-spheres",
                                           "next-week-final", "rest-of-life-cornell-box", "cube-and-spheres",
                                           "triangle-lights", "veach-mis",
                                           RT_TEST_DATA_DIR "/scenes/disks-and-cylinders.json"),
                         [](const auto& info) { return caseName(std::filesystem::path(info.param).stem().string()); });

TEST_P(PreviewDepthTest, IsTheRayTracers) {
    const Scene scene = app::compile(app::loadScene(GetParam()), true);
    scene::CameraDesc camera = scene->camera; // nearer, at an angle
    const glm::dvec3 view = camera.lookAt - camera.lookFrom;
    camera.lookFrom += 0.3 * view + 0.1 * glm::length(view) * glm::dvec3(1, 2, 1);
    camera.verticalFov = 75;
    const Image preview = makeEngine(scene)->renderPreview(camera, 61, 83).depth;
    // Along outlines the tracer's point in a pixel and its middle may see different surfaces. Of the 5063 pixels of
    // veach-mis about 155 are such, by random numbers 12 more or fewer.
    EXPECT_GE(depthAgreement(preview, firstHits(scene, camera, 61, 83).depth), 0.96);
}

// Every kind of primitive in instances that are turned, stretched and reflected; the camera is inside of the largest
// sphere, a reflected one.
constexpr const char* kInstances = R"({"version": 1,
    "camera": {"look_from": [0.5, 1, 6], "look_at": [0, 0, 0], "vertical_fov": 50},
    "background": {"type": "constant", "color": [1, 1, 1]},
    "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.25, 0.125]},
                  "n": {"type": "lambertian", "albedo": [0.2, 0.4, 0.8]}},
    "prototypes": {
        "shell": [{"type": "sphere", "center": [0, 0, 0], "radius": 30, "material": "n"}],
        "p": [
        {"type": "sphere", "center": [0, 0, 0], "radius": 0.5, "material": "m"},
        {"type": "quad", "corner": [-1, -0.6, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "material": "n"},
        {"type": "mesh", "positions": [-0.5, 0.5, 0, 0.5, 0.5, 0, 0, 1.3, 0.2], "triangles": [0, 1, 2],
         "material": "m"}]},
    "objects": [
        {"type": "instance", "prototype": "shell", "transform": [{"scale": [-1, 1.1, 1]}]},
        {"type": "instance", "prototype": "p", "transform": [{"scale": [1.2, 1, 1]}, {"translate": [-1.6, 0, 0]}]},
        {"type": "instance", "prototype": "p", "material": "n",
         "transform": [{"scale": [1, 2, 0.5]}, {"rotate": {"axis": [1, 2, 3], "degrees": 40}}, {"translate": [0, 1, -2]}]},
        {"type": "instance", "prototype": "p",
         "transform": [{"scale": [-1, 1.5, 1]}, {"rotate": {"axis": [0, 1, 0], "degrees": 30}}, {"translate": [1.6, 0, 0]}]}]})";

TEST(PreviewTest, InstancesAreWhereTheRayTracerMeetsThem) {
    const Scene scene = fromText(kInstances);
    ASSERT_EQ(scene->instances.size(), 4u);
    const app::Preview preview =
        makeEngine(scene, app::GpuEngineKind::Pipeline)->renderPreview(scene->camera, kWidth, kHeight);
    EXPECT_GE(depthAgreement(preview.depth, firstHits(scene, scene->camera).depth), 0.99);
}

// Two bands of rows, and so many primitives that they are drawn some at a time: how many is found out while the first
// image is drawn, so that the second one is put together from other pieces.
TEST(PreviewTest, APictureInPiecesIsThePicture) {
    const Scene scene = app::compile(app::loadScene("white-spheres:3000"), true);
    constexpr std::uint32_t kLargeWidth = 1300, kLargeHeight = 1000;
    const auto engine = makeEngine(scene);
    const app::Preview first = engine->renderPreview(scene->camera, kLargeWidth, kLargeHeight);
    const app::Preview second = engine->renderPreview(scene->camera, kLargeWidth, kLargeHeight);
    EXPECT_EQ(first.picture.data, second.picture.data);
    EXPECT_EQ(first.depth.data, second.depth.data);
    EXPECT_GE(depthAgreement(first.depth, firstHits(scene, scene->camera, kLargeWidth, kLargeHeight).depth), 0.97);
}

// ---- colours -------------------------------------------------------------------------------------------------------

// Under a white sky a white surface has radiance 1.05 (0.5 + 0.5 cos) with the angle that it is seen at: textures,
// instances' materials and interpolated normals all enter as in the ray tracer's albedo and normal.
TEST(PreviewTest, ColoursAreTheMaterialsTimesTheLight) {
    for (const std::string& scene : {std::string(kInstances), std::string(R"({"version": 1,
            "camera": {"look_from": [0, 1, 5], "look_at": [0, 0, 0], "vertical_fov": 40},
            "background": {"type": "constant", "color": [1, 1, 1]},
            "textures": {"squares": {"type": "checker", "scale": 1.5, "even": [0.9, 0.1, 0.1], "odd": [0.1, 0.2, 0.9]},
                         "marble": {"type": "noise", "kind": "marble", "scale": 1, "frequency": 3}},
            "materials": {"floor": {"type": "lambertian", "albedo": "squares"},
                          "ball": {"type": "lambertian", "albedo": "marble"}},
            "objects": [
                {"type": "quad", "corner": [-9, -1, 9], "edge_u": [18, 0, 0], "edge_v": [0, 0, -18], "material": "floor"},
                {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "ball"}]})")}) {
        const Scene compiled = fromText(scene);
        const app::Preview preview = makeEngine(compiled)->renderPreview(compiled->camera, kWidth, kHeight);
        const app::AovImages hits = firstHits(compiled, compiled->camera);
        Image expected(kWidth, kHeight, 3);
        for (std::uint32_t y = 0; y < kHeight; ++y) {
            for (std::uint32_t x = 0; x < kWidth; ++x) {
                const bool isSky = *hits.depth.pixel(x, y) == 0;
                const float* n = hits.normal.pixel(x, y);
                const double cosine = -glm::dot(glm::dvec3(n[0], n[1], n[2]), directionOf(compiled, x, y));
                const auto light = static_cast<float>(1.05 * (0.5 + 0.5 * cosine));
                for (int c = 0; c < 3; ++c) expected.pixel(x, y)[c] = isSky ? 1.0f : light * hits.albedo.pixel(x, y)[c];
            }
        }
        std::size_t compared = 0, same = 0;
        for (std::uint32_t y = 0; y < kHeight; ++y) {
            for (std::uint32_t x = 0; x < kWidth; ++x) {
                if (!isAwayFromOutlines(expected, x, y)) continue;
                ++compared;
                same += agrees(preview.picture, expected, x, y, 0.02f);
            }
        }
        EXPECT_GE(compared, std::size_t{kWidth} * kHeight / 2) << scene;
        EXPECT_EQ(same, compared) << scene;
    }
}

// A black ball in black fog under a white sky: what is left of the sky is the transmittance.
TEST(PreviewTest, MediaDimWhatIsBehindThem) {
    const Scene scene = fromText(R"({"version": 1,
        "camera": {"look_from": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 40},
        "background": {"type": "constant", "color": [1, 1, 1]},
        "materials": {"black": {"type": "lambertian", "albedo": [0, 0, 0]}},
        "objects": [
            {"type": "medium", "density": 0.7, "albedo": [0, 0, 0],
             "boundary": {"type": "box", "min": [-1, -1, -1], "max": [1, 1, 1]}},
            {"type": "sphere", "center": [0, 0, 0], "radius": 0.2, "material": "black"}]})");
    const app::Preview preview = makeEngine(scene)->renderPreview(scene->camera, 65, 65);
    EXPECT_NEAR(preview.picture.pixel(32, 20)[0], std::exp(-0.7 * 2), 0.02); // beside the ball, two units of fog
    EXPECT_NEAR(preview.picture.pixel(1, 1)[0], 1, 1e-6);
    EXPECT_LT(preview.picture.pixel(32, 32)[0], 1e-6f);
    // Each of a pixel's four samples is sqrt(10) / 8 of a pixel away from its middle (Vulkan's standard places).
    const double angle = std::atan(std::sqrt(10.0) / 8 * 2 * std::tan(glm::radians(20.0)) / 65);
    const double distance = 5 * std::cos(angle) - std::sqrt(0.04 - 25 * std::sin(angle) * std::sin(angle));
    EXPECT_NEAR(*preview.depth.pixel(32, 32), distance, 1e-4);
}

// No primitive: only sky and fog.
TEST(PreviewTest, NothingIsDrawnWhereThereIsNothing) {
    const Scene scene = fromText(R"({"version": 1,
        "camera": {"look_from": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 40},
        "background": {"type": "constant", "color": [0.25, 0.5, 1]},
        "objects": [{"type": "medium", "density": 1, "albedo": [0, 0, 0],
                     "boundary": {"type": "sphere", "center": [0, 0, 0], "radius": 1}}]})");
    const app::Preview preview = makeEngine(scene)->renderPreview(scene->camera, 65, 65);
    EXPECT_EQ(*std::max_element(preview.depth.data.begin(), preview.depth.data.end()), 0);
    EXPECT_NEAR(preview.picture.pixel(0, 0)[1], 0.5, 1e-6);
    EXPECT_NEAR(preview.picture.pixel(32, 32)[1], 0.5 * std::exp(-2.0), 1e-3);
}

// ---- beside the film -----------------------------------------------------------------------------------------------

class PreviewEngineTest : public ::testing::TestWithParam<app::GpuEngineKind> {};
INSTANTIATE_TEST_SUITE_P(Engines, PreviewEngineTest, kBothEngines, engineName);

TEST_P(PreviewEngineTest, LeavesTheFilmAsItIs) {
    const Scene scene = app::compile(app::loadScene("cornell-box-lights"), true);
    app::RenderSettings settings;
    settings.width = settings.height = 20;
    settings.spp = 40;
    const auto film = [&](bool withPreview) {
        const auto engine = makeEngine(scene, GetParam());
        engine->reset(scene->camera, settings);
        scene::CameraDesc other = scene->camera;
        other.lookFrom.x += 1;
        do {
            if (withPreview) engine->renderPreview(other, 33, 21);
        } while (!engine->renderSome({std::chrono::duration<double>(1e-9), nullptr}).finished);
        return engine->film().resolve().data;
    };
    EXPECT_EQ(film(true), film(false));
}

TEST_P(PreviewEngineTest, FollowsTheScene) {
    const Scene first = app::compile(app::loadScene("cornell-box-lights"), true);
    const Scene second = app::compile(app::loadScene("one-weekend-final"), true);
    const auto engine = makeEngine(first, GetParam());
    EXPECT_TRUE(engine->canPreview());
    const std::vector<float> before = engine->renderPreview(first->camera, 40, 30).picture.data;
    engine->setScene(second, nullptr);
    const std::vector<float> other = engine->renderPreview(second->camera, 40, 30).picture.data;
    EXPECT_NE(other, before);
    engine->setScene(first, nullptr);
    EXPECT_EQ(engine->renderPreview(first->camera, 40, 30).picture.data, before);
    EXPECT_THROW(engine->renderPreview(first->camera, device().limits().maxDrawnSide + 1, 1), RenderError);
}

} // namespace
} // namespace rt::test
