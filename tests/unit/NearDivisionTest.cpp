// Huge flat surfaces in pieces: the same surface with the same attributes, small near the origin, without gaps.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/Compiler/NearDivision.h"
#include "Common/Scene/Compiler/SceneCompiler.h"

namespace rt::scene {
namespace {

using glm::dvec3;

MeshData floorOf(double halfSize, double height) {
    MeshData mesh;
    mesh.positions = {{-halfSize, height, halfSize},
                      {halfSize, height, halfSize},
                      {halfSize, height, -halfSize},
                      {-halfSize, height, -halfSize}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

double area(const MeshData& mesh, const glm::uvec3& t) {
    const dvec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    return glm::cross(b - a, c - a).y / 2;
}

TEST(NearDivision, CoversTheSameSurfaceWithTheSameAttributes) {
    for (const double halfSize : {1e3, 1e7}) {
        const MeshData whole = floorOf(halfSize, -1.3);
        const MeshData pieces = divideHugeTriangles(whole, {}, true);
        EXPECT_LT(pieces.triangles.size(), 600u);
        double sum = 0;
        for (const glm::uvec3& t : pieces.triangles) {
            EXPECT_GT(area(pieces, t), 0) << "turned over";
            sum += area(pieces, t);
        }
        EXPECT_NEAR(sum / (4 * halfSize * halfSize), 1, 1e-12);
        for (std::size_t i = 0; i < pieces.positions.size(); ++i) {
            const dvec3& p = pieces.positions[i];
            EXPECT_NEAR(pieces.uvs[i].x, (p.x / halfSize + 1) / 2, 1e-12);
            EXPECT_NEAR(pieces.uvs[i].y, (1 - p.z / halfSize) / 2, 1e-12);
            EXPECT_EQ(pieces.colors[i].w, 1);
        }
    }
}

// Each edge inside belongs to two pieces, and those of the rim lie on it.
TEST(NearDivision, LeavesNoGaps) {
    const MeshData pieces = divideHugeTriangles(floorOf(1e6, -0.01), {}, true);
    std::map<std::array<double, 6>, int> uses;
    for (const glm::uvec3& t : pieces.triangles) {
        for (int i = 0; i < 3; ++i) {
            dvec3 a = pieces.positions[t[i]], b = pieces.positions[t[(i + 1) % 3]];
            if (std::tie(b.x, b.z) < std::tie(a.x, a.z)) std::swap(a, b);
            ++uses[{a.x, a.y, a.z, b.x, b.y, b.z}];
        }
    }
    for (const auto& [edge, count] : uses) {
        const bool isRim =
            (std::abs(edge[0]) == 1e6 && edge[0] == edge[3]) || (std::abs(edge[2]) == 1e6 && edge[2] == edge[5]);
        EXPECT_EQ(count, isRim ? 1 : 2);
    }
}

TEST(NearDivision, PiecesAreSmallNearTheOrigin) {
    for (const double height : {-1.3, -0.01}) {
        const MeshData pieces = divideHugeTriangles(floorOf(1e7, height), {}, true);
        for (const glm::uvec3& t : pieces.triangles) {
            double extent = 0, near = HUGE_VAL;
            for (int i = 0; i < 3; ++i) {
                const dvec3 &a = pieces.positions[t[i]], &b = pieces.positions[t[(i + 1) % 3]];
                extent = std::max(extent, glm::length(b - a));
                for (int k = 0; k <= 64; ++k) near = std::min(near, glm::length(a + (b - a) * (k / 64.0)));
            }
            EXPECT_LE(extent, 8.5 * near);
        }
    }
}

// As it may be with a smooth or a textured surface of others: what is not huge stays as it was, bit for bit.
TEST(NearDivision, OtherTrianglesStay) {
    for (const auto& [halfSize, height] : {std::pair(10.0, -1.3), std::pair(1e7, -1e6), std::pair(1e7, 0.0)}) {
        const std::vector<dvec3> p = floorOf(halfSize, height).positions;
        EXPECT_FALSE(isHuge(p[0], p[1], p[2]) || isHuge(p[0], p[2], p[3]));
    }
    MeshData mesh = floorOf(1e4, -1.3);
    mesh.positions.insert(mesh.positions.end(), {{0, 1, 2}, {1, 1, 2}, {0, 2, 2}});
    mesh.uvs.resize(7);
    mesh.colors.resize(7);
    mesh.triangles.emplace_back(4, 5, 6);
    const MeshData pieces = divideHugeTriangles(mesh, {}, true);
    EXPECT_EQ(std::count(pieces.triangles.begin(), pieces.triangles.end(), glm::uvec3(4, 5, 6)), 1);
}

// An image on a triangle without coordinates covers it by the place in it.
TEST(NearDivision, PiecesKnowTheirPlaceInTheTriangle) {
    MeshData mesh = floorOf(1e5, -1);
    mesh.uvs.clear();
    EXPECT_TRUE(divideHugeTriangles(mesh, {}, false).uvs.empty());
    const MeshData pieces = divideHugeTriangles(mesh, {}, true);
    ASSERT_EQ(pieces.uvs.size(), pieces.positions.size());
    for (const glm::uvec3& t : pieces.triangles) {
        const dvec3 middle = (pieces.positions[t.x] + pieces.positions[t.y] + pieces.positions[t.z]) / 3.0;
        const glm::dvec2 uv = (pieces.uvs[t.x] + pieces.uvs[t.y] + pieces.uvs[t.z]) / 3.0;
        const double x = (middle.x / 1e5 + 1) / 2, z = (1 - middle.z / 1e5) / 2;
        const bool isFirst = x > z; // corners (0, 0), (1, 0), (1, 1)
        EXPECT_NEAR(uv.x, isFirst ? x - z : x, 1e-9);
        EXPECT_NEAR(uv.y, isFirst ? z : z - x, 1e-9);
    }
}

// Its pieces are lights, with the power of the whole.
TEST(NearDivision, AQuadThatGlowsGivesTheSameLight) {
    SceneDesc scene;
    scene.id = "test";
    scene.materials = {{"lamp", emitter({1, 2, 4})}};
    scene.camera.lookFrom = {0, 1, 0};
    scene.objects.push_back({QuadDesc{{-1e5, 0, 1e5}, {2e5, 0, 0}, {0, 0, -2e5}, "lamp"}});
    const auto compiled = compileScene(scene);
    ASSERT_EQ(compiled->lights.size(), compiled->triangles.size());
    EXPECT_TRUE(compiled->quads.empty());
    double sum = 0;
    for (const shared::Light& light : compiled->lights) {
        sum += glm::length(glm::cross(dvec3(light.edgeU), dvec3(light.edgeV))) / 2;
        EXPECT_GT(light.normal.y, 0.99f);
    }
    EXPECT_NEAR(sum / 4e10, 1, 1e-5);
}

} // namespace
} // namespace rt::scene
