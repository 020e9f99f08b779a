#include "Common/Accel/Cuboids.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rt::accel {
namespace {

using shared::Quad;
using shared::vec3;

constexpr std::ptrdiff_t kMinFaces = 4;

// How far vertices that are one may be apart, relative to the cuboid's edges and their distance from the origin: what
// rounding takes of boxes that were turned. Less than the bound of a surface's error (kFlatError), by which rays that
// leave a face are kept from meeting it again.
const float kTolerance = 8.0f * shared::kEpsilon;

std::array<vec3, 4> vertices(const Quad& quad) {
    return {quad.corner, quad.corner + quad.edgeU, quad.corner + quad.edgeU + quad.edgeV, quad.corner + quad.edgeV};
}

bool areOneVertex(vec3 a, vec3 b, float size) {
    return shared::length(a - b) <= kTolerance * (size + shared::length(a));
}

bool isRight(vec3 a, vec3 b) {
    return std::abs(shared::dot(a, b)) <= kTolerance * shared::length(a) * shared::length(b);
}

bool isAmong(const std::array<vec3, 4>& vertices, vec3 v, float size) {
    return std::any_of(vertices.begin(), vertices.end(), [&](vec3 w) { return areOneVertex(v, w, size); });
}

bool haveOneOutline(const Quad& a, const Quad& b, float size) {
    const std::array<vec3, 4> ofA = vertices(a), ofB = vertices(b);
    return std::all_of(ofA.begin(), ofA.end(), [&](vec3 v) { return isAmong(ofB, v, size); });
}

// The edge of `side` that stands on a corner of `base`, if it does so along one of base's edges and at right angles.
std::optional<vec3> heightFrom(const Quad& base, const Quad& side) {
    const float size = shared::length(base.edgeU) + shared::length(base.edgeV);
    const std::array<vec3, 4> ofBase = vertices(base), ofSide = vertices(side);
    for (std::size_t i = 0; i < 4; ++i) {
        const vec3 a = ofSide[i], b = ofSide[(i + 1) % 4];
        if (!isAmong(ofBase, a, size) || !isAmong(ofBase, b, size)) continue;
        const vec3 height = ofSide[(i + 3) % 4] - a;
        if (isRight(height, base.edgeU) && isRight(height, base.edgeV)) return height;
    }
    return {};
}

// The face of a cuboid that is perpendicular to an edge, on the corner's side or the other.
Quad faceOf(const Cuboid& cuboid, std::size_t edge, bool far) {
    const std::array<vec3, 3>& edges = cuboid.edges;
    Quad face{};
    face.corner = cuboid.corner + (far ? edges[edge] : vec3(0.0f));
    face.edgeU = edges[(edge + 1) % 3];
    face.edgeV = edges[(edge + 2) % 3];
    return face;
}

// The cuboid that has these edges from a quad's corner, if enough of its faces are there.
std::optional<Cuboid> cuboidOf(std::span<const Quad> quads, const std::vector<std::uint32_t>& candidates,
                               const Quad& base, vec3 height) {
    Cuboid cuboid{base.corner, {base.edgeU, base.edgeV, height}, {}};
    const float u = shared::length(base.edgeU), v = shared::length(base.edgeV), h = shared::length(height);
    const float size = u + v + h;
    if (std::min({u, v, h}) < 1000 * kTolerance * (size + shared::length(base.corner))) return {};
    for (std::size_t face = 0; face < 6; ++face) {
        const Quad outline = faceOf(cuboid, face % 3, face >= 3);
        const auto found = std::find_if(candidates.begin(), candidates.end(),
                                        [&](std::uint32_t i) { return haveOneOutline(outline, quads[i], size); });
        cuboid.faces[face] = found == candidates.end() ? shared::kNone : *found;
    }
    const auto missing = std::count(cuboid.faces.begin(), cuboid.faces.end(), shared::kNone);
    if (6 - missing < kMinFaces) return {};
    return cuboid;
}

// Any that has this quad as a face.
std::optional<Cuboid> cuboidOn(std::span<const Quad> quads, const std::vector<std::uint32_t>& candidates,
                               const Quad& base) {
    if (!isRight(base.edgeU, base.edgeV)) return {};
    for (const std::uint32_t side : candidates) {
        const std::optional<vec3> height = heightFrom(base, quads[side]);
        if (!height) continue;
        if (const std::optional<Cuboid> cuboid = cuboidOf(quads, candidates, base, *height)) return cuboid;
    }
    return {};
}

} // namespace

std::vector<Cuboid> findCuboids(std::span<const Quad> quads, std::vector<std::uint32_t>& candidates) {
    std::vector<Cuboid> cuboids;
    for (std::size_t i = 0; i < candidates.size();) {
        const std::optional<Cuboid> cuboid = cuboidOn(quads, candidates, quads[candidates[i]]);
        if (!cuboid) {
            ++i;
            continue;
        }
        const auto isFace = [&](std::uint32_t quad) {
            return std::count(cuboid->faces.begin(), cuboid->faces.end(), quad) != 0;
        };
        std::erase_if(candidates, isFace); // the one at i among them
        cuboids.push_back(*cuboid);
    }
    return cuboids;
}

} // namespace rt::accel
