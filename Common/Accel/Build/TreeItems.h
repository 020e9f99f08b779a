// What the tree of one geometry is built over: its spheres, quads and triangles in this order, then instances.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "Common/Accel/AccelInput.h"
#include "Common/Accel/AccelView.h"
#include "Common/Accel/Box.h"

namespace rt::accel {

// Sphere, NearSphere or MovingSphere. Where any sphere moves, all move that are not near.
LeafKind sphereKind(const AccelInput& input, std::uint32_t sphere);

class TreeItems {
  public:
    // `instances` are indices into input.instances: all that are placed in the world, none for other geometries. The
    // spans of input and `geometryBoxes` must outlive this object.
    TreeItems(const AccelInput& input, const shared::Geometry& geometry, std::vector<std::uint32_t> instances);

    std::uint32_t size() const { return firstInstance_ + static_cast<std::uint32_t>(instances_.size()); }
    LeafKind kind(std::uint32_t item) const;
    // Index into the scene's array of the item's kind.
    std::uint32_t index(std::uint32_t item) const;
    // geometryBoxes: of each geometry that an instance places.
    Box box(std::uint32_t item, std::span<const Box> geometryBoxes) const;
    // One for each item, or a single one where all are alike.
    std::vector<std::uint8_t> kinds() const;

  private:
    const AccelInput& input_;
    shared::Geometry geometry_;
    std::vector<std::uint32_t> instances_;
    std::uint32_t firstQuad_, firstTriangle_, firstRound_, firstInstance_; // items
};

} // namespace rt::accel
