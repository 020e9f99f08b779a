// Pictures of the scenes of tests/data/pbrt, one a feature, against radiance that paper tells. Most have no camera, and
// no light, of their own: each picture is of one point, or of how much of it a black shape covers before a white sky.
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Scene/Pbrt/PbrtLoader.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using glm::dvec3;
using namespace scene;
constexpr double kPi = std::numbers::pi;
constexpr double kGrey = 0.5;
constexpr double kPoint = 0.02; // field of view, degrees, of a picture of a point

SceneDesc pbrtFile(const std::string& name) {
    return loadPbrtScene(RT_TEST_DATA_DIR "/pbrt/" + name + ".pbrt");
}
SceneDesc onlyObject(const std::string& name, std::size_t index) {
    SceneDesc scene = pbrtFile(name);
    scene.objects = {scene.objects.at(index)};
    return scene;
}
SceneDesc underSky(SceneDesc scene, double radiance = 1) {
    scene.background = ConstantBackground{dvec3(radiance)};
    return scene;
}
// All that is diffuse is black, so that a picture shows what is emitted and what is covered.
SceneDesc blackened(SceneDesc scene) {
    for (auto& [name, material] : scene.materials) material.albedo = dvec3(0);
    return scene;
}
SceneDesc withGreyFloor(SceneDesc scene, double y) {
    MaterialDesc grey;
    grey.albedo = dvec3(kGrey);
    scene.materials["floor"] = grey;
    scene.objects.push_back({QuadDesc{{-20, y, 20}, {40, 0, 0}, {0, 0, -40}, "floor"}});
    return scene;
}
SceneDesc withLamp(SceneDesc scene, double z) {
    MaterialDesc lamp;
    lamp.albedo = dvec3(0);
    lamp.emission = dvec3(1);
    lamp.sides = Sides::Both;
    scene.materials["lamp"] = lamp;
    scene.objects.push_back({QuadDesc{{-1, -1, z}, {2, 0, 0}, {0, 2, 0}, "lamp"}});
    return scene;
}
// In pbrt's space, whose x is mirrored in scenes that are not.
SceneDesc seenFrom(SceneDesc scene, dvec3 from, dvec3 at, double fov = kPoint) {
    from.x = -from.x, at.x = -at.x;
    scene.camera = {};
    scene.camera.lookFrom = from;
    scene.camera.lookAt = at;
    scene.camera.verticalFov = fov;
    if (from.x == at.x && from.z == at.z) scene.camera.up = {0, 0, 1};
    return scene;
}

void expectRadiance(const SceneDesc& scene, const dvec3& truth, double tolerance = 1e-4) {
    const Estimate estimate = render(scene, smallSettings(4, 64));
    EXPECT_EQ(estimate.nonfinite, 0u);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(estimate.mean[c], truth[c], 4 * estimate.standardError[c] + tolerance * (truth[c] + 0.01)) << c;
}
// Of a square of this side around `center`, seen from afar along +z, or +x.
void expectCovered(const SceneDesc& scene, const dvec3& center, double side, double area, bool alongX = false) {
    constexpr double kAway = 4000;
    const dvec3 back = alongX ? dvec3(kAway, 0, 0) : dvec3(0, 0, kAway);
    const double fov = 2 * std::atan(side / 2 / kAway) * 180 / kPi;
    const Estimate estimate =
        render(seenFrom(underSky(blackened(scene)), center - back, center, fov), smallSettings(16, 64));
    const double covered = 1 - area / (side * side);
    EXPECT_NEAR(estimate.mean.x, covered, 4 * estimate.standardError.x + 2e-3);
}

// A spot of (3, 2, 1) at a height of 2, full to 25 degrees and dark from 30 on, between them as the square of where the
// cosine is.
TEST(PbrtPictures, SpotAndDistant) {
    const SceneDesc spot = withGreyFloor(pbrtFile("spot"), 0);
    const auto cosine = [](double degrees) { return std::cos(degrees * kPi / 180); };
    for (const double angle : {0.0, 24.0, 27.5, 31.0}) {
        const double x = 2 * std::tan(angle * kPi / 180);
        const double fade = (cosine(angle) - cosine(30)) / (cosine(25) - cosine(30));
        const double share = fade <= 0 ? 0 : std::pow(std::min(fade, 1.0), 2);
        const double irradiance = std::pow(cosine(angle), 3) / 4 * share;
        expectRadiance(seenFrom(spot, {x, 1, 0}, {x, 0, 0}), dvec3(3, 2, 1) * (irradiance * kGrey / kPi), 2e-3);
    }
    expectRadiance(seenFrom(withGreyFloor(pbrtFile("distant"), 0), {0, 1, 0}, {0, 0, 0}), dvec3(5 * kGrey / kPi));
}

TEST(PbrtPictures, SidesOfQuadLights) {
    const SceneDesc quads = blackened(pbrtFile("quad-light"));
    expectRadiance(seenFrom(quads, {0.3, 0, 0.2}, {0.3, 1, 0.2}), {1, 2, 3});
    expectRadiance(seenFrom(quads, {0.3, 3, 0.2}, {0.3, 2, 0.2}), {1, 2, 3});
    expectRadiance(seenFrom(quads, {0.3, 1.5, 0.2}, {0.3, 1, 0.2}), dvec3(0));
    expectRadiance(seenFrom(quads, {0.3, 1.5, 0.2}, {0.3, 2, 0.2}), dvec3(0));
}

TEST(PbrtPictures, LightsByPower) {
    const SceneDesc power = blackened(pbrtFile("power"));
    expectRadiance(seenFrom(power, {0.5, 0.3, 3}, {0.5, 0.3, 2}), dvec3(200 / kPi));
    expectRadiance(seenFrom(power, {0.5, 0.3, 1.5}, {0.5, 0.3, 1}), dvec3(50 / (kPi * kPi)));
    expectRadiance(seenFrom(power, {0.5, 0.3, 0.5}, {0.5, 0.3, 1}), dvec3(50 / (kPi * kPi)));
    expectRadiance(seenFrom(power, {0.5, 0.3, 0.5}, {0.5, 0.3, 0}), dvec3(100 / (kPi * kPi)));
    expectRadiance(seenFrom(power, {0.5, 0.3, -1}, {0.5, 0.3, 0}), dvec3(0));
    const SceneDesc point = withGreyFloor(onlyObject("power", 0), -2);
    expectRadiance(seenFrom(point, {0, -1, 0}, {0, -2, 0}), dvec3(100 / (4 * kPi) / 4 * kGrey / kPi));
}

TEST(PbrtPictures, SkiesAddUp) {
    expectRadiance(seenFrom(pbrtFile("skies"), {0, 0, 0}, {1, 2, 3}, 90), dvec3(2));
}

// Lights in the middle of a ball that reflects a quarter: a wall shows 1/4 / pi of the intensity directly, and all that
// is reflected once more, 1 / (1 - 1/4). The lights have luminances of 1, 2, 1 and 1.
TEST(PbrtPictures, SpectraInABall) {
    const SceneDesc ball = seenFrom(pbrtFile("spectra"), {0.1, 0, 0.2}, {0.3, 0.5, 0.9}, 90);
    const Estimate estimate = render(ball, smallSettings(8, 256));
    const dvec3 weights(0.212639, 0.715169, 0.072192);
    EXPECT_NEAR(glm::dot(weights, estimate.mean), 5 / (3 * kPi), 4 * glm::dot(weights, estimate.standardError) + 2e-3);
}

// White, the green of Rec. 2020, (-0.588, 1.1329, -0.101), of which what is below 0 is cut off, and green.
TEST(PbrtPictures, ColorSpaces) {
    const SceneDesc scene = seenFrom(withGreyFloor(pbrtFile("color-spaces"), -2), {0, -1, 0}, {0, -2, 0});
    expectRadiance(scene, dvec3(1, 1 + 1.1329 + 1, 1) * (kGrey / (4 * kPi)), 1.5e-3);
}

// What is convex and diffuse shows its albedo under a sky of radiance 1, metal at normal incidence its reflectance
// there, which published tables give to 0.05.
TEST(PbrtPictures, SurfacesUnderAWhiteSky) {
    const auto front = [](const std::string& name, std::size_t index) {
        return seenFrom(underSky(onlyObject(name, index)), {0, 0, -9}, {0, 0, 0});
    };
    expectRadiance(front("defaults", 0), {0.1, 0.2, 0.3});
    expectRadiance(front("defaults", 2), dvec3(0.5));
    expectRadiance(front("includes", 0), {0.1, 0.2, 0.3});
    expectRadiance(front("includes", 1), dvec3(0.5));
    expectRadiance(front("includes", 3), {0.1, 0.2, 0.3});
    expectRadiance(front("other-materials", 0), {0.9, 0.1, 0.1});
    expectRadiance(front("other-materials", 1), dvec3(0.3));
    expectRadiance(front("metals", 0), {1.00, 0.74, 0.36}, 0.05);
    expectRadiance(front("metals", 1), {0.95, 0.64, 0.54}, 0.05);
}

// A lamp straight behind glass: what is reflected back and forth leaves (1 - R) / (1 + R) through two surfaces.
TEST(PbrtPictures, StraightThroughGlass) {
    const auto through = [](double ior) {
        const double reflected = std::pow((ior - 1) / (ior + 1), 2);
        return dvec3((1 - reflected) / (1 + reflected));
    };
    const auto lit = [](std::size_t index) {
        return seenFrom(withLamp(onlyObject("glass", index), 3), {0, 0, -3}, {0, 0, 0});
    };
    expectRadiance(lit(0), through(1.5168), 1e-3);
    expectRadiance(lit(1), through(1.5), 1e-3);
}

// Blue and red by the sum of the floors of a point's coordinates, odd or even.
TEST(PbrtPictures, CubesOfAChecker) {
    for (const double x : {-0.4, 0.4}) {
        for (const double z : {-5.0, 5.0}) {
            const bool even = (x > 0) == (z > 0);
            const SceneDesc scene = underSky(onlyObject("textures", 2));
            expectRadiance(seenFrom(scene, {x, 0.5, z}, {x, 0.5, 0}), even ? dvec3(1, 0, 0) : dvec3(0, 0, 1));
        }
    }
}

// Of a black ball of opacity 1/4 two walls are in the way.
TEST(PbrtPictures, AlphaLetsThrough) {
    expectRadiance(seenFrom(underSky(blackened(onlyObject("alpha", 0))), {0, 0, -5}, {0, 0, 0}), dvec3(9.0 / 16));
}

TEST(PbrtPictures, TransformsAndInstances) {
    for (std::size_t i = 0; i < 5; ++i) expectCovered(onlyObject("transforms", i), {1, 2, 3}, 2, kPi / 4);
    const SceneDesc balls = pbrtFile("instances");
    expectCovered(balls, {0, 1, 0}, 2, kPi / 4);
    expectCovered(balls, {3, 1, 0}, 2, kPi / 4);
    expectCovered(balls, {-3, 1, 0}, 2, 0);
}

TEST(PbrtPictures, ShapesCoverWhatTheyShould) {
    expectCovered(onlyObject("meshes", 0), {0.5, 0.5, 0}, 2, 1);
    expectCovered(onlyObject("meshes", 1), {1, 0.5, 0}, 3, 1.5);
    expectCovered(onlyObject("meshes", 2), {0.5, 0.5, 0}, 2, 1);
    expectCovered(onlyObject("meshes", 4), {0.5, 0.5, 0}, 2, 1);
    expectCovered(onlyObject("round", 0), {0, 0, 2}, 8, 8 * kPi);
    expectCovered(onlyObject("round", 1), {0, 0, -1}, 8, 16, true);
    expectCovered(onlyObject("round", 2), {0, 0, 0}, 3, kPi);
}

// By the cameras of the scenes: the black ball is to the right, or to the left, of the middle.
TEST(PbrtPictures, TheBallIsOnItsSide) {
    for (const bool right : {true, false}) {
        const SceneDesc scene = underSky(blackened(pbrtFile(right ? "handedness" : "right-handed")));
        const Estimate estimate = render(scene, smallSettings(16, 32));
        // At 1.5 / (5 tan 30) of the half width: column 12.
        EXPECT_EQ(estimate.image.pixel(right ? 12 : 3, 8)[0], 0);
        EXPECT_NEAR(static_cast<double>(estimate.image.pixel(right ? 3 : 12, 8)[0]), 1, 1e-6);
    }
}

// A black half plane whose edge is in the middle: sharp at 5, where the lens is focused. At 10 the lens spreads it by
// 0.25, of which the mean beyond the edge is 2 / (3 pi): that part of a pixel's width, 20 tan 30 / 8, is covered.
TEST(PbrtPictures, ALensIsFocused) {
    for (const double distance : {5.0, 10.0}) {
        SceneDesc scene = underSky(pbrtFile("portrait"));
        MaterialDesc black;
        black.albedo = dvec3(0);
        scene.materials["black"] = black;
        scene.objects.push_back({QuadDesc{{0, -50, distance - 5}, {-50, 0, 0}, {0, 100, 0}, "black"}});
        app::RenderSettings settings = smallSettings(8, 256);
        settings.height = 16;
        const Estimate estimate = render(scene, settings);
        const double spread = distance == 5 ? 0 : 0.25 * 2 / (3 * kPi) / (20 * std::tan(kPi / 6) / 8);
        double left = 0, right = 0;
        for (std::uint32_t y = 0; y < 16; ++y) {
            left += static_cast<double>(estimate.image.pixel(3, y)[0]) / 16;
            right += static_cast<double>(estimate.image.pixel(4, y)[0]) / 16;
        }
        EXPECT_NEAR(left, 1 - spread, 3e-3) << distance;
        EXPECT_NEAR(right, spread, 3e-3) << distance;
    }
}

// Smoke of extinction 0.8, were it black, lets exp(-0.8 t) through along a chord t; were it white, it would not be
// seen.
TEST(PbrtPictures, SmokeInABall) {
    for (const double albedo : {0.0, 1.0}) {
        SceneDesc scene = underSky(pbrtFile("media"));
        const auto of = [&](ObjectDesc& object) { std::get<MediumDesc>(object.shape).albedo = dvec3(albedo); };
        of(std::get<GroupDesc>(scene.objects.at(0).shape).objects.at(0));
        for (const double y : {0.0, 2.9}) {
            const double chord = 2 * std::sqrt(9 - y * y);
            expectRadiance(seenFrom(scene, {0, y, -9}, {0, y, 0}), dvec3(albedo == 1 ? 1 : std::exp(-0.8 * chord)));
        }
    }
}

} // namespace
} // namespace rt::test
