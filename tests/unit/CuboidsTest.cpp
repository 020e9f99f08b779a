// Cuboids among quads: found whatever way they are turned and written down, and hit where their faces are.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Accel/Cuboids.h"
#include "Common/Accel/GpuBvh.h"
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Shape/Shapes.h"
#include "tests/unit/AccelScene.h"

namespace rt::accel {
namespace {

using shared::Quad;
using shared::vec3;
using testing::Geometry;
using testing::Random;

// Three edges at right angles, turned at random.
std::array<vec3, 3> randomEdges(Random& random) {
    const shared::Frame frame = shared::makeFrame(random.direction());
    return {frame.tangent * random.uniform(0.2f, 3.0f), frame.bitangent * random.uniform(0.2f, 3.0f),
            frame.normal * random.uniform(0.2f, 3.0f)};
}

// The six faces in the order of Cuboid::faces, each from a corner and with edges that are drawn.
std::vector<Quad> facesOf(vec3 corner, const std::array<vec3, 3>& edges, Random& random) {
    std::vector<Quad> faces;
    for (std::size_t i = 0; i < 6; ++i) {
        vec3 at = corner + (i < 3 ? vec3(0.0f) : edges[i % 3]);
        vec3 u = edges[(i + 1) % 3], v = edges[(i + 2) % 3];
        for (std::size_t turns = random.below(4); turns > 0; --turns) {
            at += u;
            const vec3 first = u;
            u = v;
            v = -first;
        }
        if (random.below(2) == 0) std::swap(u, v);
        faces.push_back({at, u, v, shared::normalize(shared::cross(u, v)), 0, shared::kNone});
    }
    return faces;
}

std::vector<std::uint32_t> allOf(const std::vector<Quad>& quads) {
    std::vector<std::uint32_t> indices(quads.size());
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
}

TEST(Cuboids, AreFoundAmongOtherQuads) {
    Random random(7);
    for (int trial = 0; trial < 200; ++trial) {
        const vec3 corner = random.inCube(5.0f);
        std::vector<Quad> quads = facesOf(corner, randomEdges(random), random);
        const std::vector<Quad> others = facesOf(corner + vec3(0.3f, 0.1f, 0.2f), randomEdges(random), random);
        quads.insert(quads.begin() + static_cast<std::ptrdiff_t>(random.below(6)), others[0]);
        quads.push_back(others[2]);
        std::vector<std::uint32_t> candidates = allOf(quads);
        const std::vector<Cuboid> cuboids = findCuboids(quads, candidates);
        ASSERT_EQ(cuboids.size(), 1u) << trial;
        EXPECT_EQ(candidates.size(), 2u);
        for (std::size_t face = 0; face < 6; ++face) {
            const Cuboid& cuboid = cuboids[0];
            ASSERT_NE(cuboid.faces[face], shared::kNone);
            const Quad& quad = quads[cuboid.faces[face]];
            const vec3 middle = cuboid.corner + 0.5f * (cuboid.edges[(face + 1) % 3] + cuboid.edges[(face + 2) % 3]) +
                                (face < 3 ? vec3(0.0f) : cuboid.edges[face % 3]);
            EXPECT_LT(shared::length(quad.corner + 0.5f * (quad.edgeU + quad.edgeV) - middle), 1e-5f);
        }
    }
}

// Four faces make one, three do not; neither do faces that are a little too short, or that lean.
TEST(Cuboids, NeedFourFacesThatFit) {
    Random random(8);
    for (int trial = 0; trial < 50; ++trial) {
        const std::array<vec3, 3> edges = randomEdges(random);
        const std::vector<Quad> faces = facesOf(random.inCube(5.0f), edges, random);
        const auto found = [&](std::vector<Quad> quads) {
            std::vector<std::uint32_t> candidates = allOf(quads);
            return findCuboids(quads, candidates).size();
        };
        const std::vector<Quad> four{faces[0], faces[1], faces[2], faces[3]};
        EXPECT_EQ(found(four), 1u);
        EXPECT_EQ(found({faces[0], faces[1], faces[2]}), 0u);
        std::vector<Quad> shorter = four, leaning = four;
        shorter[3].edgeU *= 1.0001f;
        EXPECT_EQ(found(shorter), 0u);
        for (Quad& quad : leaning) {
            const auto lean = [&](vec3 v) { return v + 1e-3f * edges[0] * shared::dot(v, edges[1]); };
            quad.corner = lean(quad.corner);
            quad.edgeU = lean(quad.edgeU);
            quad.edgeV = lean(quad.edgeV);
        }
        EXPECT_EQ(found(leaning), 0u);
    }
}

// From outside and from inside: the same face at the same place as by the test of quads.
TEST(Cuboids, AreHitWhereTheirFacesAre) {
    Random random(9);
    int hits = 0, disagreements = 0;
    for (int trial = 0; trial < 100; ++trial) {
        Geometry geometry;
        const std::array<vec3, 3> edges = randomEdges(random);
        const vec3 corner = random.inCube(5.0f);
        for (const Quad& face : facesOf(corner, edges, random)) geometry.addQuad(face.corner, face.edgeU, face.edgeV);
        const LinearLists lists = buildGpuBvh(geometry.input())->lists;
        ASSERT_EQ(lists.cuboids, 1u);
        ASSERT_EQ(lists.quads, 0u);
        ASSERT_EQ(lists.vectors.size(), 4u);
        const auto row = [&](std::size_t i) { return vec3(lists.vectors[i]); };
        const auto local = [&](vec3 v) {
            return vec3(shared::dot(row(1), v), shared::dot(row(2), v), shared::dot(row(3), v));
        };
        const vec3 center = corner + 0.5f * (edges[0] + edges[1] + edges[2]);
        for (int i = 0; i < 200; ++i) {
            const float reach = i % 2 == 0 ? 0.45f : 4.0f; // within, mostly outside
            const vec3 from = center + edges[0] * random.uniform(-reach, reach) +
                              edges[1] * random.uniform(-reach, reach) + edges[2] * random.uniform(-reach, reach);
            const vec3 to = center + edges[0] * random.uniform(-0.6f, 0.6f) + edges[1] * random.uniform(-0.6f, 0.6f) +
                            edges[2] * random.uniform(-0.6f, 0.6f);
            const shared::Ray ray{from, shared::normalize(to - from), 0.0f};
            float nearest = 100.0f;
            std::uint32_t quad = shared::kNone;
            for (std::uint32_t q = 0; q < geometry.quads.size(); ++q) {
                const Quad& face = geometry.quads[q];
                const shared::ShapeHit hit =
                    shared::intersectQuad(ray, face.corner, shared::quadFrame(face.edgeU, face.edgeV), nearest);
                if (!(hit.t > 0.0f)) continue;
                nearest = hit.t;
                quad = q;
            }
            const shared::CuboidHit own = shared::intersectCuboid(local(row(0) - from), local(ray.direction));
            const bool isHit = own.enter <= own.leave && own.leave > 0.0f;
            const float t = own.enter > 0.0f ? own.enter : own.leave;
            if (isHit != (quad != shared::kNone) || (isHit && std::abs(t - nearest) > 1e-4f)) {
                ++disagreements; // at an edge
                continue;
            }
            if (!isHit) continue;
            ++hits;
            const shared::uint face = own.enter > 0.0f ? own.enterFace : own.leaveFace;
            const std::size_t side = face < 3 ? 0 : 1;
            const std::uint32_t faces = std::bit_cast<std::uint32_t>(lists.vectors[side].w);
            const std::uint32_t named = faces >> (8 * (face % 3)) & 255u;
            if (named != quad) ++disagreements;
            const Quad& met = geometry.quads[quad];
            const shared::vec2 uv = shared::rectanglePlace(ray, t, met.corner, met.edgeU, met.edgeV);
            const vec3 place = met.corner + met.edgeU * uv.x + met.edgeV * uv.y;
            EXPECT_LT(shared::length(place - (from + ray.direction * t)), 2e-5f * (1.0f + t));
        }
    }
    EXPECT_GT(hits, 10000);
    EXPECT_LE(disagreements, 5);
}

// Rays in the planes of the faces and through the middle, whose directions have zeros.
TEST(Cuboids, RaysAlongAxesAreNoTrouble) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const float offset : {0.0f, 0.5f, 1.0f, 1.5f}) {
            vec3 from(0.0f), direction(0.0f);
            from[axis] = -4.0f;
            from[(axis + 1) % 3] = offset;
            direction[axis] = 1.0f;
            const shared::CuboidHit hit = shared::intersectCuboid(-from, direction);
            EXPECT_EQ(hit.enter <= hit.leave, offset <= 1.0f) << axis << " " << offset;
            if (offset > 1.0f) continue;
            EXPECT_NEAR(hit.enter, 3.0f, 1e-5f);
            EXPECT_NEAR(hit.leave, 5.0f, 1e-5f);
            EXPECT_EQ(hit.enterFace, static_cast<shared::uint>(axis));
            EXPECT_EQ(hit.leaveFace, static_cast<shared::uint>(axis) + 3u);
        }
    }
}

} // namespace
} // namespace rt::accel
