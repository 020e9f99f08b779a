#include "Common/Scene/Tessellation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "Common/Scene/Affine.h"

namespace rt::scene {

namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr int kSegments = 100;   // around a sphere: its quads lie (2 pi / 100)^2 / 4 = 0.00099 below it in their middle
constexpr int kRimSegments = 72; // around a disk or cylinder: 1 - cos(pi / 72) = 0.00095

// A net of rings with `segments` + 1 vertices each, the last where the first is; the next ring lies to the left of one
// whose segments run ahead. Rings at the ends may be points.
void addNet(MeshData& mesh, std::uint32_t rings, std::uint32_t segments, bool startsInPoint, bool endsInPoint) {
    const std::uint32_t width = segments + 1;
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring)
        for (std::uint32_t i = 0; i < segments; ++i) {
            const std::uint32_t a = ring * width + i, b = a + 1, c = b + width, d = a + width;
            if (ring > 0 || !startsInPoint) mesh.triangles.emplace_back(a, b, endsInPoint && ring + 2 == rings ? d : c);
            if (ring + 2 < rings || !endsInPoint) mesh.triangles.emplace_back(a, c, d);
        }
}

// Where a segment begins on a circle.
struct CircleStep {
    double share, cosine, sine;
    CircleStep(int i, int segments) : share(double(i) / segments) {
        const double angle = kTwoPi * (i % segments) / segments; // the last is where the first is, bit for bit
        cosine = std::cos(angle);
        sine = std::sin(angle);
    }
};

// Rings about an axis, the third column, at these angles from its opposite end.
MeshData sphereOfRings(const std::vector<double>& angles, const glm::dmat3& frame, bool hasUvs) {
    MeshData mesh;
    for (std::size_t ring = 0; ring < angles.size(); ++ring) {
        const bool isPole = ring == 0 || ring + 1 == angles.size();
        const double across = isPole ? 0 : std::sin(angles[ring]),
                     along = isPole ? (ring == 0 ? -1 : 1) : -std::cos(angles[ring]);
        for (int i = 0; i <= kSegments; ++i) {
            const CircleStep step(i, kSegments);
            mesh.positions.push_back(frame * glm::dvec3(across * step.cosine, across * step.sine, along));
            // A triangle at a pole has the direction of its middle there.
            const double u = isPole ? step.share + 0.5 / kSegments : step.share;
            if (hasUvs) mesh.uvs.emplace_back(std::clamp(u, 0.0, 1.0), 2 * angles[ring] / kTwoPi);
        }
    }
    mesh.normals = mesh.positions;
    addNet(mesh, static_cast<std::uint32_t>(angles.size()), kSegments, true, true);
    return mesh;
}

void addParallelogram(MeshData& mesh, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v) {
    const glm::dvec3 normal = glm::cross(u, v);
    const double area = glm::length(normal);
    if (!(area > 0)) return;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::dvec2& uv : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)}) {
        mesh.positions.push_back(corner + uv.x * u + uv.y * v);
        mesh.normals.push_back(normal / area);
        mesh.uvs.push_back(uv);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 3);
    mesh.triangles.emplace_back(first, first + 3, first + 2);
}

} // namespace

MeshData sphereMesh() {
    std::vector<double> angles;
    for (int ring = 0; ring <= kSegments / 2; ++ring) angles.push_back(kTwoPi * ring / kSegments);
    // Longitude begins at -X and runs by way of +Z, as texture coordinates of spheres do.
    return sphereOfRings(angles, {glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0)}, true);
}

MeshData sphereMesh(const glm::dvec3& towards) {
    constexpr double kFirst = 2e-4, kStep = kTwoPi / kSegments;
    std::vector<double> angles = {0};
    for (double angle = kFirst; angle < kTwoPi / 2 - kStep / 2; angle += kStep * std::min(angle, 1.0))
        angles.push_back(angle);
    angles.push_back(kTwoPi / 2);
    // They are counted from the opposite end of the axis.
    const glm::dmat3 frame = frameAround(-towards);
    return sphereOfRings(angles, frame, false);
}

MeshData meshOf(const QuadDesc& quad) {
    MeshData mesh;
    addParallelogram(mesh, quad.corner, quad.edgeU, quad.edgeV);
    return mesh;
}

// The six faces as PrimitiveSink has them.
MeshData meshOf(const BoxDesc& box) {
    MeshData mesh;
    const glm::dvec3 a = box.min, b = box.max, size = b - a;
    const glm::dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    addParallelogram(mesh, {a.x, a.y, b.z}, x, y);
    addParallelogram(mesh, {b.x, a.y, b.z}, -z, y);
    addParallelogram(mesh, {b.x, a.y, a.z}, -x, y);
    addParallelogram(mesh, {a.x, a.y, a.z}, z, y);
    addParallelogram(mesh, {a.x, b.y, b.z}, x, -z);
    addParallelogram(mesh, {a.x, a.y, a.z}, x, z);
    return mesh;
}

// From the rim to the hole.
MeshData meshOf(const DiskDesc& disk) {
    MeshData mesh;
    const bool hasHole = disk.innerRadius > 0;
    if (!(disk.radius > disk.innerRadius) || !(glm::length(disk.normal) > 0)) return mesh;
    const glm::dmat3 frame = frameAround(glm::normalize(disk.normal));
    for (const bool isRim : {true, false})
        for (int i = 0; i <= kRimSegments; ++i) {
            const CircleStep step(i, kRimSegments);
            const double radius = isRim ? disk.radius : disk.innerRadius;
            mesh.positions.push_back(disk.center + radius * (step.cosine * frame[0] + step.sine * frame[1]));
            mesh.normals.push_back(frame[2]);
            const bool isMiddle = !isRim && !hasHole;
            mesh.uvs.emplace_back(std::min(step.share + (isMiddle ? 0.5 / kRimSegments : 0), 1.0), isRim ? 0 : 1);
        }
    addNet(mesh, 2, kRimSegments, false, !hasHole);
    return mesh;
}

MeshData meshOf(const CylinderDesc& cylinder) {
    MeshData mesh;
    const glm::dvec3 axis = cylinder.top - cylinder.base;
    if (!(glm::length(axis) > 0) || !(cylinder.radius > 0)) return mesh;
    const glm::dmat3 frame = frameAround(glm::normalize(axis));
    for (const bool isTop : {false, true})
        for (int i = 0; i <= kRimSegments; ++i) {
            const CircleStep step(i, kRimSegments);
            const glm::dvec3 outwards = step.cosine * frame[0] + step.sine * frame[1];
            mesh.positions.push_back((isTop ? cylinder.top : cylinder.base) + cylinder.radius * outwards);
            mesh.normals.push_back(outwards);
            mesh.uvs.emplace_back(step.share, isTop ? 1 : 0);
        }
    addNet(mesh, 2, kRimSegments, false, false);
    return mesh;
}

} // namespace rt::scene
