// The specialization constants of a render: what is the same for all of its paths, known before its shaders are
// compiled.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include <vulkan/vulkan.h>

#include "Common/Accel/GpuBvh.h"
#include "Common/Shared/Base/Types.h"
#include "Shaders/SpecializationIds.h"

namespace rt::gpu {

// What compute shaders trace rays through.
struct TraversalShape {
    std::uint32_t groupSize = 64; // invocations of a work group
    std::uint32_t treeDepth = 0;
    std::uint32_t treeIsWide = 0;
    std::uint32_t isLinear = 0;
    std::uint32_t listedNearSpheres = 0;
    std::uint32_t listedSpheres = 0;
    std::array<std::uint32_t, 3> listedAxisQuads{}; // perpendicular to x, y, z
    std::uint32_t listedCuboids = 0;
    std::uint32_t listedQuads = 0; // all others
    std::uint32_t listedTriangles = 0;
    std::uint32_t listedRounds = 0;
    bool operator==(const TraversalShape&) const = default;
};

TraversalShape traversalShape(const accel::GpuBvh& bvh);

struct SpecializationConstants {
    shared::Features features;
    std::uint32_t lightSampling = 0;
    std::uint32_t lightSelection = 0;
    std::uint32_t sphereLight = 0;
    std::uint32_t quadLight = 0;
    std::uint32_t triangleLight = 0;
    std::uint32_t samplerKind = 0;
    std::uint32_t russianRoulette = 0;
    std::uint32_t methods = 0;    // RenderParams::methods
    std::uint32_t lightCount = 0; // of a table that is weighed light by light, otherwise 0, if any is used
    TraversalShape traversal;     // of the compute engine
    bool operator==(const SpecializationConstants&) const = default;
};

// `lights`: how many lights proper the scene has.
SpecializationConstants makeSpecializationConstants(shared::Features features, const shared::RenderParams& params,
                                                    std::uint32_t lights, const TraversalShape& traversal);

// Of constants that must live as long as the result. Those that a shader does not have are ignored.
VkSpecializationInfo specializationInfo(const SpecializationConstants& constants);

} // namespace rt::gpu
