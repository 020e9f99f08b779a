// glTF: animations at any time, against values computed by hand.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "tests/TempFolder.h"
#include "tests/unit/GltfBuilder.h"

namespace rt::scene {
namespace {

using nlohmann::json;

const double kRootHalf = std::sqrt(0.5);

class GltfAnimation : public testing::Test {
  protected:
    SceneDesc load(double time, const std::string& animation = "") const {
        return loadGltfScene(gltf.save(folder / "a.glb"), {animation, time});
    }
    int floats(const std::vector<float>& values, const char* type) { return gltf.addAccessor(values, type); }
    json sampler(const std::vector<float>& times, const std::vector<float>& values, const char* type,
                 const char* interpolation = "LINEAR") {
        return {{"input", floats(times, "SCALAR")}, {"output", floats(values, type)}, {"interpolation", interpolation}};
    }
    // An animation of one channel.
    void animate(int node, const char* path, const json& by, const std::string& name = "") {
        json animation = {{"samplers", {by}},
                          {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}};
        if (!name.empty()) animation["name"] = name;
        gltf.add("animations", animation);
    }
    int addTriangle() { return gltf.addNode({{"mesh", gltf.addMesh(gltf.triangle())}}); }

    // Where the only object puts a point.
    static glm::dvec3 placed(const SceneDesc& scene, const glm::dvec3& point) {
        const auto* group = std::get_if<GroupDesc>(&scene.objects.at(0).shape);
        if (group == nullptr) return point;
        const auto& m = std::get<Matrix>(group->transform.at(0)).rows;
        glm::dvec3 result;
        for (int row = 0; row < 3; ++row) {
            const auto r = static_cast<std::size_t>(4 * row);
            result[row] = m[r] * point.x + m[r + 1] * point.y + m[r + 2] * point.z + m[r + 3];
        }
        return result;
    }
    static const MeshData& meshOf(const SceneDesc& scene) {
        return *std::get<Boxed<MeshData>>(std::get<MeshDesc>(scene.objects.at(0).shape).source);
    }
    // A triangle whose two morph targets move the first vertex by 2 along x and the second by 4 along y.
    int addMorphed() {
        json primitive = gltf.triangle();
        primitive["targets"] = {{{"POSITION", floats({2, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3")}},
                                {{"POSITION", floats({0, 0, 0, 0, 4, 0, 0, 0, 0}, "VEC3")}}};
        return gltf.addNode({{"mesh", gltf.addMesh(primitive)}});
    }
    std::string usageError(double time, const std::string& animation) const {
        try {
            load(time, animation);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "no such error";
    }
    std::string inputError(double time) const {
        try {
            load(time);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no such error";
    }
    static void expectNear(const glm::dvec3& a, const glm::dvec3& b, double error = 1e-7) {
        EXPECT_LT(glm::distance(a, b), error) << a.x << " " << a.y << " " << a.z;
    }

    test::TempFolder folder;
    GltfBuilder gltf;
};

TEST_F(GltfAnimation, LinearTranslationAndScale) {
    const int node = addTriangle();
    animate(node, "translation", sampler({1, 2, 4}, {0, 0, 0, 2, 4, 6, 2, 0, 0}, "VEC3"), "move");
    animate(node, "scale", sampler({0, 2}, {1, 1, 1, 3, 1, 5}, "VEC3"), "grow");
    expectNear(placed(load(0), {0, 0, 0}), {0, 0, 0}); // before the first keyframe
    expectNear(placed(load(1.25), {0, 0, 0}), {0.5, 1, 1.5});
    expectNear(placed(load(2), {0, 0, 0}), {2, 4, 6});
    expectNear(placed(load(2.5), {1, 0, 0}), {3, 3, 4.5});
    expectNear(placed(load(99), {0, 0, 0}), {2, 0, 0}); // after the last one
    expectNear(placed(load(0.5, "grow"), {1, 1, 1}), {1.5, 1, 2});
}

// By angles, not by numbers; q and -q are one rotation, of whatever length.
TEST_F(GltfAnimation, RotationsTurnAtConstantSpeedTheShorterWay) {
    const int node = addTriangle();
    const auto to = float(std::sqrt(0.75)); // 120 degrees about z
    animate(node, "rotation", sampler({0, 3}, {0, 0, 0, 1, 0, 0, to, 0.5f}, "VEC4"), "turn");
    animate(node, "rotation", sampler({0, 3}, {0, 0, 0, 2, 0, 0, -3 * to, -1.5f}, "VEC4"), "negative");
    for (const char* name : {"turn", "negative"})
        for (const double time : {0.0, 0.5, 1.0, 2.25, 3.0, 7.0}) {
            const double angle = std::min(time, 3.0) * 40 * std::acos(-1.0) / 180;
            expectNear(placed(load(time, name), {1, 0, 0}), {std::cos(angle), std::sin(angle), 0}, 1e-6);
        }
}

TEST_F(GltfAnimation, StepsHoldWhatTheyHave) {
    const int node = addTriangle();
    animate(node, "translation", sampler({0, 1, 2}, {1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3", "STEP"));
    struct Case {
        double time, x;
    };
    for (const auto& [time, x] : {Case{0, 1}, Case{0.99, 1}, Case{1, 2}, Case{1.5, 2}, Case{2, 3}, Case{5, 3}})
        expectNear(placed(load(time), {0, 0, 0}), {x, 0, 0});
}

// At a quarter of two seconds: 0.84375 v0 + 2 * 0.140625 b0 + 0.15625 v1 - 2 * 0.046875 a1.
TEST_F(GltfAnimation, CubicSplinesByTheirTangents) {
    const int node = addTriangle();
    const std::vector<float> keys = {9, 9, 9, 0, 4, 0, 2, 0, 0, -1, 0, 0, 1, 8, 0, 9, 9, 9};
    animate(node, "translation", sampler({1, 3}, keys, "VEC3", "CUBICSPLINE"), "move");
    expectNear(placed(load(0, "move"), {0, 0, 0}), {0, 4, 0});
    expectNear(placed(load(1.5, "move"), {0, 0, 0}), {0.8125, 0.84375 * 4 + 0.15625 * 8, 0});
    expectNear(placed(load(3, "move"), {0, 0, 0}), {1, 8, 0});
    // Without tangents from the identity to half a turn about z: quaternions are mixed, then brought to length 1.
    const std::vector<float> turns = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    animate(node, "rotation", sampler({0, 1}, turns, "VEC4", "CUBICSPLINE"), "turn");
    expectNear(placed(load(0.5, "turn"), {1, 0, 0}), {0, 1, 0});
    const double angle = 2 * std::atan2(0.15625, 0.84375);
    expectNear(placed(load(0.25, "turn"), {1, 0, 0}), {std::cos(angle), std::sin(angle), 0});
}

TEST_F(GltfAnimation, AMorphedTriangle) {
    const int node = addMorphed();
    animate(node, "weights", sampler({0, 2}, {0, 1, 1, 0}, "SCALAR"), "linear");
    const std::vector<float> spline = {9, 9, 0, 1, 1, 0, 0, 2, 1, 0, 9, 9};
    animate(node, "weights", sampler({0, 1}, spline, "SCALAR", "CUBICSPLINE"), "spline");
    SceneDesc scene = load(0.5, "linear"); // weights 0.25 and 0.75
    EXPECT_EQ(meshOf(scene).positions, (std::vector<glm::dvec3>{{0.5, 0, 0}, {1, 3, 0}, {0, 1, 0}}));
    scene = load(0.5, "spline"); // 0.5 v1 + 0.125 b0 = 0.625, and 0.5 v0 - 0.125 a1 = 0.25
    EXPECT_EQ(meshOf(scene).positions, (std::vector<glm::dvec3>{{1.25, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
}

// A strip along x, whose second joint, at x = 1, turns by a quarter about z in two seconds.
TEST_F(GltfAnimation, AStripBentByTwoJoints) {
    json primitive = {{"mode", 5}};
    primitive["attributes"]["POSITION"] = floats({0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0}, "VEC3");
    const std::vector<std::uint8_t> joints = {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    primitive["attributes"]["JOINTS_0"] = gltf.addAccessor(joints, "VEC4");
    primitive["attributes"]["WEIGHTS_0"] =
        floats({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    const int elbow = gltf.add("nodes", {{"translation", {1, 0, 0}}});
    const int shoulder = gltf.addNode({{"children", {elbow}}});
    const std::vector<float> inverseBind = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
    const int matrices = gltf.addAccessor(gltf.addView(inverseBind), 5126, "MAT4", 2);
    gltf.add("skins", {{"joints", {shoulder, elbow}}, {"inverseBindMatrices", matrices}});
    gltf.addNode({{"mesh", gltf.addMesh(primitive)}, {"skin", 0}});
    animate(elbow, "rotation", sampler({0, 2}, {0, 0, 0, 1, 0, 0, float(kRootHalf), float(kRootHalf)}, "VEC4"));
    const SceneDesc straight = load(0), half = load(1), bent = load(2);
    expectNear(meshOf(straight).positions.at(5), {2, 1, 0});
    expectNear(meshOf(half).positions.at(0), {0, 0, 0});
    expectNear(meshOf(half).positions.at(4), {1 + kRootHalf, kRootHalf, 0});
    expectNear(meshOf(half).positions.at(5), {1, 2 * kRootHalf, 0});
    expectNear(meshOf(bent).positions.at(2), {1, 0, 0}); // the joint itself
    expectNear(meshOf(bent).positions.at(3), {0.5, 0.5, 0});
    expectNear(meshOf(bent).positions.at(4), {1, 1, 0});
    expectNear(meshOf(bent).positions.at(5), {0, 1, 0});
}

// A camera and a lamp are children of a node that moves and turns.
TEST_F(GltfAnimation, CamerasAndLightsMoveWithTheirNodes) {
    addTriangle();
    gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 5}, {"spot", {{"outerConeAngle", 0.5}}}}};
    const int camera = gltf.add("nodes", {{"camera", 0}, {"translation", {0, 0, 5}}});
    const int lamp = gltf.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const int dolly = gltf.addNode({{"children", {camera, lamp}}});
    const std::vector<float> turn = {0, 0, 0, 1, 0, float(kRootHalf), 0, float(kRootHalf)}; // to a quarter about y
    gltf.add("animations", {{"samplers", {sampler({0, 1}, {0, 0, 0, 0, 4, 0}, "VEC3"), sampler({0, 1}, turn, "VEC4")}},
                            {"channels",
                             {{{"sampler", 0}, {"target", {{"node", dolly}, {"path", "translation"}}}},
                              {{"sampler", 1}, {"target", {{"node", dolly}, {"path", "rotation"}}}}}}});
    for (const double time : {0.0, 0.5, 1.0}) {
        const SceneDesc scene = load(time);
        const double angle = time * std::acos(0.0);
        const glm::dvec3 back(std::sin(angle), 0, std::cos(angle)), middle(0, 4 * time, 0);
        expectNear(scene.camera.lookFrom, middle + 5.0 * back, 1e-6);
        expectNear(glm::normalize(scene.camera.lookAt - scene.camera.lookFrom), -back, 1e-6);
        const auto& light = std::get<SpotLightDesc>(scene.objects.back().shape);
        expectNear(light.position, middle, 1e-6);
        expectNear(light.direction, -back, 1e-6);
    }
}

TEST_F(GltfAnimation, NamesChooseOneAndAnUnknownOneIsRefused) {
    const int node = addTriangle();
    EXPECT_EQ(usageError(0, "walk"), "--animation walk: the scene has no animations");
    const SceneDesc rest = load(0), later = load(3);
    EXPECT_EQ(rest.objects, later.objects);
    EXPECT_EQ(rest.camera, later.camera);
    EXPECT_EQ(later.notices.back(), "nothing moves in it: --time counts for nothing");
    animate(node, "translation", sampler({0}, {1, 0, 0}, "VEC3"), "walk");
    animate(node, "translation", sampler({0}, {2, 0, 0}, "VEC3"));
    animate(node, "translation", sampler({0}, {3, 0, 0}, "VEC3"), "walk");
    expectNear(placed(load(0), {0, 0, 0}), {1, 0, 0});
    expectNear(placed(load(0, "animation 1"), {0, 0, 0}), {2, 0, 0});
    expectNear(placed(load(0, "walk (2)"), {0, 0, 0}), {3, 0, 0});
    EXPECT_EQ(usageError(0, "run"), "--animation run: allowed is one of the scene's: walk, animation 1, walk (2)");
    EXPECT_TRUE(load(0, "walk").notices.empty());
}

TEST_F(GltfAnimation, WhatAFileGetsWrongIsNamed) {
    const int node = addMorphed();
    struct Mistake {
        const char* path;
        json sampler;
        const char* message;
    };
    const Mistake mistakes[] = {
        {"translation", sampler({0, 2, 1}, std::vector<float>(9), "VEC3"),
         "/animations/0/samplers/0/input: element 2: must be later than the one before"},
        {"translation", sampler({0, 1, 2}, std::vector<float>(6), "VEC3"),
         "/animations/0/samplers/0/output: has 2 elements: must be 1 for each of 3 keyframes"},
        {"rotation", sampler({0, 1}, std::vector<float>(20), "VEC4", "CUBICSPLINE"),
         "/animations/0/samplers/0/output: has 5 elements: must be 3 for each of 2 keyframes"},
        {"weights", sampler({0, 1}, {0, 0, 1}, "SCALAR"),
         "/animations/0/samplers/0/output: has 3 elements: must be 2 for each of 2 keyframes"},
        {"scale", sampler({0}, {1, 1, 1}, "VEC3", "SMOOTH"),
         "/animations/0/samplers/0/interpolation: must be LINEAR, STEP or CUBICSPLINE"},
        {"scale", sampler({0, NAN}, std::vector<float>(6), "VEC3"), "element 1: must be numbers from -1e9 to 1e9"},
        {"scale", sampler({0}, {1}, "SCALAR"), "type: must be VEC3"},
    };
    for (const Mistake& mistake : mistakes) {
        gltf.json.erase("animations");
        animate(node, mistake.path, mistake.sampler);
        const std::string error = inputError(0.5);
        EXPECT_NE(error.find(mistake.message), std::string::npos) << error;
        EXPECT_EQ(error.find('\n'), error.npos);
    }
}

// Few bytes could ask for a long list of times for each of many channels.
TEST_F(GltfAnimation, ManyLongListsOfTimesAreRefused) {
    const int node = addTriangle();
    json animation;
    for (int i = 0; i < 20; ++i) {
        const int times = gltf.add("accessors", {{"componentType", 5126}, {"type", "SCALAR"}, {"count", 900'000}});
        const int values = gltf.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 900'000}});
        animation["samplers"].push_back({{"input", times}, {"output", values}});
        animation["channels"].push_back({{"sampler", i}, {"target", {{"node", node}, {"path", "translation"}}}});
    }
    gltf.add("animations", animation);
    EXPECT_NE(inputError(1).find("asks for more than"), std::string::npos);
}

TEST_F(GltfAnimation, WeightsOfJointsThatAreNoSharesGetANotice) {
    json primitive = gltf.triangle();
    primitive["attributes"]["JOINTS_0"] = gltf.addAccessor(std::vector<std::uint8_t>(12, 0), "VEC4");
    primitive["attributes"]["WEIGHTS_0"] = floats({1, 0, 0, 0, 0.5f, 0, 0, 0, 0.5f, 0.505f, 0, 0}, "VEC4");
    const int joint = gltf.addNode({{"translation", {4, 0, 0}}});
    gltf.add("skins", {{"joints", {joint}}});
    gltf.addNode({{"mesh", gltf.addMesh(primitive)}, {"skin", 0}});
    const SceneDesc scene = load(0);
    ASSERT_EQ(scene.notices.size(), 1u);
    EXPECT_EQ(scene.notices[0], "weights of joints are scaled to the sum 1 at 1 vertex");
    expectNear(meshOf(scene).positions[1], {5, 0, 0});
}

} // namespace
} // namespace rt::scene
