#include "Common/Accel/Build/TreeItems.h"

#include <utility>

#include "Common/Accel/Build/PrimitiveBoxes.h"

namespace rt::accel {

LeafKind sphereKind(const AccelInput& input, std::uint32_t sphere) {
    if (input.spheres[sphere].power < shared::kInfinity) return LeafKind::NearSphere;
    return input.motions.empty() ? LeafKind::Sphere : LeafKind::MovingSphere;
}

TreeItems::TreeItems(const AccelInput& input, const shared::Geometry& geometry, std::vector<std::uint32_t> instances)
    : input_(input),
      geometry_(geometry),
      instances_(std::move(instances)),
      firstQuad_(geometry.sphereCount),
      firstTriangle_(firstQuad_ + geometry.quadCount),
      firstRound_(firstTriangle_ + geometry.triangleCount),
      firstInstance_(firstRound_ + geometry.roundCount) {}

LeafKind TreeItems::kind(std::uint32_t item) const {
    if (item < firstQuad_) return sphereKind(input_, geometry_.firstSphere + item);
    if (item < firstTriangle_) return LeafKind::Quad;
    if (item < firstRound_) return LeafKind::Triangle;
    return item < firstInstance_ ? LeafKind::Round : LeafKind::Instance;
}

std::uint32_t TreeItems::index(std::uint32_t item) const {
    if (item < firstQuad_) return geometry_.firstSphere + item;
    if (item < firstTriangle_) return geometry_.firstQuad + (item - firstQuad_);
    if (item < firstRound_) return geometry_.firstTriangle + (item - firstTriangle_);
    if (item < firstInstance_) return geometry_.firstRound + (item - firstRound_);
    return instances_[item - firstInstance_];
}

Box TreeItems::box(std::uint32_t item, std::span<const Box> geometryBoxes) const {
    const std::uint32_t i = index(item);
    switch (kind(item)) {
        case LeafKind::Sphere:
        case LeafKind::NearSphere:
            return boxOf(input_.spheres[i]);
        case LeafKind::MovingSphere:
            return boxOf(input_.spheres[i], input_.motions[i]);
        case LeafKind::Quad:
            return boxOf(input_.quads[i]);
        case LeafKind::Round:
            return boxOf(input_.rounds[i]);
        case LeafKind::Instance:
            return boxOf(input_.instances[i], geometryBoxes[input_.instances[i].geometry]);
        case LeafKind::Triangle:
            break;
    }
    const shared::uvec3 v = input_.triangles[i];
    return boxOf(input_.positions[v.x], input_.positions[v.y], input_.positions[v.z]);
}

std::vector<std::uint8_t> TreeItems::kinds() const {
    if (size() == 0) return {};
    std::uint32_t alike = 1;
    while (alike < size() && kind(alike) == kind(0)) ++alike;
    if (alike == size()) return {static_cast<std::uint8_t>(kind(0))};
    std::vector<std::uint8_t> result(size());
    for (std::uint32_t i = 0; i < size(); ++i) {
        result[i] = static_cast<std::uint8_t>(kind(i));
    }
    return result;
}

} // namespace rt::accel
