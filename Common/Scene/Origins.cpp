#include "Common/Scene/Origins.h"

#include <algorithm>

#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/SceneDesc.h"
#include "Common/Shared/Base/Types.h"

namespace rt::scene {

namespace {

// Adds primitives to bounds, in the space that they are in.
class PrimitiveBounds {
  public:
    PrimitiveBounds(const CompiledScene& scene, Bounds& bounds) : scene_(scene), bounds_(bounds) {}

    void sphere(std::uint32_t i) {
        const shared::Sphere& sphere = scene_.spheres[i];
        const glm::dvec3 center(sphere.center);
        const glm::dvec3 motion = scene_.sphereMotions.empty() ? glm::dvec3(0) : glm::dvec3(scene_.sphereMotions[i]);
        bounds_.add(center, sphere.radius);
        bounds_.add(center + motion, sphere.radius);
    }
    void quad(std::uint32_t i) {
        const shared::Quad& quad = scene_.quads[i];
        const glm::dvec3 o(quad.corner), u(quad.edgeU), v(quad.edgeV);
        for (const glm::dvec3& corner : {o, o + u, o + v, o + u + v}) bounds_.add(corner);
    }
    void triangle(std::uint32_t i) {
        const shared::uvec3& corners = scene_.triangles[i];
        for (int k = 0; k < 3; ++k) bounds_.add(glm::dvec3(scene_.positions[corners[k]]));
    }
    void round(std::uint32_t i) {
        const shared::Round& round = scene_.rounds[i];
        const glm::dvec3 o(round.origin), u(round.edgeU), v(round.edgeV);
        const glm::dvec3 reach = glm::sqrt(u * u + v * v);
        for (const glm::dvec3& center : {o, round.hole < 0 ? o + glm::dvec3(round.axis) : o}) {
            bounds_.add(center - reach);
            bounds_.add(center + reach);
        }
    }
    void geometry(const shared::Geometry& g) {
        for (std::uint32_t i = 0; i < g.sphereCount; ++i) sphere(g.firstSphere + i);
        for (std::uint32_t i = 0; i < g.quadCount; ++i) quad(g.firstQuad + i);
        for (std::uint32_t i = 0; i < g.triangleCount; ++i) triangle(g.firstTriangle + i);
        for (std::uint32_t i = 0; i < g.roundCount; ++i) round(g.firstRound + i);
    }

  private:
    const CompiledScene& scene_;
    Bounds& bounds_;
};

// The index of the range that an object is in; their number: in none.
std::size_t rangeOf(std::span<const ObjectRange> ranges, std::uint32_t object) {
    const auto isBefore = [](std::uint32_t index, const ObjectRange& range) { return index < range.first; };
    const auto after = std::upper_bound(ranges.begin(), ranges.end(), object, isBefore);
    if (after == ranges.begin()) return ranges.size();
    const ObjectRange& range = *std::prev(after);
    return object - range.first < range.count ? static_cast<std::size_t>(after - ranges.begin()) - 1 : ranges.size();
}

// Calls visit(range, primitive) for those of the world that come from objects in a range. Runs are not sorted by
// object: what stands in prototypes follows all else.
template <typename Visit>
void forEachOf(const std::vector<OriginRun>& runs, std::uint32_t end, std::span<const ObjectRange> ranges,
               const Visit& visit) {
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const std::size_t range = rangeOf(ranges, runs[run].object);
        if (range == ranges.size()) continue;
        const std::uint32_t last = run + 1 < runs.size() ? runs[run + 1].first : end;
        for (std::uint32_t i = runs[run].first; i < last; ++i) visit(range, i);
    }
}

Affine mapOf(const shared::Instance& instance) {
    Affine map;
    for (int row = 0; row < 3; ++row) {
        const shared::vec4& values = instance.toWorld[row];
        for (int column = 0; column < 3; ++column) map.linear[column][row] = values[column];
        map.offset[row] = values.w;
    }
    return map;
}

} // namespace

std::uint32_t leafCount(const ObjectDesc& object) {
    const auto* group = std::get_if<GroupDesc>(&object.shape);
    if (group == nullptr) return 1;
    std::uint32_t sum = 0;
    for (const ObjectDesc& child : group->objects) sum += leafCount(child);
    return sum;
}

std::uint32_t originOf(std::span<const OriginRun> runs, std::uint32_t primitive) {
    const auto isBefore = [](std::uint32_t index, const OriginRun& run) { return index < run.first; };
    return std::prev(std::upper_bound(runs.begin() + 1, runs.end(), primitive, isBefore))->object;
}

std::vector<Bounds> boundsOf(const CompiledScene& scene, std::span<const ObjectRange> ranges) {
    std::vector<Bounds> bounds(ranges.size());
    const Origins& origins = scene.origins;
    const shared::Geometry& world = scene.geometries[0];
    const auto add = [&](std::size_t range) { return PrimitiveBounds(scene, bounds[range]); };
    forEachOf(origins.spheres, world.sphereCount, ranges, [&](auto range, auto i) { add(range).sphere(i); });
    forEachOf(origins.quads, world.quadCount, ranges, [&](auto range, auto i) { add(range).quad(i); });
    forEachOf(origins.triangles, world.triangleCount, ranges, [&](auto range, auto i) { add(range).triangle(i); });
    forEachOf(origins.rounds, world.roundCount, ranges, [&](auto range, auto i) { add(range).round(i); });
    std::vector<Bounds> geometries(scene.geometries.size()); // each looked through once, however many instances it has
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const std::size_t range = rangeOf(ranges, origins.instances[i]);
        if (range == ranges.size()) continue;
        const shared::Instance& instance = scene.instances[i];
        Bounds& own = geometries[instance.geometry];
        if (own.empty()) PrimitiveBounds(scene, own).geometry(scene.geometries[instance.geometry]);
        bounds[range].add(own, mapOf(instance));
    }
    for (Bounds& box : bounds) {
        if (box.empty()) continue;
        box.lower += scene.origin;
        box.upper += scene.origin;
    }
    return bounds;
}

} // namespace rt::scene
