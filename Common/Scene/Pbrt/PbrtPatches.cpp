#include "Common/Scene/Pbrt/PbrtPatches.h"

#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "Common/Scene/Counted.h"
#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

namespace {

constexpr int kCuts = 8;           // along each side of a patch that is not flat
constexpr double kFlatness = 1e-6; // of a patch's size

struct PatchCorners {
    std::uint32_t of[4];
};

PatchCorners cornersOf(const std::vector<std::uint32_t>& indices, std::size_t patch) {
    return {{indices[4 * patch], indices[4 * patch + 1], indices[4 * patch + 2], indices[4 * patch + 3]}};
}

bool isFlat(const MeshData& vertices, const PatchCorners& corners) {
    const glm::dvec3& origin = vertices.positions[corners.of[0]];
    const glm::dvec3 u = vertices.positions[corners.of[1]] - origin, v = vertices.positions[corners.of[2]] - origin;
    const glm::dvec3 far = vertices.positions[corners.of[3]] - origin;
    const double volume = std::abs(glm::dot(glm::cross(u, v), far));
    const double size = glm::length(u) + glm::length(v) + glm::length(far);
    return volume <= kFlatness * size * size * size;
}

template <class Vector>
Vector bilinear(const std::vector<Vector>& values, const PatchCorners& corners, double u, double v) {
    return (1 - v) * ((1 - u) * values[corners.of[0]] + u * values[corners.of[1]]) +
           v * ((1 - u) * values[corners.of[2]] + u * values[corners.of[3]]);
}

// Normals of its own, so that the cuts do not show.
glm::dvec3 normalAt(const MeshData& vertices, const PatchCorners& c, double u, double v) {
    const auto& p = vertices.positions;
    const glm::dvec3 alongU = (1 - v) * (p[c.of[1]] - p[c.of[0]]) + v * (p[c.of[3]] - p[c.of[2]]);
    const glm::dvec3 alongV = (1 - u) * (p[c.of[2]] - p[c.of[0]]) + u * (p[c.of[3]] - p[c.of[1]]);
    const glm::dvec3 normal = glm::cross(alongU, alongV);
    const double length = glm::length(normal);
    return length > 0 ? normal / length : glm::dvec3(0, 0, 1);
}

void addPatch(const MeshData& vertices, const PatchCorners& corners, int cuts, bool hasNormals, MeshData& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int j = 0; j <= cuts; ++j)
        for (int i = 0; i <= cuts; ++i) {
            const double u = double(i) / cuts, v = double(j) / cuts;
            mesh.positions.push_back(bilinear(vertices.positions, corners, u, v));
            mesh.uvs.push_back(vertices.uvs.empty() ? glm::dvec2(u, v) : bilinear(vertices.uvs, corners, u, v));
            if (!hasNormals) continue;
            mesh.normals.push_back(vertices.normals.empty() ? normalAt(vertices, corners, u, v)
                                                            : bilinear(vertices.normals, corners, u, v));
        }
    const auto row = static_cast<std::uint32_t>(cuts + 1);
    for (std::uint32_t j = 0; j + 1 < row; ++j)
        for (std::uint32_t i = 0; i + 1 < row; ++i) {
            const std::uint32_t at = first + j * row + i;
            mesh.triangles.emplace_back(at, at + 1, at + row + 1);
            mesh.triangles.emplace_back(at, at + row + 1, at + row);
        }
}

} // namespace

template <class Real>
MeshOf<Real> pbrtVertices(const PbrtParameters& parameters) {
    MeshOf<Real> mesh;
    mesh.positions = parameters.takeVectors<Real>("P");
    if (mesh.positions.empty()) parameters.fail("\"point3 P\" is missing");
    mesh.normals = parameters.takeVectors<Real>("N");
    for (const char* name : {"uv", "st"})
        if (mesh.uvs.empty()) mesh.uvs = parameters.takePairs<Real>(name);
    const auto check = [&](const char* name, const auto& values) {
        if (values.empty()) return;
        if (values.size() != mesh.positions.size())
            parameters.fail(std::string("\"") + name + "\": has " + counted(values.size(), "element", "elements") +
                            ": must be those of P, " + std::to_string(mesh.positions.size()));
        for (const auto& value : values)
            for (int c = 0; c < value.length(); ++c)
                if (!(std::abs(value[c]) <= kLargest))
                    parameters.fail(std::string("\"") + name + "\": must be from -1e9 to 1e9");
    };
    check("P", mesh.positions);
    check("N", mesh.normals);
    check("uv", mesh.uvs);
    return mesh;
}
template MeshData pbrtVertices(const PbrtParameters&);
template FloatMeshData pbrtVertices(const PbrtParameters&);

std::vector<std::uint32_t> pbrtIndices(const PbrtParameters& parameters, std::size_t vertices, std::size_t corners) {
    const PbrtParameter* found = parameters.find("indices", PbrtType::Integer);
    std::vector<std::uint32_t> indices;
    if (!found) {
        if (vertices != corners)
            parameters.fail("\"integer indices\" is missing, which only " + std::to_string(corners) +
                            " vertices do without");
        for (std::uint32_t i = 0; i < corners; ++i) indices.push_back(i);
        return indices;
    }
    if (found->integers.empty() || found->integers.size() % corners != 0)
        found->fail("has " + counted(found->integers.size(), "index", "indices") + ": must have " +
                    std::to_string(corners) + " for each face");
    indices.reserve(found->integers.size());
    for (const std::int32_t index : std::exchange(found->integers, {})) {
        if (index < 0 || static_cast<std::size_t>(index) >= vertices)
            found->fail(std::to_string(index) + ": must be from 0 to " + std::to_string(vertices - 1));
        indices.push_back(static_cast<std::uint32_t>(index));
    }
    return indices;
}

std::optional<QuadDesc> pbrtQuad(const MeshData& vertices, const std::vector<std::uint32_t>& indices) {
    const PatchCorners corners = cornersOf(indices, 0);
    const auto at = [&](int corner) { return vertices.positions[corners.of[corner]]; };
    QuadDesc quad;
    quad.corner = at(0);
    quad.edgeU = at(1) - at(0);
    quad.edgeV = at(2) - at(0);
    const double size = glm::length(quad.edgeU) + glm::length(quad.edgeV);
    const bool isParallelogram = glm::length(at(3) - at(1) - quad.edgeV) <= kFlatness * size;
    const bool hasUsualUvs =
        vertices.uvs.empty() ||
        (vertices.uvs[corners.of[0]] == glm::dvec2(0, 0) && vertices.uvs[corners.of[1]] == glm::dvec2(1, 0) &&
         vertices.uvs[corners.of[2]] == glm::dvec2(0, 1) && vertices.uvs[corners.of[3]] == glm::dvec2(1, 1));
    if (!isParallelogram || !hasUsualUvs || !vertices.normals.empty()) return std::nullopt;
    if (!(glm::length(glm::cross(quad.edgeU, quad.edgeV)) > 0)) return std::nullopt;
    return quad;
}

std::size_t pbrtPatchTriangles(const MeshData& vertices, const std::vector<std::uint32_t>& indices, bool& isBent) {
    std::size_t count = 0;
    for (std::size_t patch = 0; patch < indices.size() / 4; ++patch) {
        const bool flat = isFlat(vertices, cornersOf(indices, patch));
        isBent = isBent || !flat;
        count += flat ? 2 : 2 * std::size_t{kCuts} * kCuts;
    }
    return count;
}

MeshData pbrtPatches(const MeshData& vertices, const std::vector<std::uint32_t>& indices) {
    bool isBent = false;
    pbrtPatchTriangles(vertices, indices, isBent);
    const bool hasNormals = isBent || !vertices.normals.empty();
    MeshData mesh;
    for (std::size_t patch = 0; patch < indices.size() / 4; ++patch) {
        const PatchCorners corners = cornersOf(indices, patch);
        addPatch(vertices, corners, isFlat(vertices, corners) ? 1 : kCuts, hasNormals, mesh);
    }
    return mesh;
}

} // namespace rt::scene
