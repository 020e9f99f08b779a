// Cameras of glTF as those of a scene.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/FramingCamera.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/TempFolder.h"
#include "tests/unit/GltfBuilder.h"

namespace rt::scene {
namespace {

using nlohmann::json;

class GltfCameras : public testing::Test {
  protected:
    GltfCameras() { gltf.addNode({{"mesh", gltf.addMesh(gltf.triangle())}}); }
    SceneDesc load() const { return loadGltfScene(gltf.save(folder / "a.glb")); }
    std::string notices() const {
        std::string all;
        for (const std::string& notice : scene.notices) all += notice + "\n";
        return all;
    }
    // From 0 to 1 s, two values one after the other.
    void animate(int node, const char* path, const std::vector<float>& values) {
        const json sampler = {{"input", gltf.addAccessor(std::vector<float>{0, 1}, "SCALAR")},
                              {"output", gltf.addAccessor(values, "VEC3")}};
        gltf.add("animations", {{"samplers", {sampler}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
    }
    static json lens() { return {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}; }

    test::TempFolder folder;
    GltfBuilder gltf;
    SceneDesc scene;
};

TEST_F(GltfCameras, CamerasByNameAndTheFirstIsTheView) {
    const json lens = {
        {"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}, {"aspectRatio", 1.5}}}};
    gltf.add("cameras", lens);
    gltf.addNode({{"camera", 0}, {"translation", {0, 0, 4}}});
    gltf.addNode({{"camera", 0}, {"rotation", {0, 1, 0, 0}}, {"translation", {0, 0, -4}}});
    scene = load();
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.camera, scene.cameras.at("eye"));
    EXPECT_EQ(scene.camera.lookFrom, glm::dvec3(0, 0, 4));
    EXPECT_NEAR(scene.camera.verticalFov, 180 / glm::pi<double>(), 1e-9);
    EXPECT_EQ(scene.camera.lookAt, glm::dvec3(0, 0, 0));
    EXPECT_EQ(scene.render.aspect, 1.5);
    const CameraDesc& back = scene.cameras.at("eye (2)");
    EXPECT_GT(back.lookAt.z, back.lookFrom.z);
}

// In its place perspective shows as much at the distance of the scene's middle.
TEST_F(GltfCameras, OrthographicOnes) {
    for (const double sign : {1.0, -1.0}) {
        gltf.json["cameras"] = {
            {{"type", "orthographic"},
             {"orthographic", {{"xmag", sign * 3}, {"ymag", sign * 1.5}, {"zfar", 20}, {"znear", 1}}}}};
        gltf.json["nodes"][1] = {{"camera", 0}, {"translation", {0.5, 0.5, 8}}};
        gltf.json["scenes"][0]["nodes"] = {0, 1};
        scene = load();
        EXPECT_EQ(scene.camera, scene.cameras.at("camera 0"));
        EXPECT_NEAR(8 * std::tan(glm::radians(scene.camera.verticalFov / 2)), 1.5, 1e-12);
        EXPECT_EQ(scene.camera.lookAt, glm::dvec3(0.5, 0.5, 0));
        EXPECT_EQ(scene.render.aspect, 2);
        EXPECT_NE(notices().find("camera \"camera 0\" is orthographic"), std::string::npos) << notices();
    }
    gltf.json["cameras"][0]["orthographic"]["ymag"] = 0;
    EXPECT_THROW(load(), InputError);
}

// What it looks at does not move with what an animation moves.
TEST_F(GltfCameras, OfAnAnimationKeepTheDistanceOfItsStart) {
    gltf.json["cameras"] = {
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 20}, {"znear", 1}}}}};
    gltf.addNode({{"camera", 0}, {"translation", {0, 0, 8}}});
    animate(0, "translation", {0, 0, 0, 0, 0, -100});
    const std::filesystem::path file = gltf.save(folder / "a.glb");
    EXPECT_EQ(loadGltfScene(file, {"", 1}).camera, loadGltfScene(file).camera);
}

// Of one that is scaled to nothing the view of the start is left, or nothing at all; a light is left out.
TEST_F(GltfCameras, WithoutADirectionAreLeftOutWithANotice) {
    gltf.add("cameras", lens());
    gltf.add("cameras", lens());
    gltf.json["extensionsUsed"] = {"KHR_lights_punctual"};
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}};
    const json light = {{"KHR_lights_punctual", {{"light", 0}}}};
    gltf.addNode({{"camera", 0}, {"name", "a"}, {"translation", {0, 0, 4}}, {"extensions", light}});
    gltf.addNode({{"camera", 1}, {"name", "b"}, {"scale", {0, 0, 0}}});
    animate(1, "scale", {1, 1, 1, 0, 0, 0});
    const std::filesystem::path file = gltf.save(folder / "a.glb");
    const SceneDesc start = loadGltfScene(file);
    EXPECT_EQ(start.cameras.size(), 1u);
    EXPECT_EQ(start.objects.size(), 2u);
    scene = loadGltfScene(file, {"", 1});
    EXPECT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.cameras, start.cameras);
    EXPECT_EQ(scene.camera, start.camera);
    EXPECT_NE(notices().find("camera \"a\" stays where it was at the start"), std::string::npos) << notices();
    EXPECT_NE(notices().find("camera \"b\" is left out"), std::string::npos) << notices();
    EXPECT_NE(notices().find("1 light is left out"), std::string::npos) << notices();
}

// Scaling is no part of a view: the direction is right, and the picture is not mirrored.
TEST_F(GltfCameras, OnesOfMirroredNodes) {
    gltf.add("cameras", lens());
    const double half = std::sqrt(0.5);
    const int camera = gltf.add("nodes", {{"camera", 0}, {"rotation", {0, half, 0, half}}}); // looks along -x
    const int node = gltf.addNode({{"children", {camera}}, {"translation", {0, 0, 4}}});
    scene = load();
    EXPECT_EQ(notices().find("mirrored"), std::string::npos);
    gltf.json["nodes"][static_cast<std::size_t>(node)]["scale"] = {-2, 2, 2};
    scene = load();
    EXPECT_NE(notices().find("camera \"camera 0\" is mirrored by its node"), std::string::npos) << notices();
    const glm::dvec3 view = glm::normalize(scene.camera.lookAt - scene.camera.lookFrom);
    EXPECT_LT(glm::distance(view, glm::dvec3(1, 0, 0)), 1e-12);
    EXPECT_LT(glm::distance(scene.camera.up, glm::dvec3(0, 1, 0)), 1e-12);
    EXPECT_EQ(scene.camera.lookFrom, glm::dvec3(0, 0, 4));
}

TEST(FramingCamera, IsOneThatASceneFileMayHave) {
    for (const double size : {0.0, 1e-300, 1e-12, 1e-9, 1.0, 1e9, 1e18, 1e300})
        for (const double offset : {0.0, 1e-9, 1.0, 1e6, 1e9, 1e18}) {
            Bounds bounds;
            bounds.add(glm::dvec3(offset, 0, -offset));
            bounds.add(glm::dvec3(offset + size, size, size - offset));
            SceneDesc framed;
            framed.camera = framingCamera(bounds);
            EXPECT_EQ(parseScene(toJson(framed), "a.json", {}).camera, framed.camera) << size << " at " << offset;
        }
}

TEST_F(GltfCameras, WithoutACameraAllIsInSight) {
    scene = load();
    EXPECT_TRUE(scene.cameras.empty());
    const glm::dvec3 view = glm::normalize(scene.camera.lookAt - scene.camera.lookFrom);
    const double limit = std::cos(glm::radians(scene.camera.verticalFov / 2));
    for (const glm::dvec3& corner : {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)})
        EXPECT_GT(glm::dot(glm::normalize(corner - scene.camera.lookFrom), view), limit);
}

} // namespace
} // namespace rt::scene
