// The hierarchy of a glTF file: where its nodes are.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Gltf/GltfAnimation.h"
#include "Common/Scene/Gltf/GltfBudget.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Moment.h"

namespace rt::scene {

// Of the default scene, or the first, or all nodes where there is none; as an animation poses them.
class GltfNodes {
  public:
    struct Placed {
        std::size_t node;
        Affine toWorld;
        bool isMoved; // by the animation, or a node above is
    };

    // Throws what poseAt() throws, and InputError naming file and place where nodes form no tree. The file must outlive
    // this.
    GltfNodes(const GltfFile& file, const Moment& moment, GltfBudget& budget);

    const std::vector<Placed>& placed() const { return placed_; } // parents before their children
    const Affine* find(std::size_t node) const;                   // to the world; null: not of the scene
    // Of morph targets of a node's mesh, up to the last that is not 0.
    std::vector<double> weights(std::size_t node) const;
    double animationSeconds() const { return pose_.seconds; } // of the animation's last keyframe

  private:
    Affine localOf(std::size_t node) const;
    void place();

    const GltfFile& file_;
    AnimationPose pose_;
    std::vector<Placed> placed_;
    std::vector<std::size_t> placeOf_; // in placed_, by node
};

std::string placeOfNode(std::size_t node); // in the JSON

// Scaled, turned by a quaternion whose length counts for nothing, moved.
Affine composed(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale);

} // namespace rt::scene
