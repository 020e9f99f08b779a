// Assets/scenes/predecessor: where the predecessor departs from the books, so that its pictures and timings can be
// matched.
// Each file is the built-in scene of its name with the changes below.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"

namespace rt::scene {
namespace {

namespace fs = std::filesystem;

SphereDesc& sphereOf(SceneDesc& scene, const char* material) {
    for (ObjectDesc& object : scene.objects)
        if (auto* sphere = std::get_if<SphereDesc>(&object.shape); sphere && sphere->material == material)
            return *sphere;
    throw std::invalid_argument(material);
}

// Another place and colour of the large diffuse sphere, a flat sky, a square picture.
SceneDesc field(const char* id) {
    SceneDesc scene = findBuiltinScene(id);
    scene.background = ConstantBackground{{0.70, 0.80, 1.00}};
    scene.render.aspect = 1;
    sphereOf(scene, "brown").center = {0, 1, 3};
    scene.materials["brown"] = lambertian(0.5, 0.4, 0.7);
    return scene;
}

SceneDesc oneWeekendFinal() {
    return field("one-weekend-final");
}

// Half of all diffuse bounces were aimed at a sphere that does not exist.
SceneDesc nextWeekRandomSpheres() {
    SceneDesc scene = field("next-week-random-spheres");
    scene.importanceTargets.push_back({SphereBoundary{{0, 15, 0}, 2}});
    return scene;
}

// Another pattern for the ground; turbulence of the scaled point, as in earlier editions.
SceneDesc nextWeekTwoPerlinSpheres() {
    SceneDesc scene = findBuiltinScene("next-week-two-perlin-spheres");
    scene.render.aspect = 1;
    NoiseTexture camouflage, marble;
    camouflage.kind = NoiseKind::Turbulence;
    camouflage.scale = marble.scale = marble.frequency = 4;
    marble.seed = 1;
    scene.textures = {{"camouflage", camouflage}, {"marble", marble}};
    scene.materials["camouflage"] = lambertian(std::string("camouflage"));
    std::get<SphereDesc>(scene.objects[0].shape).material = "camouflage";
    return scene;
}

// Its light list: the three balls and the glass ball.
SceneDesc cornellBoxLights() {
    SceneDesc scene = findBuiltinScene("cornell-box-lights");
    for (ObjectDesc& object : scene.objects)
        if (auto* quad = std::get_if<QuadDesc>(&object.shape); quad && quad->material == "strip") quad->light = false;
    const SphereDesc& glassBall = sphereOf(scene, "glass");
    scene.importanceTargets.push_back({SphereBoundary{glassBall.center, glassBall.radius}});
    return scene;
}

struct Variant {
    const char* id;
    SceneDesc (*make)();
};

class PredecessorScenes : public testing::TestWithParam<Variant> {};

TEST_P(PredecessorScenes, FilesAreUpToDate) {
    const auto& [id, make] = GetParam();
    const std::string name = std::string(id) + ".json";
    SceneDesc expected = make();
    expected.title += " (predecessor)";
    std::ifstream in(fs::path(RT_SOURCE_DIR) / "Assets" / "scenes" / "predecessor" / name, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    if (text != toJson(expected)) {
        const fs::path wanted = fs::temp_directory_path() / name;
        std::ofstream(wanted, std::ios::binary) << toJson(expected);
        FAIL() << name << " should have the content of " << wanted;
    }
    SceneDesc loaded = parseScene(text, name, {});
    loaded.id = expected.id;
    EXPECT_EQ(loaded, expected);
    EXPECT_NO_THROW(compileScene(loaded));
}

INSTANTIATE_TEST_SUITE_P(All, PredecessorScenes,
                         testing::Values(Variant{"one-weekend-final", oneWeekendFinal},
                                         Variant{"next-week-random-spheres", nextWeekRandomSpheres},
                                         Variant{"next-week-two-perlin-spheres", nextWeekTwoPerlinSpheres},
                                         Variant{"cornell-box-lights", cornellBoxLights}),
                         [](const auto& info) {
                             std::string name = info.param.id;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(PredecessorScenesTable, OnlyTheBallsAreLights) {
    SceneDesc desc = cornellBoxLights();
    const auto scene = compileScene(desc);
    EXPECT_EQ(scene->globals.lightCount, 3u);
    EXPECT_EQ(scene->globals.targetCount, 1u);
    EXPECT_EQ(scene->quads.size(), 14u);
}

} // namespace
} // namespace rt::scene
