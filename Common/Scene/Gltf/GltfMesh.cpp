#include "Common/Scene/Gltf/GltfMesh.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "Common/Core/Interruption.h"
#include "Common/Scene/Gltf/GltfAccessor.h"
#include "Common/Scene/Tangents.h"

namespace rt::scene {

namespace {

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
