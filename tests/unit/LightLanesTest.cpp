// Light sampling in lanes is that of one path at a time, bit for bit.
#include <bit>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/LightTable.h"
#include "RayTracingCPU/LightLanes.h"
#include "tests/unit/LightDraws.h"
#include "tests/unit/LightShapes.h"

namespace rt::cpu {
namespace {

using glm::dvec3;
using test::Uniforms;

constexpr Features kFeatures = kFeatureQuads | kFeatureSpheres | kFeatureLambertian | kFeatureMetal | kFeatureFuzz |
                               kFeatureDielectric | kFeatureLights | kFeatureQuadLights | kFeatureSphereLights |
                               kFeatureTriangleLights | kFeatureMovingSpheres;

// A scene of lights alone, with the table that the scene compiler makes of them.
struct LitScene {
    scene::CompiledScene compiled;
    CpuScene scene;

    const CpuScene& get() {
        scene.lights = compiled.lights.data();
        scene.lightBounds = compiled.lightBounds.data();
        scene.globals.lightCount = compiled.globals.lightCount;
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
    for (uint i = 0; i < count; ++i) {
        scene.compiled.lights.push_back(randomLight(uniform));
        scene.compiled.lights.back().emission *= static_cast<float>(uniform.between(0, 2));
    }
    scene::finishLights(scene.compiled);
    return scene;
}

Vertex randomVertex(Uniforms& uniform) {
    Vertex v{};
    v.bsdf.kind = uniform.word() % 4 == 0 ? kMaterialMetal : kMaterialLambertian;
    v.bsdf.parameter[kMetalFuzz] = 0.3f;
    v.position = pointWithin(uniform, 3);
    v.normal = normalize(pointWithin(uniform, 1));
    v.shading = normalize(v.normal + pointWithin(uniform, 0.2));
    v.wo = normalize(v.normal + pointWithin(uniform, 0.5));
    v.bsdf.albedo = vec3(0.2f, 0.4f, 0.8f);
    v.error = vec3(1.0e-6f);
    v.origin = offsetOrigin(v.position, v.error, v.normal, v.normal);
    v.index = uniform.word() % 3;
    return v;
}

// Equal bits, or neither is a number.
bool isSame(float a, float b) {
    return std::bit_cast<uint>(a) == std::bit_cast<uint>(b) || (a != a && b != b);
}
bool isSame(vec3 a, vec3 b) {
    return isSame(a.x, b.x) && isSame(a.y, b.y) && isSame(a.z, b.z);
}

// What an iteration of a packet has got to when it samples lights.
struct Iteration {
    PathState paths[kLanes];
    Vertex vertices[kLanes];
    VertexSamples samples[kLanes];
    PathLanes lanes{};
};

void setLane(Iteration& it, uint i) {
    set(it.lanes.vertices, i, it.vertices[i]);
    set(it.lanes.u, i, it.samples[i]);
    set(it.lanes.throughput, i, it.paths[i].throughput);
    it.lanes.time.at[i] = it.paths[i].ray.time;
}

void fill(Iteration& it, Uniforms& uniform) {
    for (uint i = 0; i < kLanes; ++i) {
        it.vertices[i] = randomVertex(uniform);
        it.samples[i] = {};
        it.samples[i].light = uniform.pair();
        PathState& path = it.paths[i];
        path.throughput = vec3(0.5f, 0.25f, 1.0f);
        path.ray.time = static_cast<float>(uniform.between(0, 1));
        path.last = lightContext(it.vertices[i]);
        setLane(it, i);
    }
}

// The stages of one path.
DirectLight sampleAlone(const CpuScene& scene, const RenderParams& params, Iteration& it, uint i) {
    const vec2 u = lightSelectionSample(kFeatures, params, scene.globals, it.samples[i]);
    PathState& path = it.paths[i];
    const LightChoice choice =
        chooseLight(kFeatures, scene, params.lightSelection, scene.globals.lightCount, u, path.last);
    return sampleDirectLight(kFeatures, scene, params, choice, it.vertices[i], it.samples[i], path);
}

struct Seen {
    int spheres = 0;
    int quads = 0;
    int others = 0;
};

void compare(const CpuScene& scene, const RenderParams& params, uint lit, Iteration& it, Seen& seen) {
    chooseLights<kFeatures>(scene, params, lit, it.lanes);
    sampleDirectLights<kFeatures>(scene, params, lit, it.lanes);
    for (uint i = 0; i < kLanes; ++i) {
        if ((lit >> i & 1u) == 0u) continue;
        const DirectLight expected = sampleAlone(scene, params, it, i);
        const DirectLight direct = get(it.lanes.direct, i);
        ASSERT_TRUE(isSame(direct.radiance, expected.radiance));
        ASSERT_TRUE(isSame(direct.distance, expected.distance));
        ASSERT_TRUE(isSame(it.lanes.total.at[i], it.paths[i].last.total));
        if (!(direct.distance > 0.0f)) continue;
        ASSERT_TRUE(isSame(direct.direction, expected.direction));
        const bool inLanes = it.lanes.isSampled.at[i] != 0u;
        const bool isSphere = scene.lights[get(it.lanes.choices, i).light].kind == kLightSphere;
        ++(!inLanes ? seen.others : isSphere ? seen.spheres : seen.quads);
    }
}

TEST(LightLanes, SamplesAreThoseOfOnePathAtATime) {
    Uniforms uniform(41);
    for (const uint method : {kShapeAuto, kShapeSolidAngle, kShapeArea}) {
        Seen seen;
        for (uint round = 0; round < 3000; ++round) {
            LitScene scene = randomScene(uniform, 1 + round % kContributionLights);
            RenderParams params = withMethod(method);
            params.lightSampling = round % 2 == 0 ? kSampleMis : kSampleMisBalance;
            params.lightSelection = round % 3; // all that there are
            Iteration it;
            fill(it, uniform);
            compare(scene.get(), params, round % 5 == 0 ? uniform.word() & 0xffffu : 0xffffu, it, seen);
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
        Iteration it;
        fill(it, uniform);
        std::memset(&it.lanes, byte, sizeof it.lanes);
        for (const uint i : {0u, 5u, 15u}) setLane(it, i);
        compare(scene.get(), params, 1u << 0 | 1u << 5 | 1u << 15, it, seen);
    }
}

// A list of a record's fields keeps each of them, and what is omitted comes back as zero.
TEST(Lanes, RecordsComeBackAsTheyWere) {
    Uniforms uniform(43);
    RecordLanes<Vertex> lanes;
    Vertex vertices[kLanes];
    for (uint i = 0; i < kLanes; ++i) {
        vertices[i] = randomVertex(uniform);
        set(lanes, i, vertices[i]);
    }
    for (uint i = 0; i < kLanes; ++i) {
        const Vertex v = get(lanes, i);
        EXPECT_EQ(v.index, vertices[i].index);
        EXPECT_EQ(v.bsdf.kind, vertices[i].bsdf.kind);
        EXPECT_EQ(v.bsdf.parameter[kMetalFuzz], vertices[i].bsdf.parameter[kMetalFuzz]);
        EXPECT_TRUE(isSame(v.wo, vertices[i].wo));
        EXPECT_TRUE(isSame(v.origin, vertices[i].origin));
        EXPECT_TRUE(isSame(get(lanesOf<&Vertex::origin>(lanes), i), v.origin));
    }
}

} // namespace
} // namespace rt::cpu
