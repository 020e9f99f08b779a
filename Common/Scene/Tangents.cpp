#include "Common/Scene/Tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace rt::scene {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// Each corner becomes a vertex of its own.
void separateCorners(MeshData& mesh) {
    const auto separate = [&mesh](auto& values) {
        if (values.empty()) return;
        std::remove_reference_t<decltype(values)> all;
        all.reserve(3 * mesh.triangles.size());
        for (const glm::uvec3& t : mesh.triangles)
            for (int c = 0; c < 3; ++c) all.push_back(values[t[c]]);
        values = std::move(all);
    };
    separate(mesh.positions);
    separate(mesh.normals);
    separate(mesh.uvs);
    separate(mesh.uvs2);
    separate(mesh.colors);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) mesh.triangles[i] = glm::uvec3(3 * i, 3 * i + 1, 3 * i + 2);
}

// Appends a copy of a vertex.
std::uint32_t duplicate(MeshData& mesh, std::uint32_t vertex) {
    const auto copy = [vertex](auto& values) {
        if (values.empty()) return;
        const auto value = values[vertex];
        values.push_back(value);
    };
    copy(mesh.positions);
    copy(mesh.normals);
    copy(mesh.uvs);
    copy(mesh.uvs2);
    copy(mesh.colors);
    copy(mesh.tangents);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

glm::dvec3 unit(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : glm::dvec3(0);
}

glm::dvec3 across(const glm::dvec3& normal, const glm::dvec3& v) {
    return unit(v - normal * glm::dot(normal, v));
}

// Some direction at right angles to the normal, for vertices whose texture coordinates tell none.
glm::dvec3 anyTangent(const glm::dvec3& normal) {
    return across(normal, std::abs(normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
}

} // namespace

void addTangents(MeshData& mesh, std::uint32_t set) {
    if (mesh.normals.empty()) separateCorners(mesh);
    const std::vector<glm::dvec2> uvs = set == 0 ? mesh.uvs : mesh.uvs2;
    mesh.tangents.assign(mesh.positions.size(), glm::dvec4(0));
    std::vector<std::uint32_t> mirrored(mesh.positions.size(), kNone); // vertex for triangles of the other orientation
    for (glm::uvec3& t : mesh.triangles) {
        std::array<glm::dvec3, 3> p;
        std::array<glm::dvec2, 3> uv;
        for (int c = 0; c < 3; ++c) {
            p[static_cast<std::size_t>(c)] = mesh.positions[t[c]];
            uv[static_cast<std::size_t>(c)] = uvs[t[c]];
        }
        const glm::dvec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
        const double area = d1.x * d2.y - d1.y * d2.x;
        if (area == 0) continue;
        const double sign = area > 0 ? 1 : -1;
        const glm::dvec3 along = sign * ((p[1] - p[0]) * d2.y - (p[2] - p[0]) * d1.y);
        const glm::dvec3 face = unit(glm::cross(p[1] - p[0], p[2] - p[0]));
        glm::uvec3 renamed = t;
        for (std::size_t c = 0; c < 3; ++c) {
            std::uint32_t& vertex = renamed[static_cast<int>(c)];
            if (mesh.tangents[vertex].w == -sign) {
                if (mirrored[vertex] == kNone) {
                    const std::uint32_t original = vertex;
                    mirrored[original] = duplicate(mesh, original);
                    mesh.tangents.back() = glm::dvec4(0);
                }
                vertex = mirrored[vertex];
            }
            const glm::dvec3 normal = mesh.normals.empty() ? face : unit(mesh.normals[vertex]);
            const glm::dvec3 a = across(normal, p[(c + 1) % 3] - p[c]), b = across(normal, p[(c + 2) % 3] - p[c]);
            const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
            mesh.tangents[vertex] = glm::dvec4(glm::dvec3(mesh.tangents[vertex]) + angle * across(normal, along), sign);
        }
        t = renamed;
    }
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        glm::dvec4& tangent = mesh.tangents[i];
        const glm::dvec3 direction = unit(glm::dvec3(tangent));
        if (direction != glm::dvec3(0))
            tangent = glm::dvec4(direction, tangent.w);
        else
            tangent = glm::dvec4(anyTangent(mesh.normals.empty() ? glm::dvec3(0, 0, 1) : unit(mesh.normals[i])), 1);
    }
}

} // namespace rt::scene
