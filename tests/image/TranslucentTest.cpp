// Surfaces that transmit light into all directions, and glass that disperses: pictures of known answer.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using namespace rt::scene;

const glm::dvec3 kLeafColor{1, 0.5, 0.25};
constexpr double kLeafShare = 0.6;
constexpr double kLeafAlbedo = 0.3;

// A square seen from +z, in so small a part that it is the same all over.
SceneDesc leaf(bool isOpaque) {
    SceneDesc desc;
    MaterialDesc material;
    material.kind = MaterialKind::Principled;
    material.albedo = glm::dvec3(kLeafAlbedo);
    material.principled.specular.factor = 0;
    material.principled.diffuseTransmission.factor = isOpaque ? 0 : kLeafShare;
    material.principled.diffuseTransmissionColor = kLeafColor;
    desc.materials["leaf"] = material;
    QuadDesc quad;
    quad.corner = {-2, -2, 0};
    quad.edgeU = {4, 0, 0};
    quad.edgeV = {0, 4, 0};
    quad.material = "leaf";
    desc.objects.push_back({quad});
    desc.camera.lookFrom = {0, 0, 5};
    desc.camera.lookAt = {0, 0, 0};
    desc.camera.verticalFov = 0.02;
    desc.background = ConstantBackground{};
    return desc;
}

TEST(Translucent, SkyShinesThroughAndIsReflected) {
    SceneDesc desc = leaf(false);
    desc.background = ConstantBackground{glm::dvec3(1)};
    const glm::dvec3 truth = kLeafColor * kLeafShare + glm::dvec3(kLeafAlbedo * (1 - kLeafShare));
    const auto scene = compileScene(desc);
    for (const app::RenderSettings& settings : allEstimators(smallSettings(4, 256)))
        EXPECT_TRUE(isMean(render(*scene, settings), truth)) << describe(settings);
}

// Which no ray finds: lights beyond the surface are sampled as those before it.
TEST(Translucent, PointLightsShineThrough) {
    SceneDesc desc = leaf(false);
    desc.objects.push_back({PointLightDesc{{0, 0, -2}, glm::dvec3(7)}});
    const glm::dvec3 truth = kLeafColor * (kLeafShare * 7 / 4 / std::numbers::pi);
    const auto scene = compileScene(desc);
    for (const app::RenderSettings& settings : allEstimators(smallSettings(4, 256)))
        EXPECT_TRUE(isMean(render(*scene, settings), truth)) << describe(settings);
    desc = leaf(true);
    desc.objects.push_back({PointLightDesc{{0, 0, -2}, glm::dvec3(7)}});
    EXPECT_TRUE(isMean(render(desc, smallSettings(4, 16)), glm::dvec3(0)));
}

// A lamp behind it, as by its form factor: a square of side 2 at distance 2, from the point below its middle.
TEST(Translucent, LampsShineThrough) {
    SceneDesc desc = leaf(false);
    MaterialDesc lamp;
    lamp.kind = MaterialKind::Emitter;
    lamp.emission = glm::dvec3(3);
    lamp.sides = Sides::Both;
    desc.materials["lamp"] = lamp;
    QuadDesc quad;
    quad.corner = {-1, -1, -2};
    quad.edgeU = {2, 0, 0};
    quad.edgeV = {0, 2, 0};
    quad.material = "lamp";
    desc.objects.push_back({quad});
    const double a = 0.5; // half a side over the distance
    const double quarter = a / std::sqrt(1 + a * a) * std::atan(a / std::sqrt(1 + a * a)) / std::numbers::pi;
    const glm::dvec3 truth = kLeafColor * (kLeafShare * 3 * 4 * quarter);
    const auto scene = compileScene(desc);
    for (const app::RenderSettings& settings : allEstimators(smallSettings(4, 256)))
        EXPECT_TRUE(isMean(render(*scene, settings), truth)) << describe(settings);
}

// A ball of glass before a sky that is brighter above, so that it matters where light is bent to.
SceneDesc ball(double ior, double dispersion, double roughness) {
    SceneDesc desc;
    MaterialDesc glass;
    glass.kind = MaterialKind::Principled;
    glass.principled.transmission.factor = 1;
    glass.principled.roughness.factor = roughness;
    glass.principled.ior = ior;
    glass.principled.dispersion = dispersion;
    desc.materials["glass"] = glass;
    SphereDesc sphere;
    sphere.material = "glass";
    desc.objects.push_back({sphere});
    desc.camera.lookFrom = {0, 0.4, 2.5};
    desc.camera.lookAt = {0, 0.5, 0};
    desc.camera.verticalFov = 25;
    GradientBackground sky;
    sky.bottom = {0, 0, 0};
    sky.top = {1, 1, 1};
    desc.background = sky;
    return desc;
}

// Each channel is that of glass which has its index for all, by Cauchy's equation with the numbers of the extension.
TEST(Dispersion, ChannelsAreThoseOfTheirOwnIndices) {
    constexpr double kIor = 1.5, kDispersion = 20; // far beyond any glass, to be seen above the noise
    const std::array<double, 3> wavelengths = {656.3, 587.6, 486.1};
    for (const double roughness : {0.0, 0.4}) {
        const app::RenderSettings settings = smallSettings(8, 2048);
        const Estimate all = render(ball(kIor, kDispersion, roughness), settings);
        double spread = 0;
        for (int c = 0; c < 3; ++c) {
            const double wavelength = wavelengths[static_cast<std::size_t>(c)];
            const double ior = kIor + (kIor - 1) * kDispersion / 20 * (523655 / (wavelength * wavelength) - 1.5168);
            const Estimate one = render(ball(ior, 0, roughness), settings);
            const double noise = std::hypot(all.standardError[c], one.standardError[c]);
            EXPECT_NEAR(all.mean[c], one.mean[c], 4 * noise + 1e-4) << c << ", roughness " << roughness;
            spread = std::max(spread, std::abs(one.mean[c] - all.mean[1]) / noise);
        }
        EXPECT_GT(spread, 5) << roughness; // of standard errors: the channels differ
    }
}

} // namespace
} // namespace rt::test
