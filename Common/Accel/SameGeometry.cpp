#include "Common/Accel/SameGeometry.h"

#include <algorithm>
#include <atomic>
#include <cstddef>

#include "Common/Accel/Build/TreeItems.h"
#include "Common/Core/Parallel.h"

namespace rt::accel {
namespace {

constexpr std::size_t kCompareChunk = 1u << 14; // triangles that a thread compares at a time

template <class T>
bool sameBytes(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool sameTriangle(const AccelInput& a, shared::uvec3 ofA, const AccelInput& b, shared::uvec3 ofB) {
    for (int corner = 0; corner < 3; ++corner)
        if (!sameBytes(a.positions[ofA[corner]], b.positions[ofB[corner]])) return false;
    return true;
}

} // namespace

bool sameSurfaces(const AccelInput& a, const AccelInput& b, std::uint32_t geometry) {
    const shared::Geometry &inA = a.geometries[geometry], &inB = b.geometries[geometry];
    if (inA.triangleCount != inB.triangleCount || inA.quadCount != inB.quadCount) return false;
    for (std::uint32_t i = 0; i < inA.quadCount; ++i) {
        const shared::Quad &ofA = a.quads[inA.firstQuad + i], &ofB = b.quads[inB.firstQuad + i];
        if (!sameBytes(ofA.corner, ofB.corner) || !sameBytes(ofA.edgeU, ofB.edgeU) || !sameBytes(ofA.edgeV, ofB.edgeV))
            return false;
    }
    std::atomic<bool> isSame = true;
    parallelChunks(0, inA.triangleCount, kCompareChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && isSame; ++i)
            if (!sameTriangle(a, a.triangles[inA.firstTriangle + i], b, b.triangles[inB.firstTriangle + i]))
                isSame = false;
    });
    return isSame;
}

bool sameSpheres(const AccelInput& a, const AccelInput& b, std::uint32_t geometry) {
    const shared::Geometry &inA = a.geometries[geometry], &inB = b.geometries[geometry];
    if (inA.sphereCount != inB.sphereCount || a.motions.empty() != b.motions.empty()) return false;
    for (std::uint32_t i = 0; i < inA.sphereCount; ++i) {
        const std::uint32_t ofA = inA.firstSphere + i, ofB = inB.firstSphere + i;
        if (!sameBytes(a.spheres[ofA].center, b.spheres[ofB].center)) return false;
        if (!sameBytes(a.spheres[ofA].radius, b.spheres[ofB].radius)) return false;
        if (!a.motions.empty() && !sameBytes(a.motions[ofA], b.motions[ofB])) return false;
    }
    return true;
}

bool sameRounds(const AccelInput& a, const AccelInput& b, std::uint32_t geometry) {
    const shared::Geometry &inA = a.geometries[geometry], &inB = b.geometries[geometry];
    if (inA.roundCount != inB.roundCount) return false;
    for (std::uint32_t i = 0; i < inA.roundCount; ++i) {
        const shared::Round &ofA = a.rounds[inA.firstRound + i], &ofB = b.rounds[inB.firstRound + i];
        if (!sameBytes(ofA.origin, ofB.origin) || !sameBytes(ofA.axis, ofB.axis) || !sameBytes(ofA.hole, ofB.hole) ||
            !sameBytes(ofA.edgeU, ofB.edgeU) || !sameBytes(ofA.edgeV, ofB.edgeV))
            return false;
    }
    return true;
}

bool sameInstances(const AccelInput& a, const AccelInput& b) {
    const auto isSame = [](const shared::Instance& ofA, const shared::Instance& ofB) {
        return ofA.geometry == ofB.geometry && sameBytes(ofA.toWorld, ofB.toWorld);
    };
    return std::equal(a.instances.begin(), a.instances.end(), b.instances.begin(), b.instances.end(), isSame);
}

bool samePlacedGeometries(const AccelInput& a, const AccelInput& b) {
    if (a.geometries.size() != b.geometries.size() || a.motions.empty() != b.motions.empty()) return false;
    if (placedGeometries(a) != placedGeometries(b)) return false;
    for (std::uint32_t g = 1; g < a.geometries.size(); ++g) {
        const shared::Geometry& geometry = a.geometries[g];
        if (!sameBytes(geometry, b.geometries[g])) return false;
        if (!sameSurfaces(a, b, g) || !sameSpheres(a, b, g) || !sameRounds(a, b, g)) return false;
        for (std::uint32_t i = geometry.firstSphere; i < geometry.firstSphere + geometry.sphereCount; ++i)
            if (sphereKind(a, i) != sphereKind(b, i)) return false;
    }
    return true;
}

bool sameInput(const AccelInput& a, const AccelInput& b) {
    return sameArray(a.geometries, b.geometries) && sameArray(a.instances, b.instances) &&
           sameArray(a.spheres, b.spheres) && sameArray(a.motions, b.motions) && sameArray(a.quads, b.quads) &&
           sameArray(a.rounds, b.rounds) && sameArray(a.triangles, b.triangles) && sameArray(a.positions, b.positions);
}

} // namespace rt::accel
