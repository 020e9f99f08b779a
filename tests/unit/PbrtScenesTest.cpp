// What the scenes of tests/data/pbrt become; the head of each says what it must show.
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/unit/PbrtFolder.h"

namespace rt::scene {
namespace {

using glm::dvec3;
using test::hasNotice;
using test::materialOf;
using test::meshOf;
using test::pbrtScene;
using test::placed;
using test::shapeOf;

void expectNear(const dvec3& value, const dvec3& truth, double tolerance = 1e-9) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], truth[c], tolerance) << c;
}
double luminance(const dvec3& rgb) {
    return 0.212639 * rgb.r + 0.715169 * rgb.g + 0.072192 * rgb.b;
}
dvec3 albedoOf(const MaterialDesc& material) {
    return std::get<dvec3>(material.albedo);
}
// The front of a flat shape in the world, by what the compiler takes for it: the map of a normal.
dvec3 frontOf(const Affine& map, const dvec3& normal) {
    return glm::normalize(glm::transpose(glm::inverse(map.linear)) * normal);
}

TEST(PbrtScenes, FurnaceAndLamps) {
    const SceneDesc furnace = pbrtScene("furnace");
    EXPECT_EQ(std::get<ConstantBackground>(furnace.background).color, dvec3(1));
    EXPECT_EQ(albedoOf(materialOf<SphereDesc>(furnace, 0)), dvec3(1));
    EXPECT_NEAR(furnace.camera.verticalFov, 40, 1e-9);

    const SceneDesc ball = pbrtScene("sphere-light");
    EXPECT_EQ(materialOf<SphereDesc>(ball, 1).emission, dvec3(4));
    EXPECT_EQ(placed(ball.objects, 1).toWorld.offset, dvec3(0, 4, 0));

    const SceneDesc quads = pbrtScene("quad-light");
    for (const int i : {0, 1}) {
        const auto at = placed(quads.objects, static_cast<std::size_t>(i));
        const auto& quad = std::get<QuadDesc>(at.shape);
        expectNear(frontOf(at.toWorld, glm::cross(quad.edgeU, quad.edgeV)), {0, i == 0 ? -1 : 1, 0});
        EXPECT_EQ(quads.materials.at(quad.material).emission, dvec3(1, 2, 3));
        EXPECT_EQ(quads.materials.at(quad.material).sides, Sides::Front);
    }
}

TEST(PbrtScenes, Power) {
    const SceneDesc scene = pbrtScene("power");
    EXPECT_NEAR(std::get<PointLightDesc>(scene.objects[0].shape).intensity.x, 100 / (4 * std::numbers::pi), 1e-9);
    EXPECT_NEAR(materialOf<DiskDesc>(scene, 1).emission.x, 100 / (std::numbers::pi * std::numbers::pi), 1e-9);
    EXPECT_NEAR(materialOf<DiskDesc>(scene, 2).emission.x, 50 / (std::numbers::pi * std::numbers::pi), 1e-9);
    EXPECT_EQ(materialOf<DiskDesc>(scene, 2).sides, Sides::Both);
    EXPECT_NEAR(materialOf<MeshDesc>(scene, 3).emission.x, 200 / std::numbers::pi, 1e-9);
}

TEST(PbrtScenes, LightsWithoutExtent) {
    const auto spot = std::get<SpotLightDesc>(pbrtScene("spot").objects[0].shape);
    expectNear(spot.position, {0, 2, 0});
    expectNear(spot.direction, {0, -1, 0});
    expectNear(spot.intensity, {3, 2, 1});
    EXPECT_EQ(spot.innerAngle, 25);
    EXPECT_EQ(spot.outerAngle, 30);
    const auto distant = std::get<DirectionalLightDesc>(pbrtScene("distant").objects[0].shape);
    expectNear(distant.direction, {0, -1, 0});
    expectNear(distant.irradiance, dvec3(5));
    expectNear(std::get<ConstantBackground>(pbrtScene("skies").background).color, dvec3(2));
}

TEST(PbrtScenes, Spectra) {
    const SceneDesc scene = pbrtScene("spectra");
    const auto intensity = [&](std::size_t i) { return std::get<PointLightDesc>(scene.objects[i].shape).intensity; };
    EXPECT_NEAR(luminance(intensity(0)), 1, 1e-3);
    EXPECT_NEAR(luminance(intensity(1)), 2, 2e-3);
    expectNear(intensity(2), dvec3(1), 1e-3);
    EXPECT_NEAR(luminance(intensity(3)), 1, 1e-3);
    // A black body of 3000 K is at (0.4369, 0.4041) in CIE's diagram: Wyszecki and Stiles, Color Science.
    const double x = 0.4369, y = 0.4041;
    const dvec3 xyz(x / y, 1, (1 - x - y) / y);
    const dvec3 rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                    -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                    0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    expectNear(intensity(0), rgb, 0.03);
    expectNear(albedoOf(materialOf<SphereDesc>(scene, 4)), dvec3(0.25), 1e-6);

    const SceneDesc spaces = pbrtScene("color-spaces");
    const auto inSpace = [&](std::size_t i) { return std::get<PointLightDesc>(spaces.objects[i].shape).intensity; };
    expectNear(inSpace(0), dvec3(1), 1e-3);
    expectNear(inSpace(1), {0, 1.1329, 0}, 1e-3); // its red, -0.588, and its blue, -0.101, are cut off
    expectNear(inSpace(2), {0, 1, 0});
}

TEST(PbrtScenes, Metals) {
    const SceneDesc scene = pbrtScene("metals");
    const auto colorOf = [&](std::size_t i) { return albedoOf(materialOf<SphereDesc>(scene, i)); };
    // Beside reflectances of published tables for renderers, from other measurements: to 0.05.
    expectNear(colorOf(0), {1.00, 0.74, 0.36}, 0.05);
    expectNear(colorOf(1), {0.95, 0.64, 0.54}, 0.05);
    expectNear(colorOf(2), {0.97, 0.96, 0.95}, 0.05);
    EXPECT_EQ(colorOf(3), dvec3(0.1, 0.2, 0.3));
    expectNear(colorOf(4), {0.91, 0.92, 0.92}, 0.05);
    const auto widthOf = [&](std::size_t i) { // alpha
        return std::pow(materialOf<SphereDesc>(scene, i).principled.roughness.factor, 2);
    };
    EXPECT_EQ(materialOf<SphereDesc>(scene, 0).principled.metallic.factor, 1);
    EXPECT_NEAR(widthOf(0), 0, 1e-12);
    EXPECT_NEAR(widthOf(2), 0.25, 1e-12); // the square root of 1/16
    EXPECT_NEAR(widthOf(3), 0.25, 1e-12); // itself
    EXPECT_EQ(materialOf<SphereDesc>(scene, 4).principled.clearcoat.factor, 1);
    EXPECT_NEAR(materialOf<SphereDesc>(scene, 4).principled.clearcoatRoughness.factor, 0.1, 1e-12);
}

TEST(PbrtScenes, Glass) {
    const SceneDesc scene = pbrtScene("glass");
    const MaterialDesc& clear = materialOf<SphereDesc>(scene, 0);
    EXPECT_EQ(clear.kind, MaterialKind::Dielectric);
    EXPECT_EQ(clear.parameters[0], 1.5168);
    const MaterialDesc& thin = materialOf<DiskDesc>(scene, 1);
    EXPECT_TRUE(thin.principled.isThin);
    // 0.04 once, 0.04 + 0.96^2 0.04 (1 + 0.04^2 + ...) in all: 2 R / (1 + R).
    const double ior = thin.principled.ior, reflected = std::pow((ior - 1) / (ior + 1), 2);
    EXPECT_NEAR(reflected, 0.04 + 0.96 * 0.96 * 0.04 / (1 - 0.0016), 1e-12);
    const MaterialDesc& rough = materialOf<SphereDesc>(scene, 2);
    EXPECT_EQ(rough.principled.transmission.factor, 1);
    EXPECT_EQ(rough.principled.ior, 1.3);
    EXPECT_NEAR(rough.principled.roughness.factor, 0.5, 1e-12);
    const MaterialDesc& coated = materialOf<SphereDesc>(scene, 3);
    EXPECT_EQ(coated.kind, MaterialKind::Principled);
    EXPECT_EQ(albedoOf(coated), dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(coated.principled.ior, 1.5);
}

TEST(PbrtScenes, OtherMaterials) {
    const SceneDesc scene = pbrtScene("other-materials");
    ASSERT_EQ(scene.objects.size(), 3u); // and not the interface
    EXPECT_EQ(albedoOf(materialOf<SphereDesc>(scene, 0)), dvec3(0.9, 0.1, 0.1));
    EXPECT_EQ(albedoOf(materialOf<DiskDesc>(scene, 1)), dvec3(0.3));
    EXPECT_TRUE(hasNotice(scene, "other-materials.pbrt:9: materials of the type \"subsurface\" are diffuse") ||
                hasNotice(scene, "materials of the type \"subsurface\" are diffuse"));
    EXPECT_TRUE(hasNotice(scene, "of mixed materials"));
}

TEST(PbrtScenes, Textures) {
    const SceneDesc scene = pbrtScene("textures");
    const auto& name = std::get<std::string>(materialOf<SphereDesc>(scene, 0).albedo);
    const auto& image = std::get<ImageTexture>(scene.textures.at(name));
    EXPECT_TRUE(image.file.ends_with("tests/data/images/gradient.jpg")) << image.file;
    EXPECT_EQ(image.tint, dvec3(0.25));
    EXPECT_EQ(image.uvTransform, (std::array<double, 6>{3, 0, 0, 0, 1, 0.5}));
    EXPECT_EQ(image.wrapU, Wrap::Clamp);
    EXPECT_EQ(image.colorSpace, ColorSpace::Srgb);
    // 0.3, whose width is its square root
    EXPECT_NEAR(std::pow(materialOf<SphereDesc>(scene, 1).principled.roughness.factor, 4), 0.3, 1e-12);
    const auto& cubes = std::get<std::string>(materialOf<SphereDesc>(scene, 2).albedo);
    const auto& checker = std::get<CheckerTexture>(scene.textures.at(cubes));
    EXPECT_EQ(std::get<dvec3>(checker.even), dvec3(0, 0, 1)); // of a mirrored world
    EXPECT_EQ(checker.scale, 1);
}

TEST(PbrtScenes, Alpha) {
    const SceneDesc scene = pbrtScene("alpha");
    EXPECT_EQ(materialOf<SphereDesc>(scene, 0).principled.opacity.factor, 0.25);
    const NumberOrTexture& holes = materialOf<DiskDesc>(scene, 1).principled.opacity;
    EXPECT_EQ(holes.factor, -1); // 1 minus the image
    EXPECT_FALSE(holes.texture.empty());
}

TEST(PbrtScenes, Transforms) {
    const SceneDesc scene = pbrtScene("transforms");
    ASSERT_EQ(scene.objects.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) expectNear(placed(scene.objects, i).toWorld.offset, {-1, 2, 3});
    EXPECT_TRUE(hasNotice(scene, "motion is left out"));
    expectNear(scene.camera.lookFrom, {-1, 2, 3});
    expectNear(glm::normalize(scene.camera.lookAt - scene.camera.lookFrom), {0, 0, 1});
}

TEST(PbrtScenes, Instances) {
    const SceneDesc scene = pbrtScene("instances");
    ASSERT_EQ(scene.objects.size(), 2u);
    const auto& first = std::get<InstanceDesc>(scene.objects[0].shape);
    const auto& second = std::get<InstanceDesc>(scene.objects[1].shape);
    const Affine inside = placed(scene.prototypes.at(first.prototype), 0).toWorld;
    expectNear((toAffine(first.transform) * inside).offset, {0, 1, 0});
    expectNear((toAffine(second.transform) * inside).offset, {-3, 1, 0});
}

TEST(PbrtScenes, IncludesAndDefaults) {
    const SceneDesc scene = pbrtScene("includes");
    ASSERT_EQ(scene.objects.size(), 4u);
    EXPECT_EQ(albedoOf(materialOf<SphereDesc>(scene, 0)), dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(albedoOf(materialOf<SphereDesc>(scene, 1)), dvec3(0.5));
    EXPECT_EQ(albedoOf(materialOf<SphereDesc>(scene, 3)), dvec3(0.1, 0.2, 0.3));
    EXPECT_NEAR(scene.camera.verticalFov, 30, 1e-9);

    const SceneDesc defaults = pbrtScene("defaults");
    EXPECT_EQ(shapeOf<SphereDesc>(defaults, 0).radius, 2);
    EXPECT_EQ(shapeOf<SphereDesc>(defaults, 1).radius, 3);
    EXPECT_EQ(shapeOf<SphereDesc>(defaults, 2).radius, 1);
    EXPECT_EQ(albedoOf(materialOf<SphereDesc>(defaults, 0)), dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(albedoOf(materialOf<SphereDesc>(defaults, 2)), dvec3(0.5));
}

double areaOf(const MeshData& mesh) {
    double area = 0;
    for (const glm::uvec3& t : mesh.triangles)
        area += 0.5 * glm::length(glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                             mesh.positions[t.z] - mesh.positions[t.x]));
    return area;
}

TEST(PbrtScenes, Meshes) {
    const SceneDesc scene = pbrtScene("meshes");
    ASSERT_EQ(scene.objects.size(), 5u);
    EXPECT_EQ(meshOf(scene, 0).triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(meshOf(scene, 0).uvs[2], glm::dvec2(1, 1));
    EXPECT_EQ(meshOf(scene, 0).normals.size(), 4u);
    EXPECT_EQ(meshOf(scene, 1).triangles.size(), 2u);
    EXPECT_NEAR(areaOf(meshOf(scene, 1)), 1.5, 1e-12);
    // z = u v: its area is the integral of sqrt(1 + u^2 + v^2), 1.2807893...
    EXPECT_NEAR(areaOf(meshOf(scene, 2)), 1.2808, 5e-3);
    EXPECT_TRUE(hasNotice(scene, "patches that are not flat"));
    const MeshData& smooth = meshOf(scene, 3);
    EXPECT_EQ(smooth.triangles.size(), 8u * 16);
    for (std::size_t i = 0; i < smooth.positions.size(); ++i)
        EXPECT_GT(glm::dot(smooth.normals[i], smooth.positions[i]), 0) << i;
    // Loop's limit of a vertex of four neighbours: 1 / (n + 3 / (8 w)) each, w = 3 / 32: they cancel.
    EXPECT_NEAR(glm::length(smooth.positions[0]), 1 - 4.0 / (4 + 4), 1e-12);
    EXPECT_EQ(meshOf(scene, 4).triangles.size(), 2u);
    EXPECT_EQ(meshOf(scene, 4).uvs[1], glm::dvec2(1, 0));
}

TEST(PbrtScenes, RoundShapes) {
    const SceneDesc scene = pbrtScene("round");
    const auto disk = shapeOf<DiskDesc>(scene, 0);
    EXPECT_EQ(disk.center, dvec3(0, 0, 2));
    EXPECT_EQ(disk.normal, dvec3(0, 0, 1));
    EXPECT_EQ(disk.radius, 3);
    EXPECT_EQ(disk.innerRadius, 1);
    const auto tube = shapeOf<CylinderDesc>(scene, 1);
    EXPECT_EQ(tube.base.z, -3);
    EXPECT_EQ(tube.top.z, 1);
    EXPECT_TRUE(hasNotice(scene, "round.pbrt:5: parts of spheres are whole spheres"));
}

// Where a point is in the picture: to the right, and down, of its middle, in halves of its height.
glm::dvec2 seenAt(const SceneDesc& scene, const dvec3& point) {
    const shared::Camera camera = makeCamera(scene.camera, 100, 100, scene.camera.lookFrom);
    const dvec3 across(camera.across), down(camera.down), corner(camera.corner);
    const dvec3 axis = corner + 0.5 * (across + down), direction = point - scene.camera.lookFrom;
    const dvec3 onPlane = direction * (glm::dot(axis, axis) / glm::dot(direction, axis)) - axis;
    return {2 * glm::dot(onPlane, across) / glm::dot(across, across),
            2 * glm::dot(onPlane, down) / glm::dot(down, down)};
}

TEST(PbrtScenes, PicturesAreAsPbrtDrawsThem) {
    const SceneDesc left = pbrtScene("handedness"), right = pbrtScene("right-handed");
    const double expected = 1.5 / (5 * std::tan(std::numbers::pi / 6));
    EXPECT_NEAR(seenAt(left, placed(left.objects, 0).toWorld.offset).x, expected, 1e-5);
    EXPECT_NEAR(seenAt(right, placed(right.objects, 0).toWorld.offset).x, -expected, 1e-5);
    const SceneDesc portrait = pbrtScene("portrait");
    EXPECT_NEAR(portrait.camera.verticalFov, 2 * 180 / std::numbers::pi * std::atan(2 * std::tan(std::numbers::pi / 6)),
                1e-9);
    EXPECT_EQ(portrait.render.aspect, 0.5);
    EXPECT_EQ(portrait.camera.focusDistance, 5);
    EXPECT_NEAR(5 * std::tan(portrait.camera.defocusAngle / 2 * std::numbers::pi / 180), 0.25, 1e-12);
}

TEST(PbrtScenes, Media) {
    const SceneDesc scene = pbrtScene("media");
    const auto medium = shapeOf<MediumDesc>(scene, 0);
    EXPECT_NEAR(medium.density, 0.8, 1e-12);
    expectNear(std::get<dvec3>(medium.albedo), dvec3(0.75), 1e-12);
    EXPECT_EQ(std::get<SphereBoundary>(medium.boundary).radius, 3);
}

TEST(PbrtScenes, AllAreScenesThatAreWrittenAndRead) {
    for (const auto& entry : std::filesystem::directory_iterator(RT_TEST_DATA_DIR "/pbrt")) {
        if (entry.path().extension() != ".pbrt") continue;
        SCOPED_TRACE(entry.path().string());
        SceneDesc scene = loadPbrtScene(entry.path());
        SceneDesc again = parseScene(toJson(scene), "again.json", entry.path().parent_path());
        again.id = scene.id;
        scene.notices.clear();
        again.notices.clear();
        EXPECT_TRUE(scene == again);
    }
}

} // namespace
} // namespace rt::scene
