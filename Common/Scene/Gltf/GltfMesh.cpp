#include "Common/Scene/Gltf/GltfMesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <vector>

#include "Common/Core/Interruption.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Gltf/GltfAccessor.h"
#include "Common/Scene/Gltf/GltfSkin.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Tangents.h"

namespace rt::scene {

namespace {

constexpr std::size_t kEnoughForThreads = 1u << 14; // of which attributes are read at the same time

std::optional<int> attribute(const std::map<std::string, int>& attributes, const char* name) {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return std::nullopt;
    return found->second;
}

// ---- connectivity --------------------------------------------------------------------------------------------------

// 3.7.2.1 of the specification; corners that complete no triangle count for nothing.
std::vector<glm::uvec3> trianglesOf(const std::vector<std::uint32_t>& v, int mode) {
    std::vector<glm::uvec3> triangles;
    if (v.size() < 3) return triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        reserveLarge(triangles, v.size() / 3);
        for (std::size_t i = 0; i + 2 < v.size(); i += 3) triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
        return triangles;
    }
    const bool isStrip = mode == TINYGLTF_MODE_TRIANGLE_STRIP;
    reserveLarge(triangles, v.size() - 2);
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

// Of vertices, in the pose that morph targets give them.
class VertexReader {
  public:
    // `elements`: the vertices to be read; null: all of `count`.
    VertexReader(const GltfFile& file, const tinygltf::Primitive& primitive, const PrimitiveUse& use,
                 const std::vector<std::uint32_t>* elements, std::size_t count, const std::string& place)
        : file_(file), primitive_(primitive), use_(use), elements_(elements), count_(count), place_(place) {}

    std::optional<int> find(const char* name) const { return find(primitive_.attributes, name, "/attributes/"); }

    // Empty where there are none. Morph targets change the first three components.
    template <int N>
    std::vector<glm::vec<N, double>> vectors(const char* name) const {
        constexpr int kMorphed = std::min(N, 3);
        const auto accessor = find(name);
        if (!accessor) return {};
        auto values = readVectors<N>(file_, *accessor, elements_);
        for (std::size_t target = 0; target < std::min(use_.weights.size(), primitive_.targets.size()); ++target) {
            const double weight = use_.weights[target];
            if (weight == 0) continue;
            const auto changed = find(primitive_.targets[target], name, "/targets/" + std::to_string(target) + "/");
            if (!changed) continue;
            const auto changes = readVectors<kMorphed>(file_, *changed, elements_);
            for (std::size_t i = 0; i < values.size(); ++i)
                for (int c = 0; c < kMorphed; ++c) values[i][c] += weight * changes[i][c];
        }
        return values;
    }
    std::vector<glm::dvec2> uvs(const char* name) const {
        auto uvs = vectors<2>(name);
        for (glm::dvec2& uv : uvs) uv.y = 1 - uv.y;
        return uvs;
    }

  private:
    std::optional<int> find(const std::map<std::string, int>& attributes, const char* name,
                            const std::string& folder) const {
        const std::optional<int> accessor = attribute(attributes, name);
        if (accessor && accessorCount(file_, *accessor) != count_)
            file_.fail(place_ + folder + name, "has " +
                                                   counted(accessorCount(file_, *accessor), "element", "elements") +
                                                   ": must be those of POSITION, " + std::to_string(count_));
        return accessor;
    }

    const GltfFile& file_;
    const tinygltf::Primitive& primitive_;
    const PrimitiveUse& use_;
    const std::vector<std::uint32_t>* elements_;
    std::size_t count_;
    const std::string& place_;
};

// Numbers of vertices, three by three or as strips and fans have them.
std::vector<std::uint32_t> readCorners(const GltfFile& file, const tinygltf::Primitive& primitive, std::size_t count,
                                       const std::string& place) {
    std::vector<std::uint32_t> corners;
    if (primitive.indices < 0) {
        corners.resize(count);
        std::iota(corners.begin(), corners.end(), 0u);
        return corners;
    }
    corners = readIndices(file, primitive.indices);
    for (const std::uint32_t corner : corners)
        if (corner >= count)
            file.fail(place + "/indices", "index " + std::to_string(corner) +
                                              ": must be below the number of vertices, " + std::to_string(count));
    return corners;
}

void checkPositions(const GltfFile& file, const MeshData& mesh, const std::string& place) {
    for (const glm::dvec3& p : mesh.positions)
        for (int c = 0; c < 3; ++c)
            if (!(std::abs(p[c]) <= kLargest)) file.fail(place, "its pose moves vertices beyond 1e9");
}

} // namespace

bool isTriangles(const tinygltf::Primitive& primitive) {
    return attribute(primitive.attributes, "POSITION") &&
           (primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
            primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN);
}

std::uint64_t elementCount(const GltfFile& file, const tinygltf::Primitive& primitive, const PrimitiveUse& use) {
    if (!isTriangles(primitive)) return 0;
    const std::uint64_t count = accessorCount(file, *attribute(primitive.attributes, "POSITION"));
    const std::uint64_t corners = primitive.indices >= 0 ? accessorCount(file, primitive.indices) : count;
    std::uint64_t elements = primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners : 3 * corners;
    for (const auto& [name, accessor] : primitive.attributes) elements += sparseCount(file, accessor);
    for (std::size_t target = 0; target < std::min(use.weights.size(), primitive.targets.size()); ++target)
        if (use.weights[target] != 0)
            for (const auto& [name, accessor] : primitive.targets[target])
                elements += std::min(corners, count) + sparseCount(file, accessor);
    if (!use.joints.empty())
        elements += std::min(corners, count) * static_cast<std::uint64_t>(jointSetCount(primitive));
    return elements;
}

MeshData readPrimitive(const GltfFile& file, const tinygltf::Primitive& primitive, const PrimitiveUse& use,
                       const std::string& place, std::size_t& rescaled) {
    interruptionPoint();
    MeshData mesh;
    if (!isTriangles(primitive) || elementCount(file, primitive, use) == 0) return mesh;
    const std::size_t count = accessorCount(file, *attribute(primitive.attributes, "POSITION"));
    std::vector<std::uint32_t> corners = readCorners(file, primitive, count, place);
    std::optional<std::vector<std::uint32_t>> used;
    if (count > corners.size()) used = compact(corners);
    const std::vector<std::uint32_t>* elements = used ? &*used : nullptr;

    const VertexReader reader(file, primitive, use, elements, count, place);
    const std::function<void()> parts[] = {
        [&] {
            mesh.triangles = trianglesOf(corners, primitive.mode);
            release(corners);
        },
        [&] { mesh.positions = reader.vectors<3>("POSITION"); },
        [&] { mesh.normals = reader.vectors<3>("NORMAL"); },
        [&] { mesh.uvs = reader.uvs("TEXCOORD_0"); },
        [&] { mesh.uvs2 = reader.uvs("TEXCOORD_1"); },
        [&] {
            if (const auto colors = reader.find("COLOR_0")) mesh.colors = readColors(file, *colors, elements);
        },
    };
    parallelFor(count < kEnoughForThreads ? 1 : 0, std::size(parts), [&](std::size_t i) { parts[i](); });
    if (use.isOpaque)
        for (glm::dvec4& color : mesh.colors) color.a = 1;
    const bool hasUvs = use.tangentSet && !(*use.tangentSet == 0 ? mesh.uvs : mesh.uvs2).empty();
    if ((hasUvs || use.isStretched) && !mesh.normals.empty()) mesh.tangents = reader.vectors<4>("TANGENT");
    if (!use.joints.empty()) rescaled = applySkin(file, primitive, use.joints, elements, place, mesh);
    checkPositions(file, mesh, place);
    if (hasUvs && mesh.tangents.empty()) addTangents(mesh, *use.tangentSet);
    return mesh;
}

} // namespace rt::scene
