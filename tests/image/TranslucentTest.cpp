// Surfaces that transmit light into all directions, and glass that disperses: pictures of known answer.
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

} // namespace
} // namespace rt::test
