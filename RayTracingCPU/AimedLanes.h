// Scattering that is aimed at a sphere of glass, for sixteen paths. The values are those of one path alone
// (AimedScattering.h), bit for bit.
// Included by one translation unit per instruction set; all it defines has internal linkage.
#pragma once
#include "RayTracingCPU/PathLanes.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// aimedShare() of the paths `first`; of the others none. False: there is none at all.
RT_CALL bool findAimedShares(const AimedSphere& sphere, uint first, PathLanes& lanes) {
    const Vec3Lanes& positions = lanesOf<&Vertex::origin>(lanes.vertices);
    for (uint i = 0u; i < kLanes; ++i) {
        const float share = aimedShare(sphere, get(positions, i), lanes.total.at[i]);
        lanes.aimedShare.at[i] = (first >> i & 1u) != 0u ? share : 0.0f;
    }
    uint any = 0u;
    for (uint i = 0u; i < kLanes; ++i) any |= lanes.aimedShare.at[i] > 0.0f ? 1u : 0u;
    return any != 0u;
}

// aimScattering() of all paths, whose diffuse samples are there.
RT_CALL void aimScattering(const AimedSphere& sphere, PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        const Vertex v = get(lanes.vertices, i);
        const VertexSamples u = get(lanes.u, i);
        const float share = lanes.aimedShare.at[i];
        set(lanes.aimed, i, aimScattering(sphere, v, u.bsdf, u.roulette.y, share, diffuseSample(lanes, i)));
    }
}

} // namespace
} // namespace rt::cpu
