// Many rays at once through one acceleration structure, for callers that are not kernels themselves: tools, tests and
// benchmarks. Kernels include Traverse.h.
#pragma once
#include <cstddef>
#include <cstdint>

#include "Common/Accel/AccelView.h"
#include "Common/Core/CpuFeatures.h"

namespace rt::accel {

// Traversal compiled for one instruction set; arrays of `count` elements. (No spans: what a kernel's object file takes
// from the standard library, it could hand to code for lesser processors.)
struct RayQuery {
    // hits[i]: what rays[i] hits first with t in (0, tMax[i]), as traceClosest() reports it.
    void (*closest)(const AccelView& view, const shared::Ray* rays, const float* tMax, shared::Hit* hits,
                    std::size_t count);
    // hits[i]: 1 if rays[i] hits anything with t in (0, tMax[i]), else 0.
    void (*any)(const AccelView& view, const shared::Ray* rays, const float* tMax, std::uint8_t* hits,
                std::size_t count);
};

// The query for an instruction set; null if this build has none for it. The processor must have the instruction set.
const RayQuery* rayQuery(InstructionSet set);

// The fastest one that the processor runs.
const RayQuery& rayQuery();

}  // namespace rt::accel
