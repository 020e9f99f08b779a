// Every built-in scene: it compiles, keeps the promises of the compiled scene, and survives a scene file bit for bit.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "Common/App/Session/FeatureNames.h"
#include "Common/Core/Error.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/SceneCases.h"

namespace rt::scene {
namespace {

CompileOptions generated() {
    CompileOptions options;
    options.generatedAssets = true;
    return options;
}

template <typename Record>
bool sameBits(const std::vector<Record>& a, const std::vector<Record>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Record)) == 0);
}

void expectSame(const CompiledScene& a, const CompiledScene& b) {
    EXPECT_EQ(a.hash, b.hash);
    EXPECT_EQ(a.features, b.features);
    EXPECT_EQ(a.camera, b.camera);
    EXPECT_EQ(a.defaults, b.defaults);
    EXPECT_EQ(a.title, b.title);
    EXPECT_EQ(a.notices, b.notices);
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_TRUE(sameBits(a.spheres, b.spheres));
    EXPECT_TRUE(sameBits(a.sphereMotions, b.sphereMotions));
    EXPECT_TRUE(sameBits(a.quads, b.quads));
    EXPECT_TRUE(sameBits(a.positions, b.positions));
    EXPECT_TRUE(sameBits(a.normals, b.normals));
    EXPECT_TRUE(sameBits(a.uvs, b.uvs));
    EXPECT_TRUE(sameBits(a.triangles, b.triangles));
    EXPECT_TRUE(sameBits(a.meshes, b.meshes));
    EXPECT_TRUE(sameBits(a.triangleMesh, b.triangleMesh));
    EXPECT_TRUE(sameBits(a.geometries, b.geometries));
    EXPECT_TRUE(sameBits(a.instances, b.instances));
    EXPECT_TRUE(sameBits(a.materials, b.materials));
    EXPECT_TRUE(sameBits(a.textures, b.textures));
    EXPECT_TRUE(sameBits(a.images, b.images));
    EXPECT_TRUE(sameBits(a.texels, b.texels));
    EXPECT_TRUE(sameBits(a.perlinGradients, b.perlinGradients));
    EXPECT_TRUE(sameBits(a.perlinPermutations, b.perlinPermutations));
    EXPECT_TRUE(sameBits(a.media, b.media));
    EXPECT_TRUE(sameBits(a.lights, b.lights));
    EXPECT_TRUE(sameBits(a.lightBounds, b.lightBounds));
    EXPECT_TRUE(sameBits(a.skyCdf, b.skyCdf));
    EXPECT_EQ(std::memcmp(&a.globals, &b.globals, sizeof a.globals), 0);
}

bool isIndex(std::uint32_t index, std::size_t size) {
    return index == shared::kNone || index < size;
}

// The promises of CompiledScene.h, those that hold for every scene.
void expectValid(const CompiledScene& s) {
    ASSERT_FALSE(s.geometries.empty());
    EXPECT_TRUE(s.sphereMotions.empty() || s.sphereMotions.size() == s.spheres.size());
    EXPECT_EQ(s.triangleMesh.size(), s.triangles.size());
    EXPECT_EQ(s.lightBounds.size(), s.lights.size());
    EXPECT_EQ(s.lights.size(), s.globals.lightCount + s.globals.targetCount);
    EXPECT_EQ(s.media.size(), s.globals.mediumCount);
    EXPECT_EQ(s.instances.size(), s.globals.instanceCount);

    std::uint32_t spheres = 0, quads = 0, triangles = 0;
    for (const shared::Geometry& g : s.geometries) {
        EXPECT_EQ(g.firstSphere, spheres);
        EXPECT_EQ(g.firstQuad, quads);
        EXPECT_EQ(g.firstTriangle, triangles);
        spheres += g.sphereCount, quads += g.quadCount, triangles += g.triangleCount;
    }
    EXPECT_EQ(spheres, s.spheres.size());
    EXPECT_EQ(quads, s.quads.size());
    EXPECT_EQ(triangles, s.triangles.size());

    for (std::size_t i = 0; i < s.spheres.size(); ++i) {
        const shared::Sphere& sphere = s.spheres[i];
        ASSERT_TRUE(sphere.radius > 0 && sphere.material < s.materials.size() &&
                    isIndex(sphere.light, s.globals.lightCount));
        if (sphere.light != shared::kNone) {
            const shared::Light& light = s.lights[sphere.light];
            EXPECT_EQ(light.kind, shared::kLightSphere);
            EXPECT_EQ(light.position, sphere.center);
            EXPECT_EQ(light.radius, sphere.radius);
        }
    }
    for (const shared::Quad& quad : s.quads) {
        ASSERT_TRUE(quad.material < s.materials.size() && isIndex(quad.light, s.globals.lightCount));
        EXPECT_NEAR(glm::dot(quad.normal, quad.normal), 1, 1e-6);
        EXPECT_GT(glm::dot(quad.normal, glm::cross(quad.edgeU, quad.edgeV)), 0);
    }
    for (std::size_t i = 0; i < s.triangles.size(); ++i) {
        const shared::Mesh& mesh = s.meshes.at(s.triangleMesh[i]);
        ASSERT_TRUE(i >= mesh.firstTriangle && i < mesh.firstTriangle + mesh.triangleCount);
        ASSERT_LT(std::max({s.triangles[i].x, s.triangles[i].y, s.triangles[i].z}), s.positions.size());
        ASSERT_GE(std::min({s.triangles[i].x, s.triangles[i].y, s.triangles[i].z}), mesh.firstVertex);
        if (mesh.firstLight != shared::kNone) {
            ASSERT_EQ(s.lights.at(mesh.firstLight + i - mesh.firstTriangle).position, s.positions[s.triangles[i].x]);
        }
    }
    for (const shared::Mesh& mesh : s.meshes) EXPECT_LT(mesh.material, s.materials.size());
    for (const shared::vec3& normal : s.normals) ASSERT_NEAR(glm::dot(normal, normal), 1, 1e-5);
    for (const shared::Material& m : s.materials) {
        EXPECT_TRUE(isIndex(m.texture, s.textures.size()) && isIndex(m.emissionTexture, s.textures.size()));
    }
    for (const shared::Instance& instance : s.instances) {
        EXPECT_TRUE(instance.geometry > 0 && instance.geometry < s.geometries.size());
        EXPECT_TRUE(isIndex(instance.material, s.materials.size()));
    }
    // Probabilities are the very widths of the distribution function, on the grid of uniform numbers.
    float before = 0;
    for (std::uint32_t i = 0; i < s.globals.lightCount; ++i) {
        EXPECT_EQ(s.lights[i].selection, s.lights[i].cdf - before);
        EXPECT_GE(s.lights[i].selection, 0x1p-24f);
        EXPECT_EQ(s.lights[i].cdf * 0x1p24f, std::floor(s.lights[i].cdf * 0x1p24f));
        before = s.lights[i].cdf;
    }
    EXPECT_EQ(before, s.globals.lightCount > 0 ? 1.0f : 0.0f);
    for (std::size_t i = 0; i < s.lights.size(); ++i) {
        EXPECT_GT(s.lights[i].area, 0);
        EXPECT_GT(s.lightBounds[i].radius, 0);
    }
}

// Features decide which code runs at all; a wrong bit is a wrong picture.
std::map<std::string, shared::Features> expectedFeatures() {
    using namespace shared;
    const Features cornell =
        kFeatureQuads | kFeatureLambertian | kFeatureEmissive | kFeatureLights | kFeatureQuadLights;
    const Features book = kFeatureSpheres | kFeatureLambertian | kFeatureSky;
    const Features field = book | kFeatureMetal | kFeatureFuzz | kFeatureDielectric | kFeatureThinLens;
    const Features mesh = kFeatureTriangles | kFeatureSmoothNormals;
    return {
        {"cornell-box-lights", cornell | kFeatureSpheres | kFeatureDielectric | kFeatureSphereLights},
        {"one-weekend-default", book},
        {"one-weekend-test", book},
        {"one-weekend-final", field},
        {"next-week-default", book | kFeatureMovingSpheres | kFeatureThinLens},
        {"next-week-random-spheres", field | kFeatureMovingSpheres | kFeatureChecker},
        {"next-week-two-spheres", book | kFeatureChecker},
        {"next-week-earth", book | kFeatureImages},
        {"next-week-two-perlin-spheres", book | kFeatureNoise},
        {"next-week-quads", kFeatureQuads | kFeatureLambertian | kFeatureSky},
        {"next-week-simple-light", cornell | kFeatureSpheres | kFeatureNoise | kFeatureSphereLights},
        {"next-week-cornell-box", cornell},
        {"next-week-cornell-smoke", cornell | kFeatureVolumes},
        {"next-week-final", cornell | kFeatureSpheres | kFeatureMovingSpheres | kFeatureMetal | kFeatureFuzz |
                                kFeatureDielectric | kFeatureVolumes | kFeatureImages | kFeatureNoise},
        {"rest-of-life-cornell-box", cornell},
        {"rest-of-life-cornell-box-mirror", cornell | kFeatureMetal},
        {"rest-of-life-cornell-box-glass", cornell | kFeatureSpheres | kFeatureDielectric | kFeatureSphereLights},
        {"white-spheres", cornell | kFeatureSpheres},
        {"cube-and-spheres", book | kFeatureTriangles | kFeatureMetal | kFeatureFuzz | kFeatureDielectric |
                                 kFeatureImages | kFeatureThinLens},
        {"planets-in-one-weekend", field | kFeatureImages},
        {"lucy-in-one-weekend", field | mesh | kFeatureInstances},
        {"cornell-box-lucy", cornell | mesh | kFeatureSpheres | kFeatureDielectric},
        {"veach-mis", cornell | kFeatureSpheres | kFeatureMetal | kFeatureFuzz | kFeatureSphereLights},
        {"many-lights", cornell | kFeatureSpheres | kFeatureTriangles | kFeatureMetal | kFeatureFuzz |
                            kFeatureDielectric | kFeatureManyLights | kFeatureSphereLights | kFeatureTriangleLights},
        {"triangle-lights", (cornell & ~kFeatureQuadLights) | kFeatureSpheres | kFeatureTriangles | kFeatureMetal |
                                kFeatureFuzz | kFeatureDielectric | kFeatureManyLights | kFeatureTriangleLights},
        {"furnace", cornell | kFeatureSpheres | kFeatureTriangles | kFeatureManyLights | kFeatureSphereLights |
                        kFeatureTriangleLights},
        {"furnace-mixed", cornell | kFeatureSpheres | kFeatureTriangles | kFeatureMetal | kFeatureDielectric |
                              kFeatureVolumes | kFeatureManyLights | kFeatureSphereLights | kFeatureTriangleLights},
    };
}

class BuiltinScenes : public testing::TestWithParam<std::string> {};

TEST_P(BuiltinScenes, IsValidAndSurvivesAFile) {
    const SceneDesc desc = findBuiltinScene(GetParam());
    const auto compiled = compileScene(desc, generated());
    expectValid(*compiled);
    EXPECT_EQ(compiled->id, GetParam());
    EXPECT_EQ(compiled->features, expectedFeatures().at(GetParam()));

    SceneDesc loaded = parseScene(toJson(desc), "scene.json", {});
    loaded.id = desc.id;
    EXPECT_EQ(loaded, desc);
    expectSame(*compileScene(loaded, generated()), *compiled);
}

std::vector<std::string> allIds() {
    std::vector<std::string> ids;
    for (const BuiltinScene& scene : builtinScenes()) ids.emplace_back(scene.id);
    return ids;
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenes, testing::ValuesIn(allIds()),
                         [](const auto& info) { return test::caseName(info.param); });

TEST(VariedScenes, HaveEveryFeatureOfBuiltinScenes) {
    shared::Features ofVaried{}, ofAll{};
    std::size_t varied = 0;
    for (const BuiltinScene& scene : builtinScenes()) {
        const auto compiled = compileScene(findBuiltinScene(std::string(scene.id)), generated());
        ofAll = ofAll | compiled->features;
        if (!test::isVaried(scene.id)) continue;
        ofVaried = ofVaried | compiled->features;
        ++varied;
    }
    EXPECT_EQ(varied, test::kVariedScenes.size()); // each name is a scene's
    EXPECT_EQ(app::featureNames(ofVaried), app::featureNames(ofAll));
}

std::string errorOf(const std::string& id) {
    try {
        findBuiltinScene(id);
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), ExitCode::Input);
        return error.what();
    }
    return "";
}

TEST(BuiltinScenesTable, NamesAreUniqueAndDescribed) {
    std::set<std::string_view> ids;
    for (const BuiltinScene& scene : builtinScenes()) {
        EXPECT_TRUE(ids.insert(scene.id).second) << scene.id;
        EXPECT_FALSE(scene.title.empty() || scene.description.empty()) << scene.id;
    }
    EXPECT_EQ(builtinScenes()[0].id, "cornell-box-lights");
}

TEST(BuiltinScenesTable, UnknownNamesSuggestNearOnes) {
    EXPECT_NE(errorOf("cornel-box-lights").find("nearest: cornell-box-lights"), std::string::npos);
    EXPECT_NE(errorOf("lucy").find("lucy-in-one-weekend"), std::string::npos);
    EXPECT_NE(errorOf("").find("nearest"), std::string::npos);
}

TEST(BuiltinScenesTable, CountsAreChecked) {
    EXPECT_EQ(compileScene(findBuiltinScene("white-spheres:17"))->spheres.size(), 17u);
    EXPECT_EQ(compileScene(findBuiltinScene("white-spheres"))->spheres.size(), 20000u);
    for (const std::string count : {"1", "2", "3", "100"})
        EXPECT_EQ(compileScene(findBuiltinScene("many-lights:" + count))->globals.lightCount, std::stoul(count));
    for (const std::string count : {"", "0", "-1", "10000001", "99999999999999999999", "1.5", "1x", " 1", "abc"})
        EXPECT_NE(errorOf("white-spheres:" + count).find("from 1 to 10000000"), std::string::npos) << count;
    EXPECT_NE(errorOf("furnace:3").find("takes no count"), std::string::npos);
}

} // namespace
} // namespace rt::scene
