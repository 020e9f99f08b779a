#include "Common/Scene/Origins.h"

#include <algorithm>
#include <initializer_list>

#include "Common/Scene/CompiledScene.h"
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

// Calls visit(primitive) for those of the world that come from the objects. Runs are not sorted by object: what stands
// in prototypes follows all else.
template <typename Visit>
void forEachOf(const std::vector<OriginRun>& runs, std::uint32_t end, std::uint32_t first, std::uint32_t count,
               const Visit& visit) {
    for (std::size_t run = 0; run < runs.size(); ++run) {
        if (runs[run].object - first >= count) continue; // below `first` it wraps around
        const std::uint32_t last = run + 1 < runs.size() ? runs[run + 1].first : end;
        for (std::uint32_t i = runs[run].first; i < last; ++i) visit(i);
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

std::uint32_t originOf(std::span<const OriginRun> runs, std::uint32_t primitive) {
    const auto isBefore = [](std::uint32_t index, const OriginRun& run) { return index < run.first; };
    return std::prev(std::upper_bound(runs.begin() + 1, runs.end(), primitive, isBefore))->object;
}

Bounds boundsOfObjects(const CompiledScene& scene, std::uint32_t first, std::uint32_t count) {
    Bounds bounds;
    PrimitiveBounds add(scene, bounds);
    const Origins& origins = scene.origins;
    const shared::Geometry& world = scene.geometries[0];
    forEachOf(origins.spheres, world.sphereCount, first, count, [&](std::uint32_t i) { add.sphere(i); });
    forEachOf(origins.quads, world.quadCount, first, count, [&](std::uint32_t i) { add.quad(i); });
    forEachOf(origins.triangles, world.triangleCount, first, count, [&](std::uint32_t i) { add.triangle(i); });
    forEachOf(origins.rounds, world.roundCount, first, count, [&](std::uint32_t i) { add.round(i); });
    std::vector<Bounds> geometries(scene.geometries.size()); // each looked through once, however many instances it has
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (origins.instances[i] - first >= count) continue;
        const shared::Instance& instance = scene.instances[i];
        Bounds& own = geometries[instance.geometry];
        if (own.empty()) PrimitiveBounds(scene, own).geometry(scene.geometries[instance.geometry]);
        bounds.add(own, mapOf(instance));
    }
    if (bounds.empty()) return bounds;
    bounds.lower += scene.origin;
    bounds.upper += scene.origin;
    return bounds;
}

} // namespace rt::scene
