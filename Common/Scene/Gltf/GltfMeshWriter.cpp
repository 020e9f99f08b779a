#include "Common/Scene/Gltf/GltfMeshWriter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace rt::scene {

namespace {

constexpr double kUnit = 1e-3; // as far as the length of what glTF wants of unit length may be from that

glm::vec3 toUnit(const glm::dvec3& v, const glm::dvec3& instead) {
    const double length = glm::length(v);
    if (!(length > 0) || !std::isfinite(length)) return instead;
    return std::abs(length - 1) <= kUnit ? v : v / length;
}

// Of a triangle at each vertex.
std::vector<glm::dvec3> facetNormals(const MeshData& data) {
    std::vector<glm::dvec3> normals(data.positions.size(), glm::dvec3(0, 0, 1));
    for (const glm::uvec3& t : data.triangles) {
        const glm::dvec3& a = data.positions[t.x];
        const glm::dvec3 n = glm::cross(data.positions[t.y] - a, data.positions[t.z] - a);
        const double length = glm::length(n);
        for (int i = 0; length > 0 && i < 3; ++i) normals[t[i]] = n / length;
    }
    return normals;
}

std::vector<glm::vec3> toNormals(const MeshData& data, bool isTurned) {
    std::vector<glm::dvec3> instead; // of those without a direction
    std::vector<glm::vec3> normals;
    normals.reserve(data.normals.size());
    for (std::size_t i = 0; i < data.normals.size(); ++i) {
        if (!(glm::length(data.normals[i]) > 0) && instead.empty()) instead = facetNormals(data);
        const glm::vec3 normal = toUnit(data.normals[i], instead.empty() ? glm::dvec3(0, 0, 1) : instead[i]);
        normals.push_back(isTurned ? -normal : normal);
    }
    return normals;
}

std::vector<glm::vec4> toTangents(const MeshData& data) {
    std::vector<glm::vec4> tangents;
    tangents.reserve(data.tangents.size());
    for (const glm::dvec4& tangent : data.tangents)
        tangents.emplace_back(toUnit(tangent, {1, 0, 0}), tangent.w < 0 ? -1.0f : 1.0f);
    return tangents;
}

std::vector<glm::vec2> toUvs(const std::vector<glm::dvec2>& uvs) {
    std::vector<glm::vec2> result;
    result.reserve(uvs.size());
    for (const glm::dvec2& uv : uvs) result.emplace_back(uv.x, 1 - uv.y);
    return result;
}

bool hasClearVertices(const MeshData& data) {
    return std::any_of(data.colors.begin(), data.colors.end(), [](const glm::dvec4& c) { return c.a != 1; });
}

} // namespace

GltfMeshWriter::Accessors GltfMeshWriter::write(const MeshData& data, bool isTurned, bool hasColors, bool hasOpacity) {
    std::vector<glm::vec3> positions;
    positions.reserve(data.positions.size());
    for (const glm::dvec3& p : data.positions) positions.emplace_back(p);
    Accessors result;
    result.attributes["POSITION"] = document_.addVertices(positions, true);
    if (!data.normals.empty()) {
        result.attributes["NORMAL"] = document_.addVertices(toNormals(data, isTurned));
        if (!data.tangents.empty()) result.attributes["TANGENT"] = document_.addVertices(toTangents(data));
    }
    if (!data.uvs.empty()) result.attributes["TEXCOORD_0"] = document_.addVertices(toUvs(data.uvs));
    if (!data.uvs2.empty()) {
        if (data.uvs.empty()) result.attributes["TEXCOORD_0"] = document_.addVertices(toUvs(data.uvs2));
        result.attributes["TEXCOORD_1"] = document_.addVertices(toUvs(data.uvs2));
    }
    if (hasColors && hasOpacity) {
        result.attributes["COLOR_0"] =
            document_.addVertices(std::vector<glm::vec4>(data.colors.begin(), data.colors.end()));
    } else if (hasColors) {
        std::vector<glm::vec3> colors;
        for (const glm::dvec4& color : data.colors) colors.emplace_back(color);
        result.attributes["COLOR_0"] = document_.addVertices(colors);
    }
    std::vector<glm::uvec3> triangles = data.triangles;
    if (isTurned)
        for (glm::uvec3& t : triangles) std::swap(t.y, t.z);
    result.indices = document_.addIndices(triangles, data.positions.size());
    return result;
}

OrderedJson GltfMeshWriter::primitive(const MeshData& data, const std::string& material, bool isKept) {
    const bool isTurned = materials_.isTurned(material);
    const bool hasColors = !data.colors.empty() && materials_.find(material).kind == MaterialKind::Principled;
    const bool blends = hasColors && hasClearVertices(data);
    const std::tuple key(&data, isTurned, hasColors, blends);
    auto known = accessors_.find(key);
    if (known == accessors_.end()) known = accessors_.emplace(key, write(data, isTurned, hasColors, blends)).first;
    OrderedJson result = {{"attributes", known->second.attributes},
                          {"indices", known->second.indices},
                          {"material", materials_.index(material, blends)}};
    if (!isKept) accessors_.erase(known);
    return result;
}

std::optional<int> GltfMeshWriter::mesh(const std::vector<Surface>& surfaces, const std::string& name) {
    std::vector<std::pair<const MeshData*, std::string>> key;
    for (const Surface& surface : surfaces)
        if (!surface.data->triangles.empty()) key.emplace_back(surface.data, surface.material);
    if (key.empty()) return std::nullopt;
    const auto [entry, isNew] = meshes_.try_emplace(key, 0);
    if (!isNew) return entry->second;
    OrderedJson mesh = {{"name", name}, {"primitives", OrderedJson::array()}};
    for (const auto& [data, material] : key) mesh["primitives"].push_back(primitive(*data, material, true));
    return entry->second = document_.add("meshes", std::move(mesh));
}

std::optional<int> GltfMeshWriter::ownMesh(const MeshData& data, const std::string& material, const std::string& name) {
    if (data.triangles.empty()) {
        notices_.add("surfaces without area are left out");
        return std::nullopt;
    }
    OrderedJson primitives = OrderedJson::array({primitive(data, material, false)});
    return document_.add("meshes", {{"name", name}, {"primitives", std::move(primitives)}});
}

} // namespace rt::scene
