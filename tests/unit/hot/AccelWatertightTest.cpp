// Nothing escapes from a closed surface, wherever it is aimed and wherever the surface stands (numerics N4, N5).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tests/unit/AccelScene.h"

namespace rt::accel::testing {
namespace {

struct Mesh {
    std::vector<vec3> vertices;
    std::vector<shared::uvec3> triangles;
};

// An icosahedron, each triangle divided into four `levels` times, vertices on the unit sphere; then moved in and out.
Mesh closedMesh(int levels, float bumps) {
    const float phi = 0.5f * (1.0f + std::sqrt(5.0f));
    Mesh m;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float a : {-1.0f, 1.0f}) {
            for (const float b : {-phi, phi}) {
                vec3 v;
                v[axis] = 0.0f;
                v[(axis + 1) % 3] = a;
                v[(axis + 2) % 3] = b;
                m.vertices.push_back(v / std::sqrt(1.0f + phi * phi));
            }
        }
    }
    const std::uint32_t n = 12;
    for (std::uint32_t a = 0; a < n; ++a) {
        for (std::uint32_t b = a + 1; b < n; ++b) {
            for (std::uint32_t c = b + 1; c < n; ++c) {
                const auto near = [&](std::uint32_t i, std::uint32_t j) {
                    return shared::length(m.vertices[i] - m.vertices[j]) < 1.1f;
                };
                if (near(a, b) && near(b, c) && near(c, a)) m.triangles.emplace_back(a, b, c);
            }
        }
    }
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, isNew] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(m.vertices.size()));
            if (isNew) m.vertices.push_back(shared::normalize(m.vertices[a] + m.vertices[b]));
            return it->second;
        };
        std::vector<shared::uvec3> finer;
        for (const shared::uvec3& t : m.triangles) {
            const std::uint32_t ab = middle(t.x, t.y), bc = middle(t.y, t.z), ca = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, ab, ca}, {t.y, bc, ab}, {t.z, ca, bc}, {ab, bc, ca}});
        }
        m.triangles = finer;
    }
    Random random(31);
    for (vec3& v : m.vertices) {
        v *= random.uniform(1.0f - bumps, 1.0f);
    }
    return m;
}

int countLeaks(const RayQuery& query, const AccelView& view, const std::vector<Ray>& rays) {
    int leaks = 0;
    for (const Hit& hit : closestHits(query, view, rays)) {
        leaks += hit.t < 0.0f;
    }
    const auto any = anyHits(query, view, rays, std::vector<float>(rays.size(), shared::kInfinity));
    return leaks + static_cast<int>(std::count(any.begin(), any.end(), std::uint8_t{0}));
}

TEST(Watertight, MeshesDoNotLeakAtVerticesAndEdges) {
    for (const float bumps : {0.0f, 0.5f}) {
        const Mesh mesh = closedMesh(3, bumps);
        ASSERT_EQ(mesh.triangles.size(), 1280u);
        for (const float scale : {1e-3f, 1.0f, 1e3f}) {
            for (const float shift : {0.0f, 10.0f, 1e4f}) {
                Geometry g;
                for (const vec3 v : mesh.vertices) {
                    g.positions.push_back((v + vec3(shift, -0.5f * shift, 0.3f * shift)) * scale);
                }
                g.triangles = mesh.triangles;
                vec3 center(0.0f); // of the mesh as rounded
                for (const vec3 v : g.positions) {
                    center += v / static_cast<float>(g.positions.size());
                }
                Random random(32);
                std::vector<Ray> rays;
                const auto aimAt = [&](vec3 target) {
                    const vec3 origin = center + random.inCube(0.05f * scale);
                    rays.push_back({origin, shared::normalize(target - origin), 0.0f});
                };
                for (const vec3 v : g.positions) {
                    aimAt(v);
                }
                for (const shared::uvec3& t : g.triangles) {
                    aimAt((g.positions[t.x] + g.positions[t.y]) * 0.5f);
                    aimAt(shared::mix(g.positions[t.y], g.positions[t.z], random.uniform()));
                }
                for (int axis = 0; axis < 6; ++axis) {
                    vec3 d(0.0f);
                    d[axis / 2] = axis % 2 == 0 ? 1.0f : -1.0f;
                    rays.push_back({center, d, 0.0f});
                    for (const vec3 v : g.positions) { // axis-parallel and through a vertex
                        vec3 origin = v;
                        origin[axis / 2] = center[axis / 2];
                        const vec3 offset = (origin - center) / scale;
                        if (shared::length(offset) < 0.3f) rays.push_back({origin, d, 0.0f});
                    }
                }
                const auto accel = buildAccel(g);
                for (const NamedQuery& q : runnableQueries()) {
                    SCOPED_TRACE(q.name + " scale " + std::to_string(scale) + " shift " + std::to_string(shift));
                    EXPECT_EQ(countLeaks(*q.query, accel->view(), rays), 0);
                }
            }
        }
    }
}

using Axes = std::array<vec3, 3>;

// Six quads; corner vectors are rounded once, edges are their differences.
Geometry quadBox(vec3 center, float size, const Axes& axes) {
    const auto corner = [&](int x, int y, int z) {
        return center + axes[0] * (size * static_cast<float>(x)) + axes[1] * (size * static_cast<float>(y)) +
               axes[2] * (size * static_cast<float>(z));
    };
    Geometry g;
    const auto side = [&](vec3 a, vec3 b, vec3 c) { g.addQuad(a, b - a, c - a); };
    for (const int s : {-1, 1}) {
        side(corner(s, -1, -1), corner(s, 1, -1), corner(s, -1, 1));
        side(corner(-1, s, -1), corner(1, s, -1), corner(-1, s, 1));
        side(corner(-1, -1, s), corner(1, -1, s), corner(-1, 1, s));
    }
    return g;
}

// Rays from within, aimed at the rims where disks close a cylinder.
TEST(Watertight, CylindersThatDisksCloseDoNotLeakAtTheirRims) {
    const std::array<vec3, 3> turned{vec3(0.8f, 0.36f, -0.48f), vec3(-0.6f, 0.48f, -0.64f), vec3(0.0f, 0.8f, 0.6f)};
    for (const float size : {1e-4f, 1.0f, 555.0f, 1e4f}) {
        for (const float shift : {0.0f, 10.0f}) {
            const vec3 base = vec3(0.7f, -1.1f, 0.4f) * (size * shift);
            const vec3 u = turned[0] * size, v = turned[1] * (0.7f * size), axis = turned[2] * (1.3f * size);
            Geometry g;
            g.addCylinder(base, u, v, axis);
            g.addDisk(base, u, v, 0.0f);
            g.addDisk(base + axis, u, v, 0.0f);
            Random random(35);
            std::vector<Ray> rays;
            for (int i = 0; i < 4000; ++i) {
                const float turn = random.uniform(0.0f, 6.2831853f);
                const vec3 rim = base + u * std::cos(turn) + v * std::sin(turn) + (i % 2 == 0 ? axis : vec3(0.0f));
                const vec3 origin = base + axis * random.uniform(0.1f, 0.9f) + u * random.uniform(-0.5f, 0.5f) +
                                    v * random.uniform(-0.5f, 0.5f);
                rays.push_back({origin, shared::normalize(rim - origin), 0.0f});
            }
            for (const std::uint32_t maxLinear : {0u, kAlwaysLinear}) {
                const auto accel = buildAccel(g, maxLinear);
                for (const NamedQuery& q : runnableQueries()) {
                    SCOPED_TRACE(q.name + " size " + std::to_string(size) + " shift " + std::to_string(shift));
                    EXPECT_EQ(countLeaks(*q.query, accel->view(), rays), 0);
                }
            }
        }
    }
}

TEST(Watertight, BoxesOfQuadsDoNotLeakAtEdgesAndCorners) {
    const Axes straight{vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    const Axes turned{vec3(0.8f, 0.36f, -0.48f), vec3(-0.6f, 0.48f, -0.64f), vec3(0.0f, 0.8f, 0.6f)};
    for (const Axes& axes : {straight, turned}) {
        for (const float size : {1e-4f, 1.0f, 555.0f, 1e4f}) {
            for (const float shift : {0.0f, 10.0f}) {
                const vec3 center = vec3(0.7f, -1.1f, 0.4f) * (size * shift);
                Geometry g = quadBox(center, size, axes);
                Random random(33);
                std::vector<Ray> rays;
                for (int i = 0; i < 4000; ++i) {
                    vec3 target(random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f));
                    const int free = i % 4; // the coordinate that varies along the edge; 3: a corner
                    for (int a = 0; a < 3; ++a) {
                        if (a != free) target[a] = random.uniform() < 0.5f ? -1.0f : 1.0f;
                    }
                    const vec3 origin = center + random.inCube(0.5f * size);
                    const vec3 world = center + (axes[0] * target.x + axes[1] * target.y + axes[2] * target.z) * size;
                    rays.push_back({origin, shared::normalize(world - origin), 0.0f});
                }
                for (const std::uint32_t maxLinear : {0u, kAlwaysLinear}) {
                    const auto accel = buildAccel(g, maxLinear);
                    for (const NamedQuery& q : runnableQueries()) {
                        SCOPED_TRACE(q.name + " size " + std::to_string(size) + " shift " + std::to_string(shift));
                        EXPECT_EQ(countLeaks(*q.query, accel->view(), rays), 0);
                    }
                }
            }
        }
    }
}

} // namespace
} // namespace rt::accel::testing
