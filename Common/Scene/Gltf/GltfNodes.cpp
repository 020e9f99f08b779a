#include "Common/Scene/Gltf/GltfNodes.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "Common/Core/Interruption.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Placing.h"

namespace rt::scene {

namespace {

constexpr std::size_t kNowhere = ~std::size_t{0};

glm::dvec3 vector3(const std::vector<double>& v) {
    return {v[0], v[1], v[2]};
}

glm::dvec4 vector4(const std::vector<double>& v) {
    return {v[0], v[1], v[2], v[3]};
}

} // namespace

std::string placeOfNode(std::size_t node) {
    return "/nodes/" + std::to_string(node);
}

Affine composed(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale) {
    const glm::dquat turn(rotation.w, rotation.x, rotation.y, rotation.z);
    const glm::dmat3 rotate = glm::dot(turn, turn) > 0 ? glm::mat3_cast(glm::normalize(turn)) : glm::dmat3(1);
    return {rotate * glm::dmat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z), translation};
}

GltfNodes::GltfNodes(const GltfFile& file, const Moment& moment, GltfBudget& budget)
    : file_(file), pose_(poseAt(file, moment, budget)), placeOf_(file.model.nodes.size(), kNowhere) {
    place();
}

const Affine* GltfNodes::find(std::size_t node) const {
    return placeOf_[node] == kNowhere ? nullptr : &placed_[placeOf_[node]].toWorld;
}

std::vector<double> GltfNodes::weights(std::size_t index) const {
    const tinygltf::Node& node = file_.model.nodes[index];
    const tinygltf::Mesh& mesh = file_.model.meshes[static_cast<std::size_t>(node.mesh)];
    const auto pose = pose_.nodes.find(index);
    std::vector<double> weights = pose != pose_.nodes.end() && pose->second.weights ? *pose->second.weights
                                  : node.weights.empty()                            ? mesh.weights
                                                                                    : node.weights;
    weights.resize(std::min(weights.size(), morphTargetCount(mesh)));
    while (!weights.empty() && weights.back() == 0) weights.pop_back();
    return weights;
}

Affine GltfNodes::localOf(std::size_t index) const {
    const tinygltf::Node& node = file_.model.nodes[index];
    const auto check = [&](const std::vector<double>& values, std::size_t count, const char* name) {
        if (!values.empty() && values.size() != count)
            file_.fail(placeOfNode(index) + "/" + name, "must be " + std::to_string(count) + " numbers");
        return !values.empty();
    };
    if (check(node.matrix, 16, "matrix")) { // which no animation may change
        Affine local;
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                local.linear[column][row] = node.matrix[static_cast<std::size_t>(4 * column + row)];
        local.offset = {node.matrix[12], node.matrix[13], node.matrix[14]};
        return local;
    }
    glm::dvec3 translation(0), scale(1);
    glm::dvec4 rotation(0, 0, 0, 1);
    if (check(node.translation, 3, "translation")) translation = vector3(node.translation);
    if (check(node.rotation, 4, "rotation")) rotation = vector4(node.rotation);
    if (check(node.scale, 3, "scale")) scale = vector3(node.scale);
    if (const auto pose = pose_.nodes.find(index); pose != pose_.nodes.end()) {
        translation = pose->second.translation.value_or(translation);
        rotation = pose->second.rotation.value_or(rotation);
        scale = pose->second.scale.value_or(scale);
    }
    return composed(translation, rotation, scale);
}

// Without recursion, and each node once: a hierarchy that is no tree is refused.
void GltfNodes::place() {
    struct Pending {
        std::size_t node;
        Affine parent;
        bool isMoved;
    };
    const tinygltf::Model& model = file_.model;
    std::vector<Pending> pending;
    const auto push = [&](const std::vector<int>& nodes, const Affine& parent, bool isMoved) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
            pending.push_back({static_cast<std::size_t>(*node), parent, isMoved});
    };
    if (model.scenes.empty()) { // all nodes that are nobody's children
        std::vector<bool> isChild(model.nodes.size(), false);
        for (const tinygltf::Node& node : model.nodes)
            for (const int child : node.children) isChild[static_cast<std::size_t>(child)] = true;
        for (std::size_t i = model.nodes.size(); i-- > 0;)
            if (!isChild[i]) pending.push_back({i, {}, false});
    } else {
        push(model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))].nodes, {}, false);
    }
    while (!pending.empty()) {
        interruptionPoint();
        const Pending next = pending.back();
        pending.pop_back();
        if (find(next.node)) file_.fail(placeOfNode(next.node), "is reached twice: nodes must form a tree");
        const Affine toWorld = next.parent * localOf(next.node);
        if (!isWithinLimits(toWorld)) file_.fail(placeOfNode(next.node), "its transform exceeds 1e9");
        placeOf_[next.node] = placed_.size();
        const auto pose = pose_.nodes.find(next.node);
        const bool isMoved = next.isMoved || (pose != pose_.nodes.end() && pose->second.isPlaced());
        placed_.push_back({next.node, toWorld, isMoved});
        push(model.nodes[next.node].children, toWorld, isMoved);
    }
}

} // namespace rt::scene
