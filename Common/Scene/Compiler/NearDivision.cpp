#include "Common/Scene/Compiler/NearDivision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "Common/Core/Interruption.h"
#include "Common/Scene/Compiler/Representable.h"

namespace rt::scene {

namespace {

constexpr double kPieceRatio = 8; // of the pieces; less than kHugeRatio, so that few cases need pieces at all
constexpr double kThroughOrigin =
    1e10; // a surface of a larger ratio goes through the origin itself, and is none to see

using Edge = std::pair<std::array<double, 3>, std::array<double, 3>>;

Edge edgeBetween(const glm::dvec3& a, const glm::dvec3& b) {
    const std::array<double, 3> p{a.x, a.y, a.z}, q{b.x, b.y, b.z};
    return p < q ? Edge{p, q} : Edge{q, p};
}

double distanceToSegment(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = b - a;
    const double squared = glm::dot(along, along);
    const double part = squared > 0 ? std::clamp(-glm::dot(a, along) / squared, 0.0, 1.0) : 0;
    return glm::length(a + along * part);
}

// Of the origin of coordinates from a triangle.
double distanceToTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const auto isInside = [&n](const glm::dvec3& p, const glm::dvec3& q) { return glm::dot(n, glm::cross(p, q)) >= 0; };
    if (isInside(a, b) && isInside(b, c) && isInside(c, a)) return std::abs(glm::dot(n, a)) / glm::length(n);
    return std::min({distanceToSegment(a, b), distanceToSegment(b, c), distanceToSegment(c, a)});
}

double longestEdge(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
}

bool exceeds(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double ratio) {
    const glm::dvec3 ab = b - a, bc = c - b, ca = a - c;
    const double squared = std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)});
    if (!(glm::dot(a, a) < 4 * squared)) return false; // as nearly all triangles of a large mesh are
    if (doubleArea(shared::vec3(a), shared::vec3(b), shared::vec3(c)) == glm::dvec3(0)) return false; // to be dropped
    const double extent = std::sqrt(squared), distance = distanceToTriangle(a, b, c);
    return extent > ratio * distance && extent < kThroughOrigin * distance;
}

// Without coordinates the place in its triangle, as it is wound in the end, serves as such: what the pieces have to
// keep.
MeshData withPlaces(const MeshData& mesh, bool isMirrored) {
    MeshData result;
    const std::array<glm::dvec2, 3> places{glm::dvec2(0, 0), glm::dvec2(isMirrored ? 0 : 1, isMirrored ? 1 : 0),
                                           glm::dvec2(isMirrored ? 1 : 0, isMirrored ? 0 : 1)};
    for (const glm::uvec3& t : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(result.positions.size());
        const auto append = [&t](auto& to, const auto& from) {
            if (from.empty()) return;
            for (int corner = 0; corner < 3; ++corner) to.push_back(from[t[corner]]);
        };
        append(result.positions, mesh.positions);
        append(result.normals, mesh.normals);
        append(result.uvs2, mesh.uvs2);
        append(result.colors, mesh.colors);
        append(result.tangents, mesh.tangents);
        result.uvs.insert(result.uvs.end(), places.begin(), places.end());
        result.triangles.emplace_back(first, first + 1, first + 2);
    }
    return result;
}

class Divider {
  public:
    Divider(MeshData mesh, const Affine& map) : mesh_(std::move(mesh)), map_(map) {
        places_.reserve(mesh_.positions.size());
        for (const glm::dvec3& position : mesh_.positions) places_.push_back(map.point(position));
        for (const glm::uvec3& t : mesh_.triangles) keep(t);
        mesh_.triangles.clear();
    }

    MeshData run() {
        while (markEdges()) {
            midpoints_.clear();
            std::vector<Piece> before = std::move(pieces_);
            pieces_.clear();
            for (const Piece& piece : before) {
                interruptionPoint();
                if (piece.extent < shortestMarked_)
                    pieces_.push_back(piece);
                else
                    divide(piece.corners);
            }
        }
        for (const Piece& piece : pieces_) mesh_.triangles.push_back(piece.corners);
        return std::move(mesh_);
    }

  private:
    struct Piece {
        glm::uvec3 corners;
        double extent;
        bool isHuge;
    };

    void keep(const glm::uvec3& t) {
        const glm::dvec3 &a = places_[t.x], &b = places_[t.y], &c = places_[t.z];
        // What no float represents is dropped later and has no edges to compare.
        const bool isUsable = representable(a) && representable(b) && representable(c);
        pieces_.push_back({t, isUsable ? longestEdge(a, b, c) : 0, exceeds(a, b, c, kPieceRatio)});
    }

    // The longest edge of each piece that is still huge; false if none is.
    bool markEdges() {
        marked_.clear();
        shortestMarked_ = HUGE_VAL;
        for (const Piece& piece : pieces_) {
            if (!piece.isHuge) continue;
            shortestMarked_ = std::min(shortestMarked_, piece.extent);
            for (int i = 0; i < 3; ++i) {
                const glm::dvec3 &a = places_[piece.corners[i]], &b = places_[piece.corners[(i + 1) % 3]];
                if (glm::length(b - a) == piece.extent) marked_.insert(edgeBetween(a, b));
            }
        }
        return !marked_.empty();
    }

    // At all of its marked edges, the longest first.
    void divide(const glm::uvec3& t) {
        int longest = -1;
        double length = -1;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 &a = places_[t[i]], &b = places_[t[(i + 1) % 3]];
            if (glm::length(b - a) <= length || marked_.count(edgeBetween(a, b)) == 0) continue;
            longest = i;
            length = glm::length(b - a);
        }
        if (longest < 0) {
            keep(t);
            return;
        }
        const std::uint32_t a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3];
        const std::uint32_t middle = midpoint(a, b);
        divide({a, middle, c});
        divide({middle, b, c});
    }

    std::uint32_t midpoint(std::uint32_t a, std::uint32_t b) {
        const auto [found, isNew] = midpoints_.try_emplace(std::minmax(a, b), 0u);
        if (!isNew) return found->second;
        found->second = static_cast<std::uint32_t>(mesh_.positions.size());
        const auto addMean = [a, b](auto& values) {
            if (!values.empty()) values.push_back((values[a] + values[b]) * 0.5);
        };
        addMean(mesh_.positions);
        addMean(mesh_.normals);
        addMean(mesh_.uvs);
        addMean(mesh_.uvs2);
        addMean(mesh_.colors);
        addMean(mesh_.tangents);
        if (!mesh_.tangents.empty()) mesh_.tangents.back().w = mesh_.tangents[a].w; // alike at all corners
        places_.push_back(map_.point(mesh_.positions.back()));
        return found->second;
    }

    MeshData mesh_;
    const Affine map_;
    std::vector<glm::dvec3> places_; // of the vertices, in the target space
    std::vector<Piece> pieces_;
    std::set<Edge> marked_;
    double shortestMarked_ = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> midpoints_; // of this round
};

} // namespace

bool isHuge(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return exceeds(a, b, c, kHugeRatio);
}

MeshData divideHugeTriangles(const MeshData& mesh, const Affine& map, bool showsImage) {
    return Divider(showsImage && mesh.uvs.empty() ? withPlaces(mesh, map.mirrors()) : mesh, map).run();
}

} // namespace rt::scene
