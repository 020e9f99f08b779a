// Random geometry and rays for the tests of the acceleration structure, and the traversals that can run here.
#pragma once
#include <random>
#include <string>
#include <vector>

#include "Common/Accel/CpuAccel.h"
#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Scene/SpherePower.h"

namespace rt::accel::testing {

using shared::Hit;
using shared::Ray;
using shared::vec3;

// The arrays behind an AccelInput.
struct Geometry {
    std::vector<shared::Sphere> spheres;
    std::vector<vec3> motions;
    std::vector<shared::Quad> quads;
    std::vector<vec3> positions;
    std::vector<shared::uvec3> triangles;
    std::vector<shared::Geometry> geometries;
    std::vector<shared::Instance> instances;
    std::vector<shared::Round> rounds;

    // Everything that is there belongs to the world, unless geometries were set.
    AccelInput input() {
        if (geometries.empty()) geometries.push_back(whole());
        for (std::size_t i = 0; i < motions.size(); ++i)
            if (motions[i] != vec3(0.0f)) spheres[i].power = shared::kInfinity;
        return {spheres, motions, quads, positions, triangles, geometries, instances, rounds};
    }
    shared::Geometry whole() const {
        return {0, static_cast<std::uint32_t>(spheres.size()),   0, static_cast<std::uint32_t>(quads.size()),
                0, static_cast<std::uint32_t>(triangles.size()), 0, static_cast<std::uint32_t>(rounds.size())};
    }
    void addSphere(vec3 center, float radius) {
        const float power = scene::spherePower(glm::dvec3(center), static_cast<double>(radius));
        spheres.push_back({center, radius, 0, shared::kNone, power});
    }
    void addQuad(vec3 corner, vec3 u, vec3 v) {
        quads.push_back({corner, u, v, shared::normalize(shared::cross(u, v)), 0, shared::kNone});
    }
    void addDisk(vec3 center, vec3 u, vec3 v, float hole) {
        rounds.push_back({center, u, v, shared::normalize(shared::cross(u, v)), hole, 0, shared::kNone});
    }
    void addCylinder(vec3 base, vec3 u, vec3 v, vec3 axis) {
        rounds.push_back({base, u, v, axis, -1.0f, 0, shared::kNone});
    }
    void addTriangle(vec3 a, vec3 b, vec3 c) {
        const std::uint32_t first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.emplace_back(first, first + 1, first + 2);
    }
};

class Random {
  public:
    explicit Random(std::uint32_t seed) : generator_(seed) {}
    float uniform(float low = 0.0f, float high = 1.0f) {
        const float u = static_cast<float>(generator_() >> 8) * 0x1p-24f;
        return low + (high - low) * u;
    }
    std::size_t below(std::size_t n) { return generator_() % n; }
    vec3 inCube(float half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
    vec3 direction() {
        for (;;) {
            const vec3 v = inCube(1.0f);
            const float squared = shared::dot(v, v);
            if (squared > 0.01f && squared <= 1.0f) return v / shared::sqrt(squared);
        }
    }

  private:
    std::mt19937 generator_;
};

// A traversal under test; the plain C++ one is compiled into the tests.
struct NamedQuery {
    std::string name;
    const RayQuery* query;
};
std::vector<NamedQuery> runnableQueries();

inline std::vector<Hit> closestHits(const RayQuery& query, const AccelView& view, const std::vector<Ray>& rays,
                                    float tMax = shared::kInfinity) {
    std::vector<Hit> hits(rays.size());
    const std::vector<float> ends(rays.size(), tMax);
    query.closest(view, rays.data(), ends.data(), hits.data(), rays.size());
    return hits;
}

inline std::vector<std::uint8_t> anyHits(const RayQuery& query, const AccelView& view, const std::vector<Ray>& rays,
                                         const std::vector<float>& ends) {
    std::vector<std::uint8_t> hits(rays.size());
    query.any(view, rays.data(), ends.data(), hits.data(), rays.size());
    return hits;
}

inline std::unique_ptr<CpuAccel> buildAccel(Geometry& geometry, std::uint32_t maxLinear = 0) {
    BuildSettings settings;
    settings.maxLinear = maxLinear;
    return CpuAccel::build(geometry.input(), settings);
}
inline constexpr std::uint32_t kAlwaysLinear = 0xffffffff;

// `count` primitives: all kinds in turn, and of triangles so many in a row.
inline Geometry mixture(std::size_t count, std::uint32_t seed, std::size_t triangles = 1) {
    Geometry geometry;
    Random random(seed);
    for (std::size_t i = 0; i < count; ++i) {
        const shared::vec3 at = random.inCube(10.0f);
        const std::size_t kind = i % (2 + triangles);
        if (kind == 0) geometry.addSphere(at, random.uniform(0.01f, 0.3f));
        if (kind == 1) geometry.addQuad(at, random.inCube(0.4f), random.inCube(0.4f));
        if (kind >= 2) geometry.addTriangle(at, at + random.inCube(0.4f), at + random.inCube(0.4f));
    }
    return geometry;
}

inline shared::Instance placedAt(std::uint32_t geometry, shared::vec3 at) {
    shared::Instance instance{};
    for (int row = 0; row < 3; ++row) {
        instance.toWorld[row] = instance.toObject[row] = shared::vec4(0.0f);
        instance.toWorld[row][row] = instance.toObject[row][row] = 1.0f;
        instance.toWorld[row].w = at[row];
        instance.toObject[row].w = -at[row];
    }
    instance.geometry = geometry;
    instance.material = shared::kNone;
    return instance;
}

} // namespace rt::accel::testing
