// The start of a file's first animation.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "Common/Scene/Gltf/GltfBudget.h"
#include "Common/Scene/Gltf/GltfFile.h"

namespace rt::scene {

// What an animation sets of a node; the rest is as the node says.
struct NodePose {
    std::optional<glm::dvec3> translation;
    std::optional<glm::dvec4> rotation; // a quaternion, w last
    std::optional<glm::dvec3> scale;
    std::optional<std::vector<double>> weights; // one per morph target
};

// By node, of the first animation at time 0: each channel's first keyframe, as keyframes are at no negative times.
// Channels of other kinds are left out. Throws InputError naming file and place.
std::map<std::size_t, NodePose> startOfAnimation(const GltfFile& file, GltfBudget& budget);

// Of a mesh, as many as its primitives have.
std::size_t morphTargetCount(const tinygltf::Mesh& mesh);

} // namespace rt::scene
