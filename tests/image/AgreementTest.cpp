// Scattering only, Shirley's mixture and next-event estimation have one expectation in every built-in scene.
#include <string>
#include <vector>

#include "Common/App/Session/SceneSource.h"
#include "Common/Render/Names.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "tests/SceneCases.h"
#include "tests/image/Harness.h"
#include "tests/image/ImageEquivalence.h"

namespace rt::test {
namespace {

constexpr std::uint32_t kSide = 24;
constexpr std::uint32_t kSpp = 16;

class Agreement : public ::testing::TestWithParam<std::string> {};

// Bias that this can see: 4 standard errors of the difference, stated on failure. A tile that is 5 % off, a missing
// weight or a light that one estimator does not know are discoveries. Seeds are fixed; with 81 comparisons of two
// chances each a clean build would fail once in some sixty changes of the random numbers.
void expectAgreement(const scene::SceneDesc& desc) {
    const auto scene = app::compile(desc, true, true);
    const auto engine = cpu::makeCpuEngine({});
    engine->setScene(scene, nullptr);
    const auto reference = independentImages(*engine, *scene, app::LightSampling::Mis, kSide, kSpp, 3000);
    std::uint32_t seed = 10000;
    for (auto sampling : {app::LightSampling::Bsdf, app::LightSampling::Mixture, app::LightSampling::MisBalance}) {
        const auto result =
            image::testImages(independentImages(*engine, *scene, sampling, kSide, kSpp, seed), reference);
        const std::string what = app::nameOf(app::kLightSamplings, sampling) + ", ";
        EXPECT_GT(result.globalP, 1e-4) << what << result.summary();
        EXPECT_EQ(result.tileDiscoveries, 0u) << what << result.summary();
        seed += 1000;
    }
}

TEST_P(Agreement, OfAllWaysToSampleLights) {
    expectAgreement(scene::findBuiltinScene(GetParam()));
}

// Spheres scaled unequally, sheared, mirrored, instanced, textured; and so many of them that a tree chooses.
TEST(EllipsoidLights, AreTheSameForAllWaysToSampleLights) {
    scene::SceneDesc desc = app::loadScene(RT_TEST_DATA_DIR "/scenes/ellipsoid-lights.json");
    expectAgreement(desc);
    scene::SphereSetDesc row;
    for (int i = 0; i < 40; ++i) row.centers.emplace_back(i - 20, 1 + i % 3, 2 - i % 5);
    row.radius = 0.3;
    row.material = "lamp";
    scene::GroupDesc group;
    group.transform = {scene::Rotate{{0, 0, 1}, 5}, scene::Scale{{0.4, 1, 0.7}}};
    group.objects.push_back({row});
    desc.objects.push_back({group});
    expectAgreement(desc);
}

// As lights and as what they light: with a hole, open, elliptic, slanted.
TEST(DisksAndCylinders, AreTheSameForAllWaysToSampleLights) {
    expectAgreement(app::loadScene(RT_TEST_DATA_DIR "/scenes/disks-and-cylinders.json"));
}

TEST(Principled, IsTheSameForAllWaysToSampleLights) {
    expectAgreement(app::loadScene(RT_TEST_DATA_DIR "/scenes/principled.json"));
}

// Brushed metal, thin films, glass that disperses, and leaves, beyond which lights count once as well.
TEST(Principled, ExtensionsAreTheSameForAllWaysToSampleLights) {
    expectAgreement(app::loadScene(RT_TEST_DATA_DIR "/scenes/gltf-extensions.json"));
}

// Coats reflect to where the surface below them does not, and lights there count once.
TEST(NightlyCoatNormals, AreTheSameForAllWaysToSampleLights) {
    expectAgreement(app::loadScene(RT_TEST_DATA_DIR "/scenes/lacquer.json"));
}

// Beside a lamp and a turned sky, by scattering over several vertices.
TEST(PunctualLights, AreTheSameForAllWaysToSampleLights) {
    expectAgreement(app::loadScene(RT_TEST_DATA_DIR "/scenes/punctual-lights.json"));
}

std::vector<std::string> sceneIds(bool areVaried) {
    std::vector<std::string> ids;
    for (const scene::BuiltinScene& builtin : scene::builtinScenes())
        if (isVaried(builtin.id) == areVaried) ids.push_back(smallSceneId(builtin));
    return ids;
}

std::string sceneName(const ::testing::TestParamInfo<std::string>& info) {
    return caseName(info.param);
}
INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, ::testing::ValuesIn(sceneIds(true)), sceneName);
INSTANTIATE_TEST_SUITE_P(Nightly, Agreement, ::testing::ValuesIn(sceneIds(false)), sceneName);

} // namespace
} // namespace rt::test
