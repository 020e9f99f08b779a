#include "Common/Scene/Gltf/GltfMesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "Common/Core/Interruption.h"
#include "Common/Scene/Gltf/GltfAccessor.h"

namespace rt::scene {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

std::optional<int> attribute(const tinygltf::Primitive& primitive, const char* name) {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return std::nullopt;
    return found->second;
}

bool isTriangles(int mode) {
    return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

// ---- connectivity --------------------------------------------------------------------------------------------------

// 3.7.2.1 of the specification; corners that complete no triangle count for nothing.
std::vector<glm::uvec3> trianglesOf(const std::vector<std::uint32_t>& v, int mode) {
    std::vector<glm::uvec3> triangles;
    if (v.size() < 3) return triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        triangles.reserve(v.size() / 3);
        for (std::size_t i = 0; i + 2 < v.size(); i += 3) triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
        return triangles;
    }
    const bool isStrip = mode == TINYGLTF_MODE_TRIANGLE_STRIP;
    triangles.reserve(v.size() - 2);
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
        const glm::uvec3 t =
            isStrip ? glm::uvec3(v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]) : glm::uvec3(v[i + 1], v[i + 2], v[0]);
        if (t.x != t.y && t.y != t.z && t.z != t.x) triangles.push_back(t); // strips are joined by those without area
    }
    return triangles;
}

// Renames corners so that vertices are those in use alone, and returns these: many primitives may share a large array.
std::vector<std::uint32_t> compact(std::vector<std::uint32_t>& corners) {
    std::vector<std::uint32_t> used = corners;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& corner : corners)
        corner = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), corner) - used.begin());
    return used;
}

// ---- tangents ------------------------------------------------------------------------------------------------------

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

// Sums the direction of growing u over the triangles at a vertex, by the angle there, apart for each orientation of
// the texture (M. Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, as his MikkTSpace does).
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

} // namespace

std::uint64_t cornerCount(const GltfFile& file, const tinygltf::Primitive& primitive) {
    const std::optional<int> positions = attribute(primitive, "POSITION");
    if (!positions || !isTriangles(primitive.mode)) return 0;
    const std::size_t count = accessorCount(file, primitive.indices >= 0 ? primitive.indices : *positions);
    return primitive.mode == TINYGLTF_MODE_TRIANGLES ? count : 3 * std::uint64_t{count};
}

MeshData readPrimitive(const GltfFile& file, const tinygltf::Primitive& primitive, bool isOpaque,
                       std::optional<std::uint32_t> tangentSet, const std::string& place) {
    interruptionPoint();
    MeshData mesh;
    const std::optional<int> positions = attribute(primitive, "POSITION");
    if (!positions || !isTriangles(primitive.mode)) return mesh;
    const std::size_t count = accessorCount(file, *positions);

    std::vector<std::uint32_t> corners;
    if (primitive.indices >= 0) {
        corners = readIndices(file, primitive.indices);
        for (const std::uint32_t corner : corners)
            if (corner >= count)
                file.fail(place + "/indices",
                          "index " + std::to_string(corner) + ": there are " + std::to_string(count) + " vertices");
    } else {
        corners.resize(count);
        std::iota(corners.begin(), corners.end(), 0u);
    }
    std::optional<std::vector<std::uint32_t>> used;
    if (count > corners.size()) used = compact(corners);
    const std::vector<std::uint32_t>* elements = used ? &*used : nullptr;
    mesh.triangles = trianglesOf(corners, primitive.mode);

    const auto find = [&](const char* name) {
        const std::optional<int> accessor = attribute(primitive, name);
        if (accessor && accessorCount(file, *accessor) != count)
            file.fail(place + "/attributes/" + name, "has " + std::to_string(accessorCount(file, *accessor)) +
                                                         " elements: must be those of POSITION, " +
                                                         std::to_string(count));
        return accessor;
    };
    const auto readUvs = [&](const char* name) {
        std::vector<glm::dvec2> uvs;
        if (const auto accessor = find(name)) uvs = readVectors<2>(file, *accessor, elements);
        for (glm::dvec2& uv : uvs) uv.y = 1 - uv.y;
        return uvs;
    };
    mesh.positions = readVectors<3>(file, *positions, elements);
    if (const auto accessor = find("NORMAL")) mesh.normals = readVectors<3>(file, *accessor, elements);
    mesh.uvs = readUvs("TEXCOORD_0");
    mesh.uvs2 = readUvs("TEXCOORD_1");
    if (const auto accessor = find("COLOR_0")) mesh.colors = readColors(file, *accessor, elements);
    if (isOpaque)
        for (glm::dvec4& color : mesh.colors) color.a = 1;
    if (!tangentSet || (*tangentSet == 0 ? mesh.uvs : mesh.uvs2).empty()) return mesh;
    const std::optional<int> tangents = find("TANGENT");
    if (tangents && !mesh.normals.empty())
        mesh.tangents = readVectors<4>(file, *tangents, elements);
    else
        addTangents(mesh, *tangentSet);
    return mesh;
}

} // namespace rt::scene
