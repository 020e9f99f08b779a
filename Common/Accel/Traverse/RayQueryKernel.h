// The body of RayQuery for the instruction set of the translation unit that includes it.
#pragma once
#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Accel/Traverse/Traverse.h"

namespace rt::accel {
namespace {

template <shared::Features kFeatures>
shared::Hit closestHit(const AccelView& view, const shared::Ray& ray, float tMax) {
    return traceClosest(kFeatures, view, ray, tMax);
}

template <shared::Features kFeatures>
bool anyHit(const AccelView& view, const shared::Ray& ray, float tMax) {
    return occluded(kFeatures, view, ray, tMax);
}

template <shared::Features kFeatures>
shared::Hit bothHits(const AccelView& view, const shared::Ray& ray, const shared::vec3& shadowDirection,
                     float shadowEnd, bool& isOccluded) {
    if (!view.isLinear || shared::has(kFeatures, shared::kRoundFeatures)) {
        isOccluded = anyHit<kFeatures>(view, {ray.origin, shadowDirection, ray.time}, shadowEnd);
        return closestHit<kFeatures>(view, ray, shared::kInfinity);
    }
    // Never in memory, so that a compiler sees that it starts where the other does.
    const shared::Ray shadow{ray.origin, shadowDirection, ray.time};
    return traceLinearWithShadow(kFeatures, view, makeShapeRay(kFeatures, ray, true),
                                 makeShapeRay(kFeatures, shadow, true), shadowEnd, isOccluded);
}

template <shared::Features kFeatures>
constexpr Tracer makeTracer() {
    return {closestHit<kFeatures>, anyHit<kFeatures>, bothHits<kFeatures>};
}

// The leanest that covers the kinds.
Tracer tracer(shared::Features kinds) {
    using namespace shared;
    constexpr Features kBox = kFeatureSpheres | kFeatureQuads;
    constexpr Features kStill = kBox | kFeatureTriangles;
    constexpr Features kAll = kStill | kFeatureMovingSpheres | kFeatureInstances;
    const auto covers = [kinds](Features set) { return (kinds & ~set) == kFeatureNone; };
    if (covers(kFeatureSpheres)) return makeTracer<kFeatureSpheres>();
    if (covers(kFeatureTriangles)) return makeTracer<kFeatureTriangles>();
    if (covers(kBox)) return makeTracer<kBox>();
    if (covers(kStill)) return makeTracer<kStill>();
    if (covers(kAll)) return makeTracer<kAll>();
    return makeTracer<kAll | kRoundFeatures>();
}

void closest(const AccelView& view, const shared::Ray* rays, const float* tMax, shared::Hit* hits, std::size_t count) {
    const Tracer trace = tracer(view.kinds);
    for (std::size_t i = 0; i < count; ++i) hits[i] = trace.closest(view, rays[i], tMax[i]);
}

void any(const AccelView& view, const shared::Ray* rays, const float* tMax, std::uint8_t* hits, std::size_t count) {
    const Tracer trace = tracer(view.kinds);
    for (std::size_t i = 0; i < count; ++i) hits[i] = trace.occluded(view, rays[i], tMax[i]) ? 1 : 0;
}

} // namespace
} // namespace rt::accel
