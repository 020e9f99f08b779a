// Primitives into the lanes of leaf blocks.
#pragma once
#include <algorithm>
#include <limits>

#include "Common/Accel/AccelInput.h"
#include "Common/Accel/AccelView.h"
#include "Common/Shared/Shape/Rounds.h"
#include "Common/Shared/Shape/Shapes.h"

namespace rt::accel {

// A block without primitives: NaN in every lane.
template <class Block>
Block emptyBlock() {
    static_assert(sizeof(Block) % sizeof(float) == 0);
    Block block;
    float* values = reinterpret_cast<float*>(&block);
    std::fill_n(values, sizeof(Block) / sizeof(float), std::numeric_limits<float>::quiet_NaN());
    std::fill(std::begin(block.primitive), std::end(block.primitive), shared::kNone);
    return block;
}

inline void setLane(float (&components)[3][kWidth], std::uint32_t lane, shared::vec3 v) {
    for (int a = 0; a < 3; ++a) {
        components[a][lane] = v[a];
    }
}

inline void fillLane(SphereBlock& block, std::uint32_t lane, const AccelInput& input, std::uint32_t index) {
    const shared::Sphere& sphere = input.spheres[index];
    setLane(block.center, lane, sphere.center);
    block.radius[lane] = sphere.radius;
    block.primitive[lane] = index;
}

inline void fillLane(NearSphereBlock& block, std::uint32_t lane, const AccelInput& input, std::uint32_t index) {
    const shared::Sphere& sphere = input.spheres[index];
    setLane(block.center, lane, sphere.center);
    block.radius[lane] = sphere.radius;
    block.power[lane] = sphere.power;
    block.primitive[lane] = index;
}

inline void fillLane(MovingSphereBlock& block, std::uint32_t lane, const AccelInput& input, std::uint32_t index) {
    const shared::Sphere& sphere = input.spheres[index];
    setLane(block.center, lane, sphere.center);
    setLane(block.motion, lane, input.motions[index]);
    block.radius[lane] = sphere.radius;
    block.primitive[lane] = index;
}

inline void fillLane(QuadBlock& block, std::uint32_t lane, const AccelInput& input, std::uint32_t index) {
    const shared::Quad& quad = input.quads[index];
    const shared::QuadFrame frame = shared::quadFrame(quad.edgeU, quad.edgeV);
    setLane(block.corner, lane, quad.corner);
    setLane(block.normal, lane, frame.normal);
    setLane(block.dualU, lane, frame.dualU);
    setLane(block.dualV, lane, frame.dualV);
    block.margin[0][lane] = frame.margin.x;
    block.margin[1][lane] = frame.margin.y;
    block.primitive[lane] = index;
}

inline void fillLane(TriangleBlock& block, std::uint32_t lane, const AccelInput& input, std::uint32_t index) {
    const shared::uvec3 vertices = input.triangles[index];
    for (int i = 0; i < 3; ++i) {
        setLane(block.vertex[i], lane, input.positions[vertices[i]]);
    }
    block.primitive[lane] = index;
}

inline void fillLane(RoundBlock& block, std::uint32_t lane, const AccelInput& input, std::uint32_t index) {
    const shared::Round& round = input.rounds[index];
    const shared::RoundFrame frame = shared::roundFrame(round.edgeU, round.edgeV, round.axis);
    setLane(block.origin, lane, round.origin);
    setLane(block.dualU, lane, frame.dualU);
    setLane(block.dualV, lane, frame.dualV);
    setLane(block.dualW, lane, frame.dualW);
    block.hole[lane] = round.hole;
    block.primitive[lane] = index;
}

} // namespace rt::accel
