// The scene compiler against brute force: transforms, media, degenerate geometry, the world's origin.
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/TextureTable.h"
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Texture/Checker.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::scene {
namespace {

// ---- transforms ----------------------------------------------------------------------------------------------------

TEST(SceneCompiler, NestedTransformsActInsideOut) {
    SceneDesc scene = withMaterials();
    const Transform inner = {Rotate{{0, 2, 0}, 15}, Scale{glm::dvec3(2)}, Translate{{265, 0, 295}}};
    const Transform outer = {Matrix{{0, 0, 1, 5, 0, 1, 0, 6, -1, 0, 0, 7}}}; // 90 degrees about +Y, then moved
    const auto expected = [](const glm::dvec3& p) {
        const glm::dvec3 q = 2.0 * rotatedY(p, 15) + glm::dvec3(265, 0, 295);
        return glm::dvec3(q.z + 5, q.y + 6, -q.x + 7);
    };
    add(scene, group(outer, group(inner, sphere({1, 2, 3}, 0.5, "matte"))));
    add(scene, group(outer, group(inner, quad({1, 2, 3}, {1, 0, 0.5}, {0, 1, 0}, "matte"))));
    add(scene, group(outer, group(inner, mesh(icosphere(0), "matte"))));
    const auto compiled = compileScene(scene);

    expectNear(compiled->spheres[0].center, expected({1, 2, 3}), 1e-4);
    EXPECT_NEAR(compiled->spheres[0].radius, 1.0, 1e-6);
    const shared::Quad& q = compiled->quads[0];
    expectNear(q.corner, expected({1, 2, 3}), 1e-4);
    expectNear(glm::dvec3(q.corner) + glm::dvec3(q.edgeU), expected({2, 2, 3.5}), 1e-4);
    expectNear(glm::dvec3(q.corner) + glm::dvec3(q.edgeV), expected({1, 3, 3}), 1e-4);
    const glm::dvec3 center = expected({0, 0, 0});
    for (const shared::vec3& position : compiled->positions)
        EXPECT_NEAR(glm::length(glm::dvec3(position) - center), 2.0, 1e-4);
}

TEST(SceneCompiler, RightAnglesAreExact) {
    SceneDesc scene = withMaterials();
    for (const double degrees : {90.0, 180.0, 270.0, -90.0, 3600.0 * 1000 + 90})
        add(scene, group({Rotate{{0, 0, 1}, degrees}}, quad({1, 1, 0}, {1, 0, 0}, {0, 1, 0}, "matte")));
    const auto compiled = compileScene(scene);
    EXPECT_EQ(compiled->quads[0].edgeU, shared::vec3(0, 1, 0));
    EXPECT_EQ(compiled->quads[1].edgeU, shared::vec3(-1, 0, 0));
    EXPECT_EQ(compiled->quads[2].edgeU, shared::vec3(0, -1, 0));
    EXPECT_EQ(compiled->quads[3].edgeU, shared::vec3(0, -1, 0));
    EXPECT_EQ(compiled->quads[4].edgeU, shared::vec3(0, 1, 0));
}

// The front of a mirrored surface is the image of its front.
TEST(SceneCompiler, MirrorsKeepFronts) {
    SceneDesc scene = withMaterials();
    scene.textures["map"] = ImageTexture{"none.jpg", "mars", glm::dvec3(1)};
    scene.materials["mapped"] = lambertian(std::string("map"));
    const Transform mirror = {Scale{{-1, 2, 1}}};
    const glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(1, 0, 0.3), glm::dvec3(0, 1, 0.2)));
    const glm::dvec3 mirrored = glm::normalize(normal / glm::dvec3(-1, 2, 1));
    add(scene, group(mirror, quad({0, 0, 0}, {1, 0, 0.3}, {0, 1, 0.2}, "matte")));
    add(scene, group(mirror, quad({0, 0, 0}, {1, 0, 0.3}, {0, 1, 0.2}, "mapped")));
    add(scene, group(mirror, mesh(icosphere(1), "matte")));
    add(scene, group(mirror, box({1, 1, 1}, {2, 2, 2}, "matte")));
    const auto compiled = compileScene(scene);

    expectNear(compiled->quads[0].normal, mirrored, 1e-6);
    ASSERT_EQ(compiled->quads.size(), 7u);
    for (std::size_t i = 1; i < 7; ++i) {
        const shared::Quad& face = compiled->quads[i];
        const glm::dvec3 middle = face.corner + 0.5f * (face.edgeU + face.edgeV);
        EXPECT_GT(glm::dot(glm::dvec3(face.normal), middle - glm::dvec3(-1.5, 3, 1.5)), 0);
    }
    for (std::size_t i = 0; i < compiled->triangles.size(); ++i) {
        const shared::uvec3 t = compiled->triangles[i];
        const glm::dvec3 a = compiled->positions[t.x], b = compiled->positions[t.y], c = compiled->positions[t.z];
        const glm::dvec3 front = glm::cross(b - a, c - a);
        if (compiled->triangleMesh[i] == 0) {
            expectNear(glm::normalize(front), mirrored, 1e-6);
            // Texture coordinates stay with the corners: u along edge_u.
            const shared::Mesh& m = compiled->meshes[0];
            for (const std::uint32_t v : {t.x, t.y, t.z})
                EXPECT_NEAR(compiled->uvs[v - m.firstVertex + m.firstUv].x, -compiled->positions[v].x, 1e-6);
        } else {
            EXPECT_GT(glm::dot(front, a), 0);
        }
    }
}

TEST(SceneCompiler, NormalsFollowTheInverseTranspose) {
    SceneDesc scene = withMaterials();
    MeshData ball = icosphere(2);
    ball.normals = ball.positions;
    add(scene, group({Scale{{3, 1, 0.5}}, Rotate{{1, 2, 3}, 40}}, mesh(ball, "matte")));
    const auto compiled = compileScene(scene);
    // An ellipsoid's normal is the gradient of its quadric; turned back, x^2/9 + y^2 + 4 z^2.
    const Affine back = toAffine({Rotate{{1, 2, 3}, -40}});
    for (std::size_t i = 0; i < compiled->positions.size(); ++i) {
        const glm::dvec3 p = back.vector(compiled->positions[i]);
        expectNear(back.vector(compiled->normals[i]), glm::normalize(p * glm::dvec3(1.0 / 9, 1, 4)), 1e-5);
    }
}

// ---- media ---------------------------------------------------------------------------------------------------------

TEST(SceneCompiler, MediaMapTheWorldToTheirUnitShapes) {
    SceneDesc scene = withMaterials();
    scene.camera.lookFrom = {100, 0, 0};
    MediumDesc smoke;
    smoke.boundary = BoxBoundary{{1, 2, 3}, {3, 6, 9}};
    smoke.density = 0.25;
    add(scene, group({Rotate{{0, 1, 0}, 30}, Translate{{0, 5, 0}}}, smoke));
    smoke.boundary = SphereBoundary{{1, 0, 0}, 2};
    add(scene, smoke);
    smoke.density = 0;
    add(scene, smoke);
    const auto compiled = compileScene(scene);
    ASSERT_EQ(compiled->media.size(), 2u);
    const auto local = [&](std::size_t i, const glm::dvec3& world) {
        glm::dvec3 q;
        for (int row = 0; row < 3; ++row) {
            const shared::vec4 r = compiled->media[i].toLocal[row];
            q[row] = glm::dot(glm::dvec3(r), world - scene.camera.lookFrom) + r.w;
        }
        return q;
    };
    EXPECT_EQ(compiled->media[0].shape, shared::kMediumBox);
    EXPECT_EQ(compiled->media[0].extinction, 0.25f);
    expectNear(local(0, rotatedY({3, 6, 9}, 30) + glm::dvec3(0, 5, 0)), {1, 1, 1}, 1e-5);
    expectNear(local(0, rotatedY({1, 2, 9}, 30) + glm::dvec3(0, 5, 0)), {-1, -1, 1}, 1e-5);
    EXPECT_EQ(compiled->media[1].shape, shared::kMediumSphere);
    expectNear(local(1, {3, 0, 0}), {1, 0, 0}, 1e-5);
    ASSERT_EQ(compiled->notices.size(), 1u);
    EXPECT_EQ(compiled->notices[0], "1 medium without volume or density was dropped");
}

// ---- degenerate geometry (numerics.md N7) --------------------------------------------------------------------------

bool isFinite(const shared::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// 16 bits a channel arrive as floats, and only the texture knows whether they are encoded.
TEST(SceneCompiler, ColorSpacesDecodeWhatIsEncoded) {
    constexpr float kEncoded = 0.5f + 1.0f / 65536; // no multiple of 1 / 255
    SceneDesc scene = withMaterials();
    ImageTexture image{RT_SOURCE_DIR "/Assets/scene.schema.json", {}}; // any file that exists
    scene.textures["srgb"] = image;
    image.colorSpace = ColorSpace::Linear;
    scene.textures["linear"] = image;
    for (const char* name : {"srgb", "linear"}) {
        scene.materials[name].albedo = name;
        add(scene, sphere({0, 0, -5}, 1, name));
    }
    CompileOptions options;
    options.loadTexels = [](const std::filesystem::path&, std::optional<std::uint32_t>) {
        const std::uint32_t word = shared::floatBitsToUint(kEncoded);
        return TexelData{1, 1, shared::kTexelLinearF32, {word, word, word}, true};
    };
    const auto compiled = compileScene(scene, options);
    ASSERT_EQ(compiled->texels.size(), 6u);
    EXPECT_NEAR(shared::uintBitsToFloat(compiled->texels[0]), std::pow((kEncoded + 0.055) / 1.055, 2.4), 1e-7);
    EXPECT_EQ(shared::uintBitsToFloat(compiled->texels[3]), kEncoded);
    options.loadTexels = [](const std::filesystem::path&, std::optional<std::uint32_t>) { // with opacity
        const std::uint32_t word = shared::floatBitsToUint(kEncoded);
        return TexelData{1, 1, shared::kTexelLinearF32A, {word, word, word, word}, true};
    };
    const auto translucent = compileScene(scene, options);
    ASSERT_EQ(translucent->texels.size(), 8u);
    EXPECT_EQ(translucent->texels[2], compiled->texels[2]);
    for (const std::size_t plain : {3u, 4u, 7u})
        EXPECT_EQ(shared::uintBitsToFloat(translucent->texels[plain]), kEncoded) << plain;
    const glm::dvec3 seen = texelColor(*translucent, translucent->images[0], 0, 0);
    EXPECT_EQ(seen.x, double(shared::uintBitsToFloat(compiled->texels[0])));
}

TEST(SceneCompiler, DegeneratePrimitivesAreDroppedAndCounted) {
    constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();
    const double bad[] = {kInf, -kInf, kNan, 1e300, -1e39};
    std::mt19937 random(4);
    SceneDesc clean = withMaterials(), fuzzed = withMaterials();
    MeshData cleanMesh, fuzzedMesh;
    std::uint64_t spheres = 0, quads = 0, triangles = 0;
    for (int i = 0; i < 10000; ++i) {
        const auto number = [&] { return std::uniform_real_distribution<double>(-5, 5)(random); };
        const auto point = [&] {
            const double x = number(), y = number();
            return glm::dvec3(x, y, number());
        };
        const bool isBad = random() % 2 == 0;
        glm::dvec3 a = point(), b = point(), c = point();
        double radius = 0.1 + std::abs(number());
        const int kind = i % 3;
        if (isBad) {
            switch (random() % 4) {
                case 0:
                    a[static_cast<int>(random() % 3)] = bad[random() % 5];
                    break;
                case 1:
                    b = kind == 1 ? glm::dvec3(0) : a, radius = -radius;
                    break;
                case 2:
                    c = kind == 1 ? 0.5 * b : b, radius = 0;
                    break;
                default:
                    b = c = kind == 1 ? glm::dvec3(1e-300, 0, 0) : a, radius = 5e-324;
                    break;
            }
        }
        if (kind == 0) {
            spheres += isBad;
            add(fuzzed, sphere(a, radius, "lamp"));
            if (!isBad) add(clean, sphere(a, radius, "lamp"));
        } else if (kind == 1) {
            quads += isBad;
            add(fuzzed, quad(a, b, c, "lamp"));
            if (!isBad) add(clean, quad(a, b, c, "lamp"));
        } else {
            triangles += isBad;
            for (MeshData* mesh : {&fuzzedMesh, &cleanMesh}) {
                if (isBad && mesh == &cleanMesh) continue;
                const auto first = static_cast<std::uint32_t>(mesh->positions.size());
                mesh->positions.insert(mesh->positions.end(), {a, b, c});
                mesh->triangles.emplace_back(first, first + 1, first + 2);
            }
        }
    }
    add(fuzzed, mesh(fuzzedMesh, "lamp"));
    add(clean, mesh(cleanMesh, "lamp"));
    const auto with = compileScene(fuzzed), without = compileScene(clean);
    EXPECT_EQ(with->hash, without->hash);
    EXPECT_TRUE(without->notices.empty());
    const std::vector<std::string> expected = {
        std::to_string(spheres) + " spheres without a usable centre or radius were dropped",
        std::to_string(quads) + " quads without area were dropped",
        std::to_string(triangles) + " triangles without area were dropped"};
    EXPECT_EQ(with->notices, expected);
    for (const shared::Light& light : with->lights) {
        EXPECT_TRUE(isFinite(light.position) && isFinite(light.normal) && std::isfinite(light.area));
    }
}

TEST(SceneCompiler, ExtremeButUsableGeometryStays) {
    SceneDesc scene = withMaterials();
    add(scene, quad({0, 0, 0}, {2e-9, 0, 0}, {0, 2e-9, 0}, "lamp"));
    add(scene, quad({0, 0, 0}, {2e9, 0, 0}, {0, 2e9, 0}, "lamp"));
    add(scene, quad({0, 0, 0}, {1, 0, 0}, {1, 1e-9, 0}, "lamp"));
    add(scene, sphere({0, 0, 0}, 2e-9, "lamp"));
    add(scene, sphere({0, 0, 0}, 2e9, "lamp"));
    const auto compiled = compileScene(scene);
    EXPECT_EQ(compiled->quads.size() + compiled->spheres.size(), 5u);
    for (const shared::Quad& quad : compiled->quads) EXPECT_EQ(quad.normal, shared::vec3(0, 0, 1));
    for (const shared::Light& light : compiled->lights) EXPECT_TRUE(light.area > 0 && std::isfinite(light.area));
}

TEST(SceneCompiler, WrongIndicesInCodeAreErrors) {
    SceneDesc scene = withMaterials();
    MeshData bad;
    bad.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    bad.triangles = {{0, 1, 3}};
    add(scene, mesh(bad, "matte"));
    EXPECT_NE(errorOf(scene).find("test: /objects/0: a triangle refers to vertex 3 of 3"), std::string::npos);
    scene.objects = {{sphere({0, 0, 0}, 1, "nothing")}};
    EXPECT_NE(errorOf(scene).find("material \"nothing\" is not defined"), std::string::npos);
    scene.objects = {{sphere({0, 0, 0}, 1, "matte")}};
    scene.materials["matte"].albedo = std::string("a");
    scene.textures["a"] = CheckerTexture{1, std::string("b"), glm::dvec3(1)};
    scene.textures["b"] = CheckerTexture{1, std::string("a"), glm::dvec3(1)};
    EXPECT_NE(errorOf(scene).find("refers to itself"), std::string::npos);
}

// ---- nested checkers -----------------------------------------------------------------------------------------------

// Textures "1" to "`depth`": checkers of the one before them, the innermost of two colours.
SceneDesc withNestedCheckers(int depth) {
    SceneDesc scene = withMaterials();
    const glm::dvec3 black(0), white(1);
    scene.textures["1"] = CheckerTexture{1, black, white};
    for (int i = 2; i <= depth; ++i)
        scene.textures[std::to_string(i)] = CheckerTexture{1, std::to_string(i - 1), white};
    scene.materials["matte"].albedo = std::to_string(depth);
    add(scene, sphere({0, 0, 0}, 1, "matte"));
    return scene;
}

TEST(SceneCompiler, CheckersNestToTheLimitOfTheKernels) {
    constexpr int kMax = shared::kMaxCheckerDepth;
    const std::string nine = "/textures/" + std::to_string(kMax + 1) + ": checkers are nested deeper than 8";
    EXPECT_NO_THROW(compileScene(withNestedCheckers(kMax)));
    EXPECT_NE(errorOf(withNestedCheckers(kMax + 1)).find(nine), std::string::npos);
    for (const int depth : {kMax + 2, 39, 100'000}) // not by exhausting the stack
        EXPECT_NE(errorOf(withNestedCheckers(depth)).find("nested deeper"), std::string::npos) << depth;
    // Around textures that another material has needed already.
    SceneDesc both = withNestedCheckers(kMax + 1);
    both.materials["inner"] = both.materials["matte"];
    both.materials["inner"].albedo = std::to_string(kMax);
    both.objects.insert(both.objects.begin(), {sphere({0, 0, 0}, 1, "inner")});
    EXPECT_NE(errorOf(both).find(nine), std::string::npos);
    // A checker may end in any other texture.
    SceneDesc noisy = withNestedCheckers(kMax);
    noisy.textures["1"] = CheckerTexture{1, std::string("noise"), glm::dvec3(1)};
    noisy.textures["noise"] = NoiseTexture{};
    EXPECT_NO_THROW(compileScene(noisy));
}

// ---- the world's origin --------------------------------------------------------------------------------------------

// numerics.md N20: the authored camera position is subtracted in double, so that distance costs nothing.
TEST(SceneCompiler, TranslatedScenesAreTheSame) {
    for (const char* id : {"cornell-box-lights", "next-week-cornell-smoke", "triangle-lights"}) {
        SceneDesc scene = findBuiltinScene(id);
        const auto near = compileScene(scene);
        const glm::dvec3 offset(1048576, -131072, 1048576);
        GroupDesc all;
        all.transform = {Translate{offset}};
        all.objects.swap(scene.objects);
        add(scene, all);
        scene.camera.lookFrom += offset;
        scene.camera.lookAt += offset;
        const auto far = compileScene(scene);
        ASSERT_EQ(near->spheres.size(), far->spheres.size());
        for (std::size_t i = 0; i < near->spheres.size(); ++i)
            EXPECT_EQ(near->spheres[i].center, far->spheres[i].center);
        for (std::size_t i = 0; i < near->quads.size(); ++i) {
            expectNear(near->quads[i].corner, far->quads[i].corner, 3e-5);
            EXPECT_EQ(near->quads[i].edgeU, far->quads[i].edgeU);
        }
        for (std::size_t i = 0; i < near->positions.size(); ++i)
            expectNear(near->positions[i], far->positions[i], 1e-6);
        for (std::size_t i = 0; i < near->media.size(); ++i)
            for (int row = 0; row < 3; ++row) expectNear(near->media[i].toLocal[row], far->media[i].toLocal[row], 1e-6);
        EXPECT_EQ(near->lights.size(), far->lights.size());
        EXPECT_NEAR(near->globals.sceneRadius, far->globals.sceneRadius, 1e-3);
    }
}

TEST(SceneCompiler, CoordinatesAreRelativeToTheCamera) {
    const auto compiled = compileScene(findBuiltinScene("cornell-box-lights"));
    EXPECT_EQ(compiled->origin, glm::dvec3(278, 278, -800));
    EXPECT_EQ(compiled->globals.origin, shared::vec3(278, 278, -800));
    EXPECT_EQ(compiled->spheres[0].center, shared::vec3(530 - 278, 530 - 278, 277 + 800));
}

// Materials of glTF whose mode is BLEND say nothing else.
TEST(SceneCompiler, OpacityOfVerticesIsOpacity) {
    for (const double opacity : {1.0, 0.5}) {
        SceneDesc scene = withMaterials();
        scene.materials["veil"].kind = MaterialKind::Principled;
        MeshData data;
        data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        data.colors = {{1, 1, 1, 1}, {1, 1, 1, opacity}, {1, 1, 1, 1}};
        data.triangles = {{0, 1, 2}};
        add(scene, mesh(data, "veil"));
        const bool letsRaysThrough = shared::has(compileScene(scene)->features, shared::kFeatureOpacity);
        EXPECT_EQ(letsRaysThrough, opacity < 1);
    }
}

// ---- hash ----------------------------------------------------------------------------------------------------------

TEST(SceneCompiler, TheHashTellsScenesApart) {
    const SceneDesc scene = findBuiltinScene("rest-of-life-cornell-box-glass");
    const std::uint64_t hash = compileScene(scene)->hash;
    EXPECT_EQ(compileScene(scene)->hash, hash);
    SceneDesc changed = scene;
    changed.camera.verticalFov = 50;
    changed.title = "Other";
    EXPECT_EQ(compileScene(changed)->hash, hash) << "neither camera angle nor title affects the scene";
    changed = scene;
    changed.materials["glass"].parameters[shared::kDielectricIor] = 1.5000002;
    EXPECT_NE(compileScene(changed)->hash, hash);
    changed = scene;
    changed.importanceTargets.clear();
    EXPECT_NE(compileScene(changed)->hash, hash);
    changed = scene;
    std::swap(changed.objects[0], changed.objects[1]);
    EXPECT_NE(compileScene(changed)->hash, hash);
    CompileOptions options;
    options.oneSidedLights = false;
    EXPECT_NE(compileScene(scene, options)->hash, hash);
}

} // namespace
} // namespace rt::scene
