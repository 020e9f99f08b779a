// glTF: accessors, connectivity, hierarchy, instances and cameras as they become a scene.
#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/TempFolder.h"
#include "tests/unit/GltfBuilder.h"

namespace rt::scene {
namespace {

using nlohmann::json;

class Gltf : public testing::Test {
  protected:
    SceneDesc load() const { return loadGltfScene(gltf.save(folder / "a.glb")); }
    // The mesh of a scene of one object.
    const MeshData& loadMesh() {
        scene = load();
        const ObjectDesc* object = &scene.objects.at(0);
        if (const auto* group = std::get_if<GroupDesc>(&object->shape)) object = &group->objects.at(0);
        return *std::get<Boxed<MeshData>>(std::get<MeshDesc>(object->shape).source);
    }
    void placeTriangle() { gltf.addNode({{"mesh", gltf.addMesh(gltf.triangle())}}); }

    test::TempFolder folder;
    GltfBuilder gltf;
    SceneDesc scene;
};

TEST_F(Gltf, TextureCoordinatesRunUpwards) {
    placeTriangle();
    const MeshData& mesh = loadMesh();
    EXPECT_EQ(mesh.positions, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.uvs, (std::vector<glm::dvec2>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.tangents.empty());
}

TEST_F(Gltf, InterleavedAndNormalizedIntegers) {
    struct Vertex {
        float position[3];
        std::int8_t normal[4];
        std::uint16_t uv[2];
        std::uint8_t color[4];
    };
    const std::vector<Vertex> vertices = {{{1, 2, 3}, {0, 0, 127, 0}, {0, 65535}, {255, 0, 51, 255}},
                                          {{4, 5, 6}, {-128, 0, 0, 0}, {65535, 0}, {0, 255, 0, 0}},
                                          {{7, 8, 10}, {0, 127, 0, 0}, {13107, 0}, {0, 0, 255, 0}}};
    const int view = gltf.addView(vertices, sizeof(Vertex));
    const int normals = gltf.addAccessor(view, 5120, "VEC3", 3, offsetof(Vertex, normal));
    const int uvs = gltf.addAccessor(view, 5123, "VEC2", 3, offsetof(Vertex, uv));
    const int colors = gltf.addAccessor(view, 5121, "VEC4", 3, offsetof(Vertex, color));
    for (const int accessor : {normals, uvs, colors}) gltf.json["accessors"][accessor]["normalized"] = true;
    gltf.add("materials", {{"alphaMode", "BLEND"}});
    const int mesh = gltf.addMesh({{"material", 0},
                                   {"indices", gltf.addAccessor(std::vector<std::uint8_t>{2, 1, 0}, "SCALAR")},
                                   {"attributes",
                                    {{"POSITION", gltf.addAccessor(view, 5126, "VEC3", 3)},
                                     {"NORMAL", normals},
                                     {"TEXCOORD_1", uvs},
                                     {"COLOR_0", colors}}}});
    gltf.addNode({{"mesh", mesh}});
    const MeshData& data = loadMesh();
    EXPECT_EQ(data.positions, (std::vector<glm::dvec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}));
    EXPECT_EQ(data.normals, (std::vector<glm::dvec3>{{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(data.uvs2, (std::vector<glm::dvec2>{{0, 0}, {1, 1}, {13107 / 65535.0, 1}}));
    EXPECT_EQ(data.colors, (std::vector<glm::dvec4>{{1, 0, 51 / 255.0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}}));
    EXPECT_EQ(data.triangles, (std::vector<glm::uvec3>{{2, 1, 0}}));
}

TEST_F(Gltf, QuantizedPositionsAreNumbersOfTheirNode) {
    gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int view = gltf.addView(std::vector<std::int16_t>{0, 0, 0, 0, 300, 0, -7, 0, 0, 32767, 1, 0}, 8);
    const int normalized = gltf.addAccessor(view, 5122, "VEC3", 3);
    gltf.json["accessors"][normalized]["normalized"] = true;
    const int bytes = gltf.addView(std::vector<std::int8_t>{0, -5, 127, 0, 1, 2, 3, 0, -128, 0, 0, 0}, 4);
    gltf.addNode({{"mesh", gltf.addMesh({{"attributes",
                                          {{"POSITION", gltf.addAccessor(view, 5122, "VEC3", 3)},
                                           {"TEXCOORD_0", gltf.addAccessor(bytes, 5120, "VEC2", 3)}}}})},
                  {"scale", {0.5, 2, 1}}});
    const MeshData whole = loadMesh();
    EXPECT_EQ(whole.positions, (std::vector<glm::dvec3>{{0, 0, 0}, {300, 0, -7}, {0, 32767, 1}}));
    EXPECT_EQ(whole.uvs, (std::vector<glm::dvec2>{{0, 6}, {1, -1}, {-128, 1}}));
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = normalized;
    EXPECT_EQ(loadMesh().positions,
              (std::vector<glm::dvec3>{{0, 0, 0}, {300 / 32767.0, 0, -7 / 32767.0}, {0, 1, 1 / 32767.0}}));
}

TEST_F(Gltf, OpaqueMaterialsIgnoreTheOpacityOfVertexColors) {
    json primitive = gltf.triangle();
    primitive["attributes"]["COLOR_0"] = gltf.addAccessor(std::vector<float>(12, 0.5f), "VEC4");
    gltf.addNode({{"mesh", gltf.addMesh(primitive)}});
    for (const glm::dvec4& color : loadMesh().colors) EXPECT_EQ(color, glm::dvec4(0.5, 0.5, 0.5, 1));
}

TEST_F(Gltf, SparseAccessorsChangeWhatLiesBelow) {
    json primitive = gltf.triangle();
    const int indices = gltf.addView(std::vector<std::uint16_t>{1});
    const int values = gltf.addView(std::vector<float>{5, 6, 7});
    const json sparse = {{"count", 1},
                         {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                         {"values", {{"bufferView", values}}}};
    gltf.json["accessors"][primitive["attributes"]["POSITION"].get<int>()]["sparse"] = sparse;
    const int zeros =
        gltf.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}, {"sparse", sparse}});
    primitive["attributes"]["NORMAL"] = zeros;
    gltf.addNode({{"mesh", gltf.addMesh(primitive)}});
    const MeshData& mesh = loadMesh();
    EXPECT_EQ(mesh.positions, (std::vector<glm::dvec3>{{0, 0, 0}, {5, 6, 7}, {0, 1, 0}}));
    EXPECT_EQ(mesh.normals, (std::vector<glm::dvec3>{{0, 0, 0}, {5, 6, 7}, {0, 0, 0}}));
}

TEST_F(Gltf, StripsAndFans) {
    const int positions = gltf.addAccessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0}, "VEC3");
    const auto triangles = [&](int mode) {
        gltf.json.erase("meshes");
        gltf.json.erase("nodes");
        gltf.json.erase("scenes");
        gltf.addNode({{"mesh", gltf.addMesh({{"mode", mode}, {"attributes", {{"POSITION", positions}}}})}});
        return loadMesh().triangles;
    };
    EXPECT_EQ(triangles(5), (std::vector<glm::uvec3>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
    EXPECT_EQ(triangles(6), (std::vector<glm::uvec3>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
    EXPECT_EQ(triangles(4), (std::vector<glm::uvec3>{{0, 1, 2}})); // two corners complete no triangle
}

TEST_F(Gltf, PointsAndLinesGetANotice) {
    json lines = gltf.triangle();
    lines["mode"] = 1;
    gltf.add("meshes", {{"primitives", {lines, gltf.triangle()}}});
    gltf.addNode({{"mesh", 0}});
    scene = load();
    EXPECT_EQ(scene.objects.size(), 1u);
    EXPECT_NE(scene.notices.back().find("1 primitive of points, lines or no triangle is left out"), std::string::npos);
}

TEST_F(Gltf, PrimitivesKeepOnlyTheVerticesTheyUse) {
    std::vector<float> positions(3000);
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = float(i * i % 101);
    const int accessor = gltf.addAccessor(positions, "VEC3");
    const int indices = gltf.addAccessor(std::vector<std::uint32_t>{999, 3, 700}, "SCALAR");
    gltf.addNode({{"mesh", gltf.addMesh({{"indices", indices}, {"attributes", {{"POSITION", accessor}}}})}});
    const MeshData& mesh = loadMesh();
    ASSERT_EQ(mesh.positions.size(), 3u);
    const std::size_t vertices[] = {999, 3, 700};
    for (int c = 0; c < 3; ++c) EXPECT_EQ(mesh.positions[mesh.triangles[0][c]].y, positions[3 * vertices[c] + 1]);
}

TEST_F(Gltf, TangentsFollowTheTextureAndSplitWhereItIsMirrored) {
    // Two quads side by side that share an edge; u grows to the right on the left one, to the left on the right one.
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0};
    const std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    const std::vector<float> uvs = {0, 1, 1, 1, 0, 1, 0, 0, 1, 0, 0, 0};
    const std::vector<std::uint8_t> indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    gltf.add("images", {{"bufferView", gltf.addView(kPng)}, {"mimeType", "image/png"}});
    gltf.add("textures", {{"source", 0}});
    gltf.add("materials", {{"normalTexture", {{"index", 0}}}});
    gltf.addNode({{"mesh", gltf.addMesh({{"material", 0},
                                         {"indices", gltf.addAccessor(indices, "SCALAR")},
                                         {"attributes",
                                          {{"POSITION", gltf.addAccessor(positions, "VEC3")},
                                           {"NORMAL", gltf.addAccessor(normals, "VEC3")},
                                           {"TEXCOORD_0", gltf.addAccessor(uvs, "VEC2")}}}})}});
    const MeshData& mesh = loadMesh();
    EXPECT_EQ(mesh.positions.size(), 8u); // the shared edge twice
    ASSERT_EQ(mesh.tangents.size(), 8u);
    for (const glm::uvec3& t : mesh.triangles) {
        const bool isLeft = (mesh.positions[t.x].x + mesh.positions[t.y].x + mesh.positions[t.z].x) / 3 < 1;
        for (int c = 0; c < 3; ++c)
            EXPECT_LT(glm::distance(mesh.tangents[t[c]], glm::dvec4(isLeft ? 1 : -1, 0, 0, isLeft ? 1 : -1)), 1e-12);
    }
}

TEST_F(Gltf, HierarchyBecomesOneTransform) {
    const int mesh = gltf.addMesh(gltf.triangle());
    const double half = std::sqrt(0.5);
    const int child = gltf.add("nodes", {{"mesh", mesh}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}});
    gltf.addNode({{"translation", {1, 2, 3}},
                  {"rotation", {0, 0, half, half}}, // a quarter turn about z
                  {"scale", {2, 3, 4}},
                  {"children", {child}}});
    scene = load();
    const auto& group = std::get<GroupDesc>(scene.objects.at(0).shape);
    const auto& rows = std::get<Matrix>(group.transform.at(0)).rows;
    const std::array<double, 12> expected = {0, -3, 0, 1, 2, 0, 0, 12, 0, 0, 4, 3};
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(rows[i], expected[i], 1e-12) << i;
}

TEST_F(Gltf, MeshesUsedTwiceAreInstances) {
    const int mesh = gltf.addMesh(gltf.triangle());
    gltf.json["meshes"][0]["name"] = "leaf";
    gltf.addNode({{"mesh", mesh}});
    gltf.addNode({{"mesh", mesh}, {"translation", {3, 0, 0}}});
    scene = load();
    ASSERT_EQ(scene.prototypes.count("leaf"), 1u);
    ASSERT_EQ(scene.objects.size(), 2u);
    const auto& instance = std::get<InstanceDesc>(scene.objects[1].shape);
    EXPECT_EQ(instance.prototype, "leaf");
    EXPECT_EQ(std::get<Matrix>(instance.transform.at(0)).rows[3], 3);
}

TEST_F(Gltf, WhatIsScaledToNothingIsLeftOutSoThatTheSceneCanBeExported) {
    const int mesh = gltf.addMesh(gltf.triangle());
    gltf.addNode({{"mesh", mesh}, {"translation", {3, 0, 0}}});
    gltf.addNode({{"mesh", mesh}, {"scale", {1, 0, 1}}});
    scene = load();
    EXPECT_EQ(scene.objects.size(), 1u);
    EXPECT_NE(std::find(scene.notices.begin(), scene.notices.end(),
                        "1 mesh is left out: the transform of the node cannot be inverted"),
              scene.notices.end());
    EXPECT_NO_THROW(parseScene(toJson(scene), "exported.json", folder.path()));
}

TEST_F(Gltf, GpuInstancing) {
    const int mesh = gltf.addMesh(gltf.triangle());
    const int translations = gltf.addAccessor(std::vector<float>{0, 0, 0, 1, 0, 0, 2, 0, 0}, "VEC3");
    const int scales = gltf.addAccessor(std::vector<float>{1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3");
    gltf.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    gltf.addNode(
        {{"mesh", mesh},
         {"scale", {10, 10, 10}},
         {"extensions",
          {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", translations}, {"SCALE", scales}}}}}}}});
    scene = load();
    ASSERT_EQ(scene.objects.size(), 3u);
    const auto& rows = std::get<Matrix>(std::get<InstanceDesc>(scene.objects[2].shape).transform.at(0)).rows;
    EXPECT_EQ(rows[0], 30);
    EXPECT_EQ(rows[3], 20);
}

TEST_F(Gltf, PunctualLights) {
    placeTriangle();
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 4}, {"color", {1, 0.5, 0}}},
        {{"type", "directional"}},
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", glm::pi<double>() / 2}}}}};
    const double half = std::sqrt(0.5);
    for (int i = 0; i < 3; ++i)
        gltf.addNode({{"translation", {1, 2, 3}},
                      {"rotation", {-half, 0, 0, half}}, // what looked along -z looks down
                      {"scale", {2, 2, 2}},
                      {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    scene = load();
    ASSERT_EQ(scene.objects.size(), 4u);
    EXPECT_EQ(std::get<PointLightDesc>(scene.objects[1].shape), (PointLightDesc{{1, 2, 3}, {4, 2, 0}}));
    const auto& sun = std::get<DirectionalLightDesc>(scene.objects[2].shape);
    EXPECT_LT(glm::distance(sun.direction, glm::dvec3(0, -1, 0)), 1e-12);
    EXPECT_EQ(sun.irradiance, glm::dvec3(1));
    const auto& spot = std::get<SpotLightDesc>(scene.objects[3].shape);
    EXPECT_EQ(spot.outerAngle, 90);
    EXPECT_NEAR(spot.innerAngle, 18 / glm::pi<double>(), 1e-12);
    EXPECT_EQ(scene.background, Background(ConstantBackground{}));
    gltf.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 3}}}}}});
    EXPECT_THROW(load(), InputError);
}

} // namespace
} // namespace rt::scene
