// Traversal, compiled once for each instruction set and each set of primitives that pays. It is the one part of
// rendering that gains by the widest registers, so callers choose it at run time, and a call costs nothing beside it.
#pragma once
#include <cstddef>
#include <cstdint>

#include "Common/Accel/AccelView.h"
#include "Common/Core/CpuFeatures.h"

namespace rt::accel {

// One ray through a structure that holds no other kinds of primitives than those the functions were chosen for.
struct Tracer {
    // What the ray hits first with t in (0, tMax), as traceClosest() reports it.
    shared::Hit (*closest)(const AccelView& view, const shared::Ray& ray, float tMax) = nullptr;
    // Whether it hits anything there.
    bool (*occluded)(const AccelView& view, const shared::Ray& ray, float tMax) = nullptr;
    // Both for rays from one point, faster in small scenes: what `ray` hits first with t > 0, and whether one in the
    // direction of the shadow ray hits anything with t in (0, shadowEnd).
    shared::Hit (*both)(const AccelView& view, const shared::Ray& ray, const shared::vec3& shadowDirection,
                        float shadowEnd, bool& isOccluded) = nullptr;
};

// Traversal compiled for one instruction set; arrays of `count` elements. (No spans: what a kernel's object file takes
// from the standard library, it could hand to code for lesser processors.)
struct RayQuery {
    // `kinds`: AccelView::kinds, feature bits.
    Tracer (*tracer)(shared::Features kinds);
    // hits[i]: what rays[i] hits first with t in (0, tMax[i]), as traceClosest() reports it.
    void (*closest)(const AccelView& view, const shared::Ray* rays, const float* tMax, shared::Hit* hits,
                    std::size_t count);
    // hits[i]: 1 if rays[i] hits anything with t in (0, tMax[i]), else 0.
    void (*any)(const AccelView& view, const shared::Ray* rays, const float* tMax, std::uint8_t* hits,
                std::size_t count);
};

// The query for an instruction set; null if this build has none for it. The processor must have the instruction set.
const RayQuery* rayQuery(InstructionSet set);

// The newest instruction set that this build has kernels for and that the processor runs. Throws UsageError if there is
// none.
InstructionSet usableInstructionSet();

// The query of that instruction set.
const RayQuery& rayQuery();

} // namespace rt::accel
