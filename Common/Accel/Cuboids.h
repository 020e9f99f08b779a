// Quads that are faces of one cuboid, which a ray can be tested against at once.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "Common/Shared/Base/Types.h"

namespace rt::accel {

struct Cuboid {
    shared::vec3 corner;
    std::array<shared::vec3, 3> edges; // from there, at right angles
    // The quads that are its faces, those through `corner` first, each three perpendicular to edges 0, 1, 2.
    std::array<std::uint32_t, 6> faces; // kNone: there is none
};

// Cuboids of four faces or more among the quads of `candidates`, from which their faces are taken. Takes time in the
// cube of their number.
std::vector<Cuboid> findCuboids(std::span<const shared::Quad> quads, std::vector<std::uint32_t>& candidates);

} // namespace rt::accel
