#include "RayTracingGPU/SpecializationConstants.h"

#include "Common/Shared/Path/DirectLight.h"

namespace rt::gpu {
namespace {

constexpr std::size_t kFeatures = offsetof(SpecializationConstants, features);
constexpr std::size_t kTraversal = offsetof(SpecializationConstants, traversal);
constexpr std::size_t kAxisQuads = kTraversal + offsetof(TraversalShape, listedAxisQuads);
constexpr std::size_t kConstantCount = sizeof(SpecializationConstants) / sizeof(std::uint32_t);

constexpr VkSpecializationMapEntry entry(std::uint32_t id, std::size_t offset) {
    return {id, static_cast<std::uint32_t>(offset), sizeof(std::uint32_t)};
}

constexpr std::array kEntries{
    entry(shared::kSceneFeaturesId, kFeatures + offsetof(shared::Features, scene)),
    entry(shared::kMaterialFeaturesId, kFeatures + offsetof(shared::Features, materials)),
    entry(shared::kMethodsId, kFeatures + offsetof(shared::Features, methods)),
    entry(shared::kLightSamplingId, offsetof(SpecializationConstants, lightSampling)),
    entry(shared::kLightSelectionId, offsetof(SpecializationConstants, lightSelection)),
    entry(shared::kSphereLightId, offsetof(SpecializationConstants, sphereLight)),
    entry(shared::kQuadLightId, offsetof(SpecializationConstants, quadLight)),
    entry(shared::kTriangleLightId, offsetof(SpecializationConstants, triangleLight)),
    entry(shared::kSamplerKindId, offsetof(SpecializationConstants, samplerKind)),
    entry(shared::kRussianRouletteId, offsetof(SpecializationConstants, russianRoulette)),
    entry(shared::kMethodsInUseId, offsetof(SpecializationConstants, methods)),
    entry(shared::kLightCountId, offsetof(SpecializationConstants, lightCount)),
    entry(shared::kGroupSizeId, kTraversal + offsetof(TraversalShape, groupSize)),
    entry(shared::kTreeDepthId, kTraversal + offsetof(TraversalShape, treeDepth)),
    entry(shared::kTreeIsWideId, kTraversal + offsetof(TraversalShape, treeIsWide)),
    entry(shared::kIsLinearId, kTraversal + offsetof(TraversalShape, isLinear)),
    entry(shared::kListedNearSpheresId, kTraversal + offsetof(TraversalShape, listedNearSpheres)),
    entry(shared::kListedSpheresId, kTraversal + offsetof(TraversalShape, listedSpheres)),
    entry(shared::kListedXQuadsId, kAxisQuads),
    entry(shared::kListedYQuadsId, kAxisQuads + sizeof(std::uint32_t)),
    entry(shared::kListedZQuadsId, kAxisQuads + 2 * sizeof(std::uint32_t)),
    entry(shared::kListedCuboidsId, kTraversal + offsetof(TraversalShape, listedCuboids)),
    entry(shared::kListedQuadsId, kTraversal + offsetof(TraversalShape, listedQuads)),
    entry(shared::kListedTrianglesId, kTraversal + offsetof(TraversalShape, listedTriangles)),
    entry(shared::kListedRoundsId, kTraversal + offsetof(TraversalShape, listedRounds)),
};

// Whether every member has an entry, and no two entries an id or a member in common.
constexpr bool areComplete() {
    for (std::size_t i = 0; i < kEntries.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (kEntries[i].constantID == kEntries[j].constantID || kEntries[i].offset == kEntries[j].offset)
                return false;
        }
    }
    return kEntries.size() == kConstantCount;
}
static_assert(areComplete());

} // namespace

TraversalShape traversalShape(const accel::GpuBvh& bvh) {
    constexpr std::uint32_t kDepthStep = 4; // so that scenes of nearly the same depth share a pipeline
    TraversalShape shape;
    shape.treeDepth = bvh.isLinear ? 0 : (bvh.trees.depth + kDepthStep - 1) / kDepthStep * kDepthStep;
    shape.treeIsWide = bvh.trees.placed.isWide ? 1 : 0;
    shape.isLinear = bvh.isLinear ? 1 : 0;
    shape.listedNearSpheres = bvh.lists.nearSpheres;
    shape.listedSpheres = bvh.lists.spheres;
    shape.listedAxisQuads = bvh.lists.axisQuads;
    shape.listedCuboids = bvh.lists.cuboids;
    shape.listedQuads = bvh.lists.quads;
    shape.listedTriangles = bvh.lists.triangles;
    shape.listedRounds = bvh.lists.rounds;
    return shape;
}

SpecializationConstants makeSpecializationConstants(shared::Features features, const shared::RenderParams& params,
                                                    std::uint32_t lights, const TraversalShape& traversal) {
    const bool usesLights = params.lightSampling == shared::kSampleMixture || shared::samplesLights(features, params);
    const bool isWeighed = usesLights && lights <= shared::kContributionLights;
    return {features,
            params.lightSampling,
            params.lightSelection,
            params.sphereLight,
            params.quadLight,
            params.triangleLight,
            params.samplerKind,
            params.russianRoulette,
            params.methods,
            isWeighed ? lights : 0,
            traversal};
}

VkSpecializationInfo specializationInfo(const SpecializationConstants& constants) {
    return {static_cast<std::uint32_t>(kEntries.size()), kEntries.data(), sizeof constants, &constants};
}

} // namespace rt::gpu
