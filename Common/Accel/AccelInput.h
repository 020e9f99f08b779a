// What every acceleration structure is built over, whichever engine traverses it.
#pragma once
#include <span>
#include <vector>

#include "Common/Shared/Base/Types.h"

namespace rt::accel {

// The geometry of a compiled scene, as in scene::CompiledScene; read during the build only.
struct AccelInput {
    std::span<const shared::Sphere> spheres;
    std::span<const shared::vec3> motions; // displacement of each sphere over the shutter; empty: nothing moves
    std::span<const shared::Quad> quads;
    std::span<const shared::vec3> positions;
    std::span<const shared::uvec3> triangles;
    std::span<const shared::Geometry> geometries; // [0] is the world's own
    std::span<const shared::Instance> instances;
    std::span<const shared::Round> rounds{};
};

// Of each geometry whether an instance places it.
inline std::vector<bool> placedGeometries(const AccelInput& input) {
    std::vector<bool> placed(input.geometries.size(), false);
    for (const shared::Instance& instance : input.instances) placed[instance.geometry] = true;
    return placed;
}

// Of a compiled scene.
template <class Scene>
AccelInput inputOf(const Scene& s) {
    return {s.spheres, s.sphereMotions, s.quads, s.positions, s.triangles, s.geometries, s.instances, s.rounds};
}

} // namespace rt::accel
