#include "Common/Scene/Gltf/GltfSkin.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "Common/Scene/Counted.h"
#include "Common/Scene/Gltf/GltfAccessor.h"

namespace rt::scene {

namespace {

std::string setName(const char* name, int set) {
    return std::string(name) + std::to_string(set);
}

constexpr double kWeightRounding = 0.02; // of the sum of eight weights in bytes, each within half of 1/255

struct VertexMaps {
    std::vector<Affine> maps;
    std::size_t rescaled = 0;
};

// The maps of all vertices, each a mean of those of its joints. Weights are scaled to the sum 1; a vertex that has none
// stays with the first joint.
VertexMaps vertexMaps(const GltfFile& file, const tinygltf::Primitive& primitive, std::span<const Affine> joints,
                      const std::vector<std::uint32_t>* elements, const std::string& place, std::size_t count) {
    std::vector<Affine> maps(count, Affine{glm::dmat3(0), glm::dvec3(0)});
    std::vector<double> sums(count, 0);
    const std::size_t vertices = accessorCount(file, primitive.attributes.at("POSITION"));
    for (int set = 0; set < jointSetCount(primitive); ++set) {
        const std::string jointsName = setName("JOINTS_", set), weightsName = setName("WEIGHTS_", set);
        const int numbers = primitive.attributes.at(jointsName), shares = primitive.attributes.at(weightsName);
        for (const std::string& name : {jointsName, weightsName})
            if (const std::size_t given = accessorCount(file, primitive.attributes.at(name)); given != vertices)
                file.fail(place + "/attributes/" + name, "has " + counted(given, "element", "elements") +
                                                             ": must be those of POSITION, " +
                                                             std::to_string(vertices));
        const std::vector<glm::dvec4> number = readVectors<4>(file, numbers, elements);
        const std::vector<glm::dvec4> weight = readVectors<4>(file, shares, elements);
        for (std::size_t i = 0; i < count; ++i)
            for (int c = 0; c < 4; ++c) {
                if (!(weight[i][c] > 0)) continue; // fills the set up
                if (!(number[i][c] >= 0 && number[i][c] < double(joints.size())))
                    file.fail(place + "/attributes/" + jointsName, "element " + std::to_string(i) + ": the skin has " +
                                                                       counted(joints.size(), "joint", "joints"));
                const Affine& joint = joints[static_cast<std::size_t>(number[i][c])];
                maps[i].linear += weight[i][c] * joint.linear;
                maps[i].offset += weight[i][c] * joint.offset;
                sums[i] += weight[i][c];
            }
    }
    std::size_t rescaled = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (std::abs(sums[i] - 1) > kWeightRounding) ++rescaled;
        if (sums[i] > 0) {
            maps[i].linear /= sums[i];
            maps[i].offset /= sums[i];
        } else {
            maps[i] = joints.front();
        }
    }
    return {std::move(maps), rescaled};
}

// What normals are mapped by, but for a positive factor: the cofactors, which need no inverse; a mirror keeps the side.
glm::dmat3 normalMap(const glm::dmat3& m) {
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::determinant(m) < 0 ? -1.0 * cofactors : cofactors;
}

glm::dvec3 unitOr(const glm::dvec3& v, const glm::dvec3& otherwise) {
    const double length = glm::length(v);
    return length > 0 ? v / length : otherwise;
}

} // namespace

int jointSetCount(const tinygltf::Primitive& primitive) {
    int set = 0;
    while (primitive.attributes.count(setName("JOINTS_", set)) > 0 &&
           primitive.attributes.count(setName("WEIGHTS_", set)) > 0)
        ++set;
    return set;
}

std::vector<Affine> jointMaps(const GltfFile& file, int index, const GltfNodes& nodes) {
    const tinygltf::Skin& skin = file.model.skins[static_cast<std::size_t>(index)];
    const std::string place = "/skins/" + std::to_string(index);
    std::vector<Affine> maps;
    for (const int joint : skin.joints) {
        const Affine* toWorld = nodes.find(static_cast<std::size_t>(joint));
        if (!toWorld) file.fail(place + "/joints", "node " + std::to_string(joint) + " is not in the scene");
        maps.push_back(*toWorld);
    }
    if (maps.empty()) file.fail(place + "/joints", "must be at least one node");
    if (skin.inverseBindMatrices < 0) return maps;
    if (accessorCount(file, skin.inverseBindMatrices) < maps.size())
        file.fail(place + "/inverseBindMatrices", "must be one for each joint");
    std::vector<std::uint32_t> elements(maps.size());
    std::iota(elements.begin(), elements.end(), 0u);
    const std::vector<glm::dmat4> inverseBind = readMatrices(file, skin.inverseBindMatrices, &elements);
    for (std::size_t i = 0; i < maps.size(); ++i)
        maps[i] = maps[i] * Affine{glm::dmat3(inverseBind[i]), glm::dvec3(inverseBind[i][3])};
    return maps;
}

std::size_t applySkin(const GltfFile& file, const tinygltf::Primitive& primitive, std::span<const Affine> joints,
                      const std::vector<std::uint32_t>* elements, const std::string& place, MeshData& mesh) {
    const auto [maps, rescaled] = vertexMaps(file, primitive, joints, elements, place, mesh.positions.size());
    for (std::size_t i = 0; i < maps.size(); ++i) {
        mesh.positions[i] = maps[i].point(mesh.positions[i]);
        if (!mesh.normals.empty())
            mesh.normals[i] = unitOr(normalMap(maps[i].linear) * mesh.normals[i], mesh.normals[i]);
        if (!mesh.tangents.empty()) {
            const glm::dvec3 along(mesh.tangents[i]);
            const double side = maps[i].mirrors() ? -mesh.tangents[i].w : mesh.tangents[i].w;
            mesh.tangents[i] = glm::dvec4(unitOr(maps[i].vector(along), along), side);
        }
    }
    for (glm::uvec3& t : mesh.triangles)
        if (maps[t.x].mirrors()) std::swap(t.y, t.z);
    return rescaled;
}

} // namespace rt::scene
