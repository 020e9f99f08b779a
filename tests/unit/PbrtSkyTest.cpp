// Sky images of pbrt's projections, turned and mirrored.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Compiler/SkyMaps.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Shared/Light/Sky.h"
#include "tests/unit/PbrtFolder.h"

namespace rt::scene {
namespace {

using glm::dvec3;

// The direction of a place of the square: P. Clarberg's map as he states it, from the square to the sphere.
dvec3 fromSquare(double s, double t) {
    const double u = 2 * s - 1, v = 2 * t - 1, a = std::abs(u), b = std::abs(v), d = 1 - (a + b);
    const double r = 1 - std::abs(d), phi = (r == 0 ? 1 : (b - a) / r + 1) * std::numbers::pi / 4;
    const double width = r * std::sqrt(2 - r * r);
    return {std::copysign(std::cos(phi), u) * width, std::copysign(std::sin(phi), v) * width,
            std::copysign(1 - r * r, d)};
}
dvec3 fromLatLong(double s, double t) {
    return {std::cos(2 * std::numbers::pi * s) * std::sin(std::numbers::pi * t),
            std::sin(2 * std::numbers::pi * s) * std::sin(std::numbers::pi * t), std::cos(std::numbers::pi * t)};
}

// Its colours tell directions: 0.5 + 0.5 d.
TexelData picture(std::uint32_t width, std::uint32_t height) {
    TexelData data{width, height, shared::kTexelLinearF32, {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const double s = (x + 0.5) / width, t = (y + 0.5) / height;
            const dvec3 color = 0.5 + 0.5 * (width == height ? fromSquare(s, t) : fromLatLong(s, t));
            for (int c = 0; c < 3; ++c) data.words.push_back(shared::floatBitsToUint(static_cast<float>(color[c])));
        }
    return data;
}

TEST(PbrtSky, PlacesOfEqualAreas) {
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) {
            const double s = (i + 0.5) / 40, t = (j + 0.5) / 40;
            const glm::dvec2 place = equalAreaPlace(fromSquare(s, t));
            ASSERT_NEAR(place.x, s, 1e-6);
            ASSERT_NEAR(place.y, t, 1e-6);
        }
}

// The world's direction d is toLight d in the light's space, whose image is of that.
TEST(PbrtSky, DirectionsAreThoseOfTheLightsSpace) {
    const test::PbrtFolder folder;
    folder.write("sky.hdr", "a file that exists");
    const SceneDesc scene = folder.load(
        "LookAt 0 0 0 0 0 1 0 1 0\nCamera \"perspective\"\nWorldBegin\nRotate 30 0 1 0\nRotate -90 1 0 0\n"
        "LightSource \"infinite\" \"string filename\" \"sky.hdr\" \"float scale\" 2");
    const auto& sky = std::get<ImageBackground>(scene.background);
    EXPECT_EQ(sky.projection, SkyProjection::Pbrt);
    EXPECT_EQ(sky.factor, dvec3(2));
    for (const std::uint32_t width : {256u, 512u}) {
        CompileOptions options;
        options.loadTexels = [width](const std::filesystem::path&, std::optional<std::uint32_t>) {
            return EncodedTexels(picture(width, 256));
        };
        const auto compiled = compileScene(scene, options);
        const Affine toWorld = scaling({-1, 1, 1}) * toAffine({Rotate{{1, 0, 0}, -90}, Rotate{{0, 1, 0}, 30}});
        const Affine toLight = *inverse(toWorld);
        const shared::SceneView view = shared::viewOf(*compiled, compiled->globals);
        double most = 0;
        for (int i = 0; i < 500; ++i) {
            const double z = (i + 0.5) / 250 - 1, phi = 2.4 * i, r = std::sqrt(1 - z * z); // a spiral
            const dvec3 world(r * std::cos(phi), z, r * std::sin(phi));
            const dvec3 seen(shared::skyRadiance(shared::kFeatureAll, view, shared::vec3(world)));
            most = std::max(most, glm::length(seen - 2.0 * (0.5 + 0.5 * toLight.vector(world))));
        }
        EXPECT_LT(most, 0.03) << width; // three texels
    }
}

TEST(PbrtSky, SceneFilesHaveThem) {
    const test::PbrtFolder folder;
    folder.write("sky.hdr", "a file that exists");
    const SceneDesc scene =
        folder.load("WorldBegin Rotate 30 1 1 0 LightSource \"infinite\" \"string filename\" \"sky.hdr\"");
    const std::string text = toJson(scene);
    EXPECT_TRUE(parseScene(text, "a.json", folder.path()).background == scene.background);
    std::string sheared = text;
    const std::size_t at = sheared.find("\"orientation\"");
    ASSERT_NE(at, text.npos);
    sheared.insert(sheared.find('[', at) + 1, "5, ");
    EXPECT_THROW(parseScene(sheared, "a.json", folder.path()), InputError);
}

} // namespace
} // namespace rt::scene
