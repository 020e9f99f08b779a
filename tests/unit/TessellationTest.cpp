// Shapes as triangles: how far they are from the shape, that they face as it does and cover it once.
#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Scene/Tessellation.h"

namespace rt::scene {
namespace {

using glm::dvec3;

// Of the largest distance that a point of a triangle has from the sphere: at the middle of its circumcircle.
double largestDepth(const MeshData& mesh, const dvec3& towards, double within) {
    double depth = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const dvec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
        if (glm::distance(a, towards) > within) continue;
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0) << "it faces inwards";
        for (int i = 0; i <= 8; ++i)
            for (int k = 0; i + k <= 8; ++k)
                depth = std::max(depth, 1 - glm::length((a * double(i) + b * double(k) + c * double(8 - i - k)) / 8.0));
    }
    return depth;
}

TEST(Tessellation, SpheresAreWithinAThousandthOfTheRadius) {
    const dvec3 up(0, 1, 0), askew = glm::normalize(dvec3(1, -2, 3));
    EXPECT_LE(largestDepth(sphereMesh(), up, 3), 1e-3);
    const MeshData fine = sphereMesh(askew);
    EXPECT_LE(largestDepth(fine, askew, 3), 1e-3);
    EXPECT_LE(largestDepth(fine, askew, 0.01), 1e-7);
    EXPECT_LE(largestDepth(fine, askew, 1e-4), 2.1e-8);
    double area = 0;
    for (const glm::uvec3& t : fine.triangles)
        area += glm::length(
                    glm::cross(fine.positions[t.y] - fine.positions[t.x], fine.positions[t.z] - fine.positions[t.x])) /
                2;
    EXPECT_NEAR(area, 12.566, 0.02) << "closed, and covered once";
}

TEST(Tessellation, ShapesHaveTheirAreaAndFaceOutwards) {
    const auto area = [](const MeshData& mesh) {
        double sum = 0;
        for (const glm::uvec3& t : mesh.triangles) {
            const dvec3 a = mesh.positions[t.x];
            const dvec3 normal = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
            EXPECT_GT(glm::dot(normal, mesh.normals[t.x]), 0);
            sum += glm::length(normal) / 2;
        }
        return sum;
    };
    EXPECT_NEAR(area(meshOf(BoxDesc{{0, 0, 0}, {1, 2, 3}, "", true})), 22, 1e-12);
    EXPECT_NEAR(area(meshOf(DiskDesc{{1, 1, 1}, {0, 0, -2}, 2, 0, "", true})), 12.566, 0.02);
    EXPECT_NEAR(area(meshOf(DiskDesc{{1, 1, 1}, {0, 0, -2}, 2, 1, "", true})), 9.425, 0.02);
    EXPECT_NEAR(area(meshOf(CylinderDesc{{0, 0, 0}, {0, 3, 0}, 1, "", true})), 18.85, 0.02);
    EXPECT_TRUE(meshOf(QuadDesc{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, "", true}).triangles.empty());
}

} // namespace
} // namespace rt::scene
