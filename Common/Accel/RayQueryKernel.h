// The body of RayQuery for the instruction set of the translation unit that includes it.
#pragma once
#include "Common/Accel/RayQuery.h"
#include "Common/Accel/Traverse.h"

namespace rt::accel {
namespace {

template <shared::uint kFeatures>
void closestHits(const AccelView& view, const shared::Ray* rays, const float* tMax, shared::Hit* hits,
                 std::size_t count) {
    const AccelView local = view;
    for (std::size_t i = 0; i < count; ++i) {
        hits[i] = traceClosest(kFeatures, local, rays[i], tMax[i]);
    }
}

template <shared::uint kFeatures>
void anyHits(const AccelView& view, const shared::Ray* rays, const float* tMax, std::uint8_t* hits, std::size_t count) {
    const AccelView local = view;
    for (std::size_t i = 0; i < count; ++i) {
        hits[i] = occluded(kFeatures, local, rays[i], tMax[i]) ? 1 : 0;
    }
}

constexpr shared::uint kAllShapes = shared::kFeatureSpheres | shared::kFeatureMovingSpheres | shared::kFeatureQuads |
                                    shared::kFeatureTriangles | shared::kFeatureInstances;

void closest(const AccelView& view, const shared::Ray* rays, const float* tMax, shared::Hit* hits, std::size_t count) {
    switch (view.kinds) {
        case shared::kFeatureSpheres:
            return closestHits<shared::kFeatureSpheres>(view, rays, tMax, hits, count);
        case shared::kFeatureTriangles:
            return closestHits<shared::kFeatureTriangles>(view, rays, tMax, hits, count);
        default:
            return closestHits<kAllShapes>(view, rays, tMax, hits, count);
    }
}

void any(const AccelView& view, const shared::Ray* rays, const float* tMax, std::uint8_t* hits, std::size_t count) {
    switch (view.kinds) {
        case shared::kFeatureSpheres:
            return anyHits<shared::kFeatureSpheres>(view, rays, tMax, hits, count);
        case shared::kFeatureTriangles:
            return anyHits<shared::kFeatureTriangles>(view, rays, tMax, hits, count);
        default:
            return anyHits<kAllShapes>(view, rays, tMax, hits, count);
    }
}

}  // namespace
}  // namespace rt::accel
