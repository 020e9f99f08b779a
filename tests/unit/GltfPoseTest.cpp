// glTF: meshes in the pose that morph targets, skins and the start of the first animation give them.
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/TempFolder.h"
#include "tests/unit/GltfBuilder.h"

namespace rt::scene {
namespace {

using nlohmann::json;

const double kHalf = std::sqrt(0.5);
const json kQuarterAboutZ = {0, 0, kHalf, kHalf};

class GltfPose : public testing::Test {
  protected:
    SceneDesc load() const { return loadGltfScene(gltf.save(folder / "a.glb")); }
    // The mesh of an object, in a group or not.
    static const MeshData& meshOf(const SceneDesc& scene, std::size_t object = 0) {
        const ObjectDesc* found = &scene.objects.at(object);
        if (const auto* group = std::get_if<GroupDesc>(&found->shape)) found = &group->objects.at(0);
        return *std::get<Boxed<MeshData>>(std::get<MeshDesc>(found->shape).source);
    }
    int floats(const std::vector<float>& values, const char* type) { return gltf.addAccessor(values, type); }

    // A triangle with normals whose two morph targets move the first vertex along x and the second along y.
    json morphed() {
        json primitive = gltf.triangle();
        primitive["attributes"]["NORMAL"] = floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        primitive["targets"] = {{{"POSITION", floats({2, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3")}},
                                {{"POSITION", floats({0, 0, 0, 0, 4, 0, 0, 0, 0}, "VEC3")},
                                 {"NORMAL", floats({0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3")}}};
        return primitive;
    }
    // A triangle of whose vertices the first follows joint 0, the second joint 1, and the third both.
    json skinned() {
        json primitive = gltf.triangle();
        primitive["attributes"]["NORMAL"] = floats({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
        primitive["attributes"]["JOINTS_0"] =
            gltf.addAccessor(std::vector<std::uint8_t>{0, 9, 9, 9, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
        primitive["attributes"]["WEIGHTS_0"] = floats({1, 0, 0, 0, 1, 0, 0, 0, 0.25f, 0.75f, 0, 0}, "VEC4");
        return primitive;
    }
    int addSkin(const std::vector<float>& inverseBind, const json& joints) {
        json skin = {{"joints", joints}};
        if (!inverseBind.empty())
            skin["inverseBindMatrices"] =
                gltf.addAccessor(gltf.addView(inverseBind), 5126, "MAT4", inverseBind.size() / 16);
        return gltf.add("skins", skin);
    }
    json channel(const char* path, int node, int sampler) const {
        return {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}};
    }

    test::TempFolder folder;
    GltfBuilder gltf;
};

TEST_F(GltfPose, MorphTargetsByTheWeightsOfTheMesh) {
    gltf.addNode({{"mesh", gltf.addMesh(morphed())}});
    const MeshData rest = meshOf(load());
    EXPECT_EQ(rest.positions, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    gltf.json["meshes"][0]["weights"] = {0.5, 0.25};
    const SceneDesc scene = load();
    const MeshData& mesh = meshOf(scene);
    EXPECT_EQ(mesh.positions, (std::vector<glm::dvec3>{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.normals, (std::vector<glm::dvec3>{{0, 0, 1}, {0.25, 0, 1}, {0, 0, 1}}));
    EXPECT_EQ(mesh.uvs, rest.uvs);
    EXPECT_EQ(parseScene(toJson(scene), "a.json", folder.path()).objects, scene.objects);
}

TEST_F(GltfPose, NodesOverrideTheWeightsAndShareAMeshInEqualPosesOnly) {
    const int mesh = gltf.addMesh(morphed());
    gltf.json["meshes"][0]["weights"] = {1, 1};
    gltf.addNode({{"mesh", mesh}, {"weights", {1, 0}}});
    gltf.addNode({{"mesh", mesh}, {"weights", {0, 1}}});
    gltf.addNode({{"mesh", mesh}, {"weights", {0, 1}}, {"translation", {5, 0, 0}}});
    const SceneDesc scene = load();
    ASSERT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(scene.prototypes.size(), 1u);
    std::size_t alone = 0;
    while (std::holds_alternative<InstanceDesc>(scene.objects[alone].shape)) ++alone;
    EXPECT_EQ(meshOf(scene, alone).positions[0], glm::dvec3(2, 0, 0));
    const auto& shared = std::get<MeshDesc>(scene.prototypes.begin()->second.at(0).shape);
    EXPECT_EQ(std::get<Boxed<MeshData>>(shared.source)->positions[1], glm::dvec3(1, 4, 0));
}

// Targets may be sparse, and of vertices that the primitive does not use.
TEST_F(GltfPose, SparseTargetsOfSomeOfTheVertices) {
    std::vector<float> positions(300);
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = float(i * i % 101);
    const auto sparse = [&](const std::vector<std::uint16_t>& vertices, const std::vector<float>& values) {
        const json indices = {{"bufferView", gltf.addView(vertices)}, {"componentType", 5123}};
        return gltf.add(
            "accessors",
            {{"componentType", 5126},
             {"type", "VEC3"},
             {"count", 100},
             {"sparse",
              {{"count", vertices.size()}, {"indices", indices}, {"values", {{"bufferView", gltf.addView(values)}}}}}});
    };
    const json target = {{"POSITION", sparse({7, 50, 98}, {1, 1, 1, 1000, 0, 0, 2, 2, 2})}};
    const int indices = gltf.addAccessor(std::vector<std::uint32_t>{98, 3, 50}, "SCALAR");
    const int mesh = gltf.addMesh(
        {{"indices", indices}, {"attributes", {{"POSITION", floats(positions, "VEC3")}}}, {"targets", {target}}});
    gltf.json["meshes"][0]["weights"] = {0.5};
    gltf.addNode({{"mesh", mesh}});
    const SceneDesc scene = load();
    const MeshData& data = meshOf(scene);
    ASSERT_EQ(data.positions.size(), 3u);
    const std::size_t vertices[] = {98, 3, 50};
    const glm::dvec3 moves[] = {glm::dvec3(1), glm::dvec3(0), glm::dvec3(500, 0, 0)};
    for (int c = 0; c < 3; ++c) {
        const float* p = &positions[3 * vertices[c]];
        EXPECT_EQ(data.positions[data.triangles[0][c]], glm::dvec3(p[0], p[1], p[2]) + moves[c]) << c;
    }
}

TEST_F(GltfPose, JointsMoveVerticesAndTheNodeDoesNot) {
    const int turned = gltf.addNode({{"rotation", kQuarterAboutZ}});
    const int child = gltf.add("nodes", {{"translation", {10, 0, 0}}});
    gltf.addNode({{"translation", {0, 0, 5}}, {"children", {child}}});
    const std::vector<float> inverseBind = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1,
                                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const int skin = addSkin(inverseBind, {turned, child});
    gltf.addNode({{"mesh", gltf.addMesh(skinned())}, {"skin", skin}, {"translation", {700, 0, 0}}});
    const SceneDesc scene = load();
    ASSERT_TRUE(std::holds_alternative<MeshDesc>(scene.objects.at(0).shape)); // in no group: the world is its space
    const MeshData& mesh = meshOf(scene);
    // By joint 0, x + 3 turned about z; by joint 1 moved; the third a quarter of the one and three of the other.
    const glm::dvec3 expected[] = {{0, 3, 0}, {11, 0, 5}, {0.25 * -1 + 0.75 * 10, 0.25 * 3 + 0.75 * 1, 0.75 * 5}};
    const glm::dvec3 normals[] = {{0, 1, 0}, {1, 0, 0}, glm::normalize(glm::dvec3(3, 1, 0))};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_LT(glm::distance(mesh.positions[i], expected[i]), 1e-12) << i;
        EXPECT_LT(glm::distance(mesh.normals[i], normals[i]), 1e-12) << i;
    }
    EXPECT_EQ(parseScene(toJson(scene), "a.json", folder.path()).objects, scene.objects);
}

// Weights of both sets count, whatever their sum; without any the first joint does.
TEST_F(GltfPose, TwoSetsOfJointsAndWeightsThatAreNoShares) {
    json primitive = skinned();
    primitive["attributes"]["WEIGHTS_0"] = floats({0.5f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    primitive["attributes"]["JOINTS_1"] =
        gltf.addAccessor(std::vector<std::uint16_t>{1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    primitive["attributes"]["WEIGHTS_1"] = floats({1.5f, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0}, "VEC4");
    const int a = gltf.addNode({{"translation", {4, 0, 0}}}), b = gltf.addNode({{"translation", {8, 0, 0}}});
    gltf.addNode({{"mesh", gltf.addMesh(primitive)}, {"skin", addSkin({}, {a, b})}});
    const SceneDesc scene = load();
    const MeshData& mesh = meshOf(scene);
    EXPECT_EQ(mesh.positions, (std::vector<glm::dvec3>{{7, 0, 0}, {5, 0, 0}, {8, 1, 0}}));
}

TEST_F(GltfPose, JointsThatMirrorKeepTheFront) {
    const int a = gltf.addNode({{"scale", {-1, 1, 1}}}), b = gltf.addNode({{"scale", {-2, 3, 4}}});
    json primitive = skinned();
    primitive["attributes"]["NORMAL"] = floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    gltf.addNode({{"mesh", gltf.addMesh(primitive)}, {"skin", addSkin({}, {a, b})}});
    const SceneDesc scene = load();
    const MeshData& mesh = meshOf(scene);
    const glm::uvec3 t = mesh.triangles.at(0);
    const glm::dvec3 front =
        glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    EXPECT_GT(front.z, 0);
    for (const glm::dvec3& normal : mesh.normals) EXPECT_EQ(normal, glm::dvec3(0, 0, 1));
}

TEST_F(GltfPose, SkinsThatMoveNothingGetANotice) {
    const int joint = gltf.addNode({{"translation", {4, 0, 0}}});
    gltf.addNode({{"mesh", gltf.addMesh(gltf.triangle())}, {"skin", addSkin({}, {joint})}});
    const SceneDesc scene = load();
    EXPECT_EQ(meshOf(scene).positions[0], glm::dvec3(0));
    bool isSaid = false;
    for (const std::string& notice : scene.notices) isSaid = isSaid || notice.find("1 skin is left out") == 0;
    EXPECT_TRUE(isSaid);
}

// A keyframe of a cubic spline lies between two tangents. The second animation, of the same nodes, counts for nothing.
TEST_F(GltfPose, TheFirstAnimationAtItsStart) {
    const int node = gltf.addNode({{"mesh", gltf.addMesh(morphed())}, {"scale", {2, 2, 2}}, {"weights", {1, 1}}});
    const int times = floats({0, 1}, "SCALAR");
    const json linear = {{"input", times}, {"output", floats({1, 2, 3, 7, 8, 9}, "VEC3")}};
    const json spline = {{"input", times},
                         {"interpolation", "CUBICSPLINE"},
                         {"output", floats({9, 9, 9, 9, 0, 0, float(kHalf), float(kHalf), 9, 9, 9, 9, 9, 9, 9, 9, 1, 0,
                                            0, 0, 9, 9, 9, 9},
                                           "VEC4")}};
    const json weights = {{"input", times}, {"interpolation", "STEP"}, {"output", floats({0, 0.5f, 1, 1}, "SCALAR")}};
    gltf.add("animations", {{"name", "walk"},
                            {"samplers", {linear, spline, weights}},
                            {"channels",
                             {channel("translation", node, 0),
                              channel("rotation", node, 1),
                              channel("weights", node, 2),
                              {{"sampler", 0}, {"target", {{"path", "pointer"}}}}}}});
    gltf.add("animations", {{"samplers", {linear}}, {"channels", {channel("scale", node, 0)}}});
    const SceneDesc scene = load();
    const auto& group = std::get<GroupDesc>(scene.objects.at(0).shape);
    const auto& rows = std::get<Matrix>(group.transform.at(0)).rows;
    const std::array<double, 12> expected = {0, -2, 0, 1, 2, 0, 0, 2, 0, 0, 2, 3};
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(rows[i], expected[i], 1e-12) << i;
    EXPECT_EQ(meshOf(scene).positions, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 2, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.notices.back(),
              "animation \"walk\", the first of 2, is shown at its start: --time poses it, from 0 to "
              "1 s; --animation chooses another");
}

TEST_F(GltfPose, AnimatedJointsMoveTheirSkin) {
    const int joint = gltf.addNode({{"translation", {4, 0, 0}}});
    gltf.addNode({{"mesh", gltf.addMesh(skinned())}, {"skin", addSkin({}, {joint, joint})}});
    gltf.add("animations", {{"samplers", {{{"input", floats({0}, "SCALAR")}, {"output", floats({0, 6, 0}, "VEC3")}}}},
                            {"channels", {channel("translation", joint, 0)}}});
    const SceneDesc scene = load();
    EXPECT_EQ(meshOf(scene).positions, (std::vector<glm::dvec3>{{0, 6, 0}, {1, 6, 0}, {0, 7, 0}}));
    EXPECT_EQ(scene.notices.back(), "animation \"animation 0\" is shown at its start: --time poses it, from 0 to 0 s");
}

// Each pose is a copy: few bytes may ask for many.
TEST_F(GltfPose, ManyPosesOfALargeMeshAreRefused) {
    const int zeros = gltf.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 900'000}});
    const int mesh = gltf.addMesh({{"attributes", {{"POSITION", zeros}}}, {"targets", {{{"POSITION", zeros}}}}});
    for (int i = 0; i < 40; ++i) gltf.addNode({{"mesh", mesh}, {"weights", {i}}});
    EXPECT_THROW(load(), InputError);
    gltf.json["nodes"] = {
        {{"mesh", mesh}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"SCALE", zeros}}}}}}}}};
    gltf.json["scenes"][0]["nodes"] = {0};
    EXPECT_THROW(load(), InputError);
}

} // namespace
} // namespace rt::scene
