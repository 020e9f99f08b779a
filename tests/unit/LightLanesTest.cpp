// Light sampling in lanes is that of one path at a time, bit for bit.
#include <bit>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "RayTracingCPU/SceneAccess.h"
#include "RayTracingCPU/SideBySide.h"
#include "tests/unit/LightDraws.h"
#include "tests/unit/LightShapes.h"

namespace rt::cpu {
namespace {

using glm::dvec3;
using test::Uniforms;

constexpr uint kFeatures = kFeatureQuads | kFeatureSpheres | kFeatureLambertian | kFeatureMetal | kFeatureFuzz |
                           kFeatureDielectric | kFeatureLights | kFeatureQuadLights | kFeatureSphereLights |
                           kFeatureTriangleLights | kFeatureMotion;

// A scene of lights alone, as the engine keeps them.
struct LitScene {
    std::vector<Light> lights;
    std::vector<LightBound> bounds;
    LightBoundsSoa soa;
    CpuScene scene;

    void add(const Light& light, float intensity) {
        LightBound bound{};
        const bool isSphere = light.kind == kLightSphere;
        bound.center = isSphere ? light.position : light.position + 0.5f * (light.edgeU + light.edgeV);
        bound.radius = isSphere ? light.radius : 0.5f * length(light.edgeU) + 0.5f * length(light.edgeV);
        bound.axis = isSphere ? vec3(0.0f) : light.normal;
        bound.twoSided = light.sides == kSidesBoth ? 1.0f : 0.0f;
        bound.intensity = intensity;
        setBound(soa, lights.size(), bound);
        lights.push_back(light);
        bounds.push_back(bound);
    }

    const CpuScene& get() {
        scene.lights = lights.data();
        scene.lightBounds = bounds.data();
        scene.lightBoundsSoa = &soa;
        scene.globals.lightCount = static_cast<uint>(lights.size());
        return scene;
    }
};

vec3 pointWithin(Uniforms& uniform, double extent) {
    return vec3(
        dvec3(uniform.between(-extent, extent), uniform.between(-extent, extent), uniform.between(-extent, extent)));
}

// Strips, squares, slanted quads, spheres at rest and moving, triangles; some of a size that encloses shading points.
Light randomLight(Uniforms& uniform) {
    const dvec3 at(pointWithin(uniform, 3));
    const double size = uniform.between(0.01, 2);
    const dvec3 edge = size * glm::normalize(dvec3(pointWithin(uniform, 1)));
    const dvec3 across = glm::normalize(glm::cross(edge, dvec3(pointWithin(uniform, 1))));
    Light light;
    switch (uniform.word() % 5) {
        case 0:
            light = sphere(at, size);
            light.edgeU = uniform.word() % 2 == 0 ? vec3(0.0f) : pointWithin(uniform, 1);
            break;
        case 1:
            light = triangle(at, at + edge, at + across);
            break;
        case 2:
            light = quad(at, edge, across + edge * 0.5);
            break;
        case 3:
            light = quad(at, edge, across * 0.02);
            break;
        default:
            light = quad(at, across * size * 0.5, edge);
    }
    light.sides = uniform.word() % 2 == 0 ? kSidesFront : kSidesBoth;
    light.emission = vec3(1.0f, 2.0f, 3.0f);
    light.material = kNone;
    return light;
}

LitScene randomScene(Uniforms& uniform, uint count) {
    LitScene scene;
    for (uint i = 0; i < count; ++i) scene.add(randomLight(uniform), static_cast<float>(uniform.between(0, 2)));
    for (uint i = 0; i < count; ++i) {
        scene.lights[i].selection = 1.0f / static_cast<float>(count);
        scene.lights[i].cdf = static_cast<float>(i + 1) / static_cast<float>(count);
    }
    return scene;
}

Vertex randomVertex(Uniforms& uniform) {
    Vertex v{};
    v.material = blackMaterial();
    v.material.kind = uniform.word() % 4 == 0 ? kMaterialMetal : kMaterialLambertian;
    v.material.parameter[kMetalFuzz] = 0.3f;
    v.position = pointWithin(uniform, 3);
    v.normal = normalize(pointWithin(uniform, 1));
    v.shading = normalize(v.normal + pointWithin(uniform, 0.2));
    v.wo = normalize(v.normal + pointWithin(uniform, 0.5));
    v.albedo = vec3(0.2f, 0.4f, 0.8f);
    v.error = vec3(1.0e-6f);
    v.origin = offsetOrigin(v.position, v.error, v.normal, v.normal);
    v.index = uniform.word() % 3;
    v.numbers.light = uniform.pair();
    v.numbers.bsdf = uniform.pair();
    v.numbers.choice = uniform.pair();
    return v;
}

// Equal bits, or neither is a number.
bool isSame(float a, float b) {
    return std::bit_cast<uint>(a) == std::bit_cast<uint>(b) || (a != a && b != b);
}
bool isSame(vec3 a, vec3 b) {
    return isSame(a.x, b.x) && isSame(a.y, b.y) && isSame(a.z, b.z);
}

struct Turn {
    Flight flights[kLanes]{};
    PathLanes lanes{};
    Vertex vertices[kLanes];
};

void fill(Turn& turn, uint policy, Uniforms& uniform) {
    for (uint i = 0; i < kLanes; ++i) {
        turn.vertices[i] = randomVertex(uniform);
        set(turn.lanes.vertices, i, turn.vertices[i]);
        setNumbers(turn.lanes.vertices, i, turn.vertices[i].numbers);
        PathState& path = turn.flights[i].path;
        path.throughput = vec3(0.5f, 0.25f, 1.0f);
        path.ray.time = static_cast<float>(uniform.between(0, 1));
        path.last = lightContext(RenderParams{}, turn.vertices[i]);
        path.last.policy = policy;
    }
}

DirectLight oneByOne(const CpuScene& scene, const RenderParams& params, const Vertex& v, PathState& path) {
    const LightChoice choice = chooseLight(kFeatures, scene, scene.globals.lightCount, v.numbers.light, path.last);
    return sampleDirectLight(kFeatures, scene, params, choice, v, path);
}

struct Seen {
    int spheres = 0;
    int quads = 0;
    int others = 0;
};

void compareTurn(const CpuScene& scene, const RenderParams& params, uint lit, Turn& turn, Seen& seen) {
    std::vector<PathState> paths;
    for (const Flight& f : turn.flights) paths.push_back(f.path);
    sampleLights<kFeatures>(scene, params, turn.flights, lit, turn.lanes);
    for (uint i = 0; i < kLanes; ++i) {
        if ((lit >> i & 1u) == 0u) continue;
        const DirectLight expected = oneByOne(scene, params, turn.vertices[i], paths[i]);
        const DirectLight direct = get(turn.lanes.direct, i);
        ASSERT_TRUE(isSame(direct.radiance, expected.radiance));
        ASSERT_TRUE(isSame(direct.distance, expected.distance));
        ASSERT_TRUE(isSame(turn.flights[i].path.last.total, paths[i].last.total));
        if (!(direct.distance > 0.0f)) continue;
        ASSERT_TRUE(isSame(direct.direction, expected.direction));
        const bool inLanes = turn.lanes.sampled.at[i] != 0u;
        const bool isSphere = scene.lights[turn.lanes.choices.light.at[i]].kind == kLightSphere;
        ++(!inLanes ? seen.others : isSphere ? seen.spheres : seen.quads);
    }
}

TEST(LightLanes, SamplesAreThoseOfOnePathAtATime) {
    Uniforms uniform(41);
    for (const uint method : {kShapeAuto, kShapeSolidAngle, kShapeArea}) {
        Seen seen;
        for (uint turns = 0; turns < 3000; ++turns) {
            LitScene scene = randomScene(uniform, 1 + turns % kContributionLights);
            RenderParams params = withMethod(method);
            params.lightSampling = turns % 2 == 0 ? kSampleMis : kSampleMisBalance;
            params.lightSelection = turns % 3; // all that there are
            Turn turn;
            fill(turn, params.lightSelection, uniform);
            compareTurn(scene.get(), params, turns % 5 == 0 ? uniform.word() & 0xffffu : 0xffffu, turn, seen);
            if (HasFatalFailure()) return;
        }
        EXPECT_GT(seen.others, 1000);
        EXPECT_EQ(seen.spheres > 1000, method == kShapeAuto);
        EXPECT_EQ(seen.quads > 1000, method == kShapeAuto);
    }
}

TEST(LightLanes, LanesNotInUseAreFilledWithAnything) {
    Uniforms uniform(42);
    Seen seen;
    LitScene scene = randomScene(uniform, 12);
    RenderParams params = withMethod(kShapeAuto);
    params.lightSampling = kSampleMis;
    params.lightSelection = kSelectContribution;
    for (const unsigned char byte : {0x00, 0x7f, 0xff}) { // zero, huge, not a number
        Turn turn;
        fill(turn, kSelectContribution, uniform);
        const PathLanes used = turn.lanes;
        std::memset(&turn.lanes, byte, sizeof turn.lanes);
        for (const uint i : {0u, 5u, 15u}) {
            set(turn.lanes.vertices, i, get(used.vertices, i));
            setNumbers(turn.lanes.vertices, i, turn.vertices[i].numbers);
        }
        compareTurn(scene.get(), params, 1u << 0 | 1u << 5 | 1u << 15, turn, seen);
    }
}

TEST(LightLanes, NumbersAreThoseOfTheVertices) {
    Uniforms uniform(43);
    for (const uint kind : {kSamplerSobol, kSamplerStratified, kSamplerIndependent}) {
        Turn turn;
        for (uint i = 0; i < kLanes; ++i) {
            Sampler& smp = turn.flights[i].smp;
            smp = {kind, uniform.word(), uniform.word() % 1000u, uniform.word() % 7u, 8u, 8u};
            turn.lanes.vertices.index.at[i] = uniform.word() % 9u;
        }
        drawNumbers<kFeatures | kFeatureManyLights>(turn.flights, 0xffffu, turn.lanes.vertices);
        for (uint i = 0; i < kLanes; ++i) {
            const VertexNumbers expected = vertexNumbers(turn.flights[i].smp, turn.lanes.vertices.index.at[i]);
            const VertexNumbers numbers = get(turn.lanes.vertices, i).numbers;
            EXPECT_EQ(numbers.light, expected.light);
            EXPECT_EQ(numbers.bsdf, expected.bsdf);
            EXPECT_EQ(numbers.choice, expected.choice);
            EXPECT_EQ(numbers.select, expected.select);
        }
    }
}

TEST(LightLanes, DirectionsAreThoseOfTheBsdf) {
    Uniforms uniform(44);
    for (int turns = 0; turns < 200; ++turns) {
        Turn turn;
        fill(turn, kSelectContribution, uniform);
        sampleDiffuse(turn.lanes);
        for (uint i = 0; i < kLanes; ++i) {
            const Vertex& v = turn.vertices[i];
            const BsdfSample expected = sampleScattering(kFeatures, v, v.numbers.bsdf);
            const BsdfSample b = sampleScattering<kFeatures>(turn.lanes, i, v);
            ASSERT_TRUE(isSame(b.wi, expected.wi) && isSame(b.weight, expected.weight) && isSame(b.pdf, expected.pdf));
            ASSERT_EQ(b.delta, expected.delta);
            ASSERT_EQ(b.transmitted, expected.transmitted);
        }
    }
}

} // namespace
} // namespace rt::cpu
