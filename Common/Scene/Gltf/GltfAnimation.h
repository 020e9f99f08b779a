// What an animation of a file makes of its nodes at a time.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "Common/Scene/Gltf/GltfBudget.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Moment.h"

namespace rt::scene {

// What an animation sets of a node; the rest is as the node says.
struct NodePose {
    std::optional<glm::dvec3> translation;
    std::optional<glm::dvec4> rotation; // a quaternion of any length, w last
    std::optional<glm::dvec3> scale;
    std::optional<std::vector<double>> weights; // one per morph target
    bool isPlaced() const { return translation || rotation || scale; }
};

struct AnimationPose {
    std::map<std::size_t, NodePose> nodes; // those that it moves
    double seconds = 0;                    // of the last of all keyframes
};

// Of all animations, as --animation takes them.
std::vector<std::string> animationNames(const GltfFile& file);

// Of the chosen animation; before the first and after the last keyframe of a channel these two count. Channels of
// other kinds are left out. Throws InputError naming file and place, and UsageError for an animation that there is not.
AnimationPose poseAt(const GltfFile& file, const Moment& moment, GltfBudget& budget);

// Of a mesh, as many as its primitives have.
std::size_t morphTargetCount(const tinygltf::Mesh& mesh);

} // namespace rt::scene
