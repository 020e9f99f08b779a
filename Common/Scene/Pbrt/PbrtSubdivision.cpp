#include "Common/Scene/Pbrt/PbrtSubdivision.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace rt::scene {

namespace {

struct LoopEdge {
    std::uint32_t low, high; // its vertices
    std::uint32_t opposite;  // the third vertex of a triangle
    std::uint32_t triangle, side;
    bool isSame(const LoopEdge& other) const { return low == other.low && high == other.high; }
};

// All sides of all triangles, those of one edge beside each other.
std::vector<LoopEdge> sortedEdges(const std::vector<glm::uvec3>& triangles) {
    std::vector<LoopEdge> edges;
    edges.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = triangles[t][side], b = triangles[t][(side + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), triangles[t][(side + 2) % 3],
                             static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(side)});
        }
    std::sort(edges.begin(), edges.end(),
              [](const LoopEdge& a, const LoopEdge& b) { return std::pair(a.low, a.high) < std::pair(b.low, b.high); });
    return edges;
}

bool isManifold(const std::vector<LoopEdge>& edges) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i].low == edges[i].high) return false;
        if (i + 2 < edges.size() && edges[i].isSame(edges[i + 2])) return false;
    }
    return true;
}

// Around a vertex: how many edges, and the sums of their other ends; apart those at the surface's boundary.
struct LoopRing {
    std::uint32_t count = 0, boundaryCount = 0;
    glm::dvec3 sum{0}, boundarySum{0};
};

std::vector<LoopRing> ringsOf(const std::vector<LoopEdge>& edges, const std::vector<glm::dvec3>& positions) {
    std::vector<LoopRing> rings(positions.size());
    for (std::size_t i = 0; i < edges.size();) {
        const bool isInside = i + 1 < edges.size() && edges[i].isSame(edges[i + 1]);
        for (const auto& [at, other] :
             {std::pair(edges[i].low, edges[i].high), std::pair(edges[i].high, edges[i].low)}) {
            LoopRing& ring = rings[at];
            ++ring.count;
            ring.sum += positions[other];
            if (isInside) continue;
            ++ring.boundaryCount;
            ring.boundarySum += positions[other];
        }
        i += isInside ? 2 : 1;
    }
    return rings;
}

// Loop's weights with Warren's simplification: 3 / (8 n) for each of n neighbours, 3 / 16 for three.
double weightOf(std::uint32_t neighbours) {
    return neighbours == 3 ? 3.0 / 16 : 3.0 / (8.0 * neighbours);
}

glm::dvec3 smoothed(const glm::dvec3& position, const LoopRing& ring) {
    if (ring.count == 0) return position;
    if (ring.boundaryCount > 0) // 1/8 for both neighbours along it
        return 0.75 * position + 0.25 / ring.boundaryCount * ring.boundarySum;
    const double weight = weightOf(ring.count);
    return (1 - ring.count * weight) * position + weight * ring.sum;
}

// Where infinitely many steps would move a vertex.
glm::dvec3 atLimit(const glm::dvec3& position, const LoopRing& ring) {
    if (ring.count == 0) return position;
    if (ring.boundaryCount > 0) return 0.6 * position + 0.4 / ring.boundaryCount * ring.boundarySum;
    const double weight = 1 / (ring.count + 3 / (8 * weightOf(ring.count)));
    return (1 - ring.count * weight) * position + weight * ring.sum;
}

void divide(MeshData& mesh) {
    const std::vector<LoopEdge> edges = sortedEdges(mesh.triangles);
    const std::vector<LoopRing> rings = ringsOf(edges, mesh.positions);
    std::vector<glm::dvec3> positions(mesh.positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = smoothed(mesh.positions[i], rings[i]);
    std::vector<glm::uvec3> middles(mesh.triangles.size()); // the new vertex of each side
    for (std::size_t i = 0; i < edges.size();) {
        const LoopEdge& edge = edges[i];
        const bool isInside = i + 1 < edges.size() && edge.isSame(edges[i + 1]);
        const glm::dvec3 ends = mesh.positions[edge.low] + mesh.positions[edge.high];
        const auto middle = static_cast<std::uint32_t>(positions.size());
        positions.push_back(
            isInside ? 0.375 * ends + 0.125 * (mesh.positions[edge.opposite] + mesh.positions[edges[i + 1].opposite])
                     : 0.5 * ends);
        middles[edge.triangle][static_cast<int>(edge.side)] = middle;
        if (isInside) middles[edges[i + 1].triangle][static_cast<int>(edges[i + 1].side)] = middle;
        i += isInside ? 2 : 1;
    }
    std::vector<glm::uvec3> triangles;
    triangles.reserve(4 * mesh.triangles.size());
    for (std::size_t t = 0; t < middles.size(); ++t) {
        const glm::uvec3 corner = mesh.triangles[t], middle = middles[t];
        triangles.emplace_back(corner.x, middle.x, middle.z);
        triangles.emplace_back(middle.x, corner.y, middle.y);
        triangles.emplace_back(middle.z, middle.y, corner.z);
        triangles.push_back(middle);
    }
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
}

// By the areas of the triangles around.
void addNormals(MeshData& mesh) {
    mesh.normals.assign(mesh.positions.size(), glm::dvec3(0));
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        for (int corner = 0; corner < 3; ++corner) mesh.normals[t[corner]] += normal;
    }
    for (glm::dvec3& normal : mesh.normals) {
        const double length = glm::length(normal);
        normal = length > 0 ? normal / length : glm::dvec3(0, 0, 1);
    }
}

} // namespace

MeshData subdividedByLoop(MeshData mesh, int levels) {
    if (!isManifold(sortedEdges(mesh.triangles))) return {};
    for (int level = 0; level < levels; ++level) divide(mesh);
    const std::vector<LoopRing> rings = ringsOf(sortedEdges(mesh.triangles), mesh.positions);
    std::vector<glm::dvec3> positions(mesh.positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = atLimit(mesh.positions[i], rings[i]);
    mesh.positions = std::move(positions);
    addNormals(mesh);
    return mesh;
}

} // namespace rt::scene
