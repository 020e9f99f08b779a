#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <vector>

#include "Common/Shared/Texture/Textures.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::Mean;
using test::Uniforms;

struct TextureScene : SceneArraysOf<std::vector> {
    operator SceneView() const { return viewOf(*this, {}); }
};

Texture makeTexture(uint kind, const vec3& color, float scale, float frequency, uint first, uint second) {
    return {kind, color, scale, frequency, first, second, kWrapClamp, kWrapClamp, 0, vec3(1, 0, 0), vec3(0, 1, 0)};
}

// In floats from the start: the oracle must see the very same point.
vec3 pointWithin(Uniforms& uniform, float extent) {
    return (vec3(uniform(), uniform(), uniform()) * 2.0f - 1.0f) * extent;
}

TextureScene perlinScene(uint tables) {
    TextureScene scene;
    Uniforms uniform(1);
    for (uint t = 0; t < tables; ++t) {
        for (uint i = 0; i < kPerlinSize; ++i) {
            const dvec3 v(uniform.between(-1, 1), uniform.between(-1, 1), uniform.between(-1, 1));
            scene.perlinGradients.emplace_back(glm::normalize(v));
        }
        for (int axis = 0; axis < 3; ++axis) {
            std::array<uint, kPerlinSize> p{};
            std::iota(p.begin(), p.end(), 0u);
            for (uint i = kPerlinSize - 1; i > 0; --i) std::swap(p[i], p[uniform.word() % (i + 1)]);
            scene.perlinPermutations.insert(scene.perlinPermutations.end(), p.begin(), p.end());
        }
    }
    return scene;
}

// Gradient noise as the book describes it, in double.
double exactNoise(const TextureScene& scene, uint table, const dvec3& p) {
    const dvec3 cell = glm::floor(p), f = p - cell, s = f * f * (3.0 - 2.0 * f);
    double sum = 0;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            for (int k = 0; k < 2; ++k) {
                const auto at = [&](int axis, double c) {
                    return scene.perlinPermutations[table * 768 + axis * 256 + (static_cast<long>(c) & 255)];
                };
                const uint hash = at(0, cell.x + i) ^ at(1, cell.y + j) ^ at(2, cell.z + k);
                const dvec3 gradient(scene.perlinGradients[table * 256 + hash]);
                const double weight = (i ? s.x : 1 - s.x) * (j ? s.y : 1 - s.y) * (k ? s.z : 1 - s.z);
                sum += weight * glm::dot(gradient, f - dvec3(i, j, k));
            }
    return sum;
}

double exactTurbulence(const TextureScene& scene, uint table, dvec3 p) {
    double sum = 0;
    for (int octave = 0; octave < 7; ++octave)
        sum += std::ldexp(exactNoise(scene, table, std::ldexp(1.0, octave) * p), -octave);
    return std::abs(sum);
}

vec3 evaluate(const TextureScene& scene, uint texture, const vec3& point, const vec2& uv = vec2(0)) {
    return vec3(evalTexture(kFeatureAll, scene, texture, point, uv, uv));
}

// ---- coordinates ---------------------------------------------------------------------------------------------------

TEST(Textures, SphereCoordinates) {
    EXPECT_NEAR(sphereUv(vec3(1, 0, 0)).x, 0.5f, 1e-6f);
    EXPECT_NEAR(sphereUv(vec3(0, 0, 1)).x, 0.25f, 1e-6f);
    EXPECT_NEAR(sphereUv(vec3(0, 0, -1)).x, 0.75f, 1e-6f);
    EXPECT_EQ(sphereUv(vec3(0, 1, 0)).y, 1.0f);
    EXPECT_EQ(sphereUv(vec3(0, -1, 0)).y, 0.0f);
    Uniforms uniform(2);
    for (int i = 0; i < 100000; ++i) {
        const vec3 n = sampleSphere(uniform.pair());
        const vec2 uv = sphereUv(n);
        ASSERT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
        ASSERT_NEAR(uv.x, (std::atan2(-double(n.z), double(n.x)) + std::numbers::pi) / (2 * std::numbers::pi), 5e-7);
        const double r = std::hypot(double(n.x), double(n.z));
        ASSERT_NEAR(uv.y, std::atan2(r, -double(n.y)) / std::numbers::pi, 5e-7);
    }
}

// ---- checker -------------------------------------------------------------------------------------------------------

TextureScene checkerScene() {
    TextureScene scene;
    scene.textures.resize(5);
    scene.textures[0] = makeTexture(kTextureChecker, vec3(1), 0.32f, 0, 1, 2);
    scene.textures[1] = makeTexture(kTextureSolid, vec3(1, 0, 0), 1, 0, 0, 0);
    scene.textures[2] = makeTexture(kTextureSolid, vec3(0, 1, 0), 1, 0, 0, 0);
    scene.textures[3] = makeTexture(kTextureChecker, vec3(1), 1, 0, 0, 4); // even cells hold another checker
    scene.textures[4] = makeTexture(kTextureSolid, vec3(0, 0, 1), 1, 0, 0, 0);
    return scene;
}

TEST(Textures, CheckerIsTheParityOfTheCell) {
    const TextureScene scene = checkerScene();
    EXPECT_EQ(evaluate(scene, 0, vec3(0.1f)), vec3(1, 0, 0));
    EXPECT_EQ(evaluate(scene, 0, vec3(0.4f, 0.1f, 0.1f)), vec3(0, 1, 0));
    EXPECT_EQ(evaluate(scene, 0, vec3(-0.1f, 0.1f, 0.1f)), vec3(0, 1, 0));
    EXPECT_EQ(evaluate(scene, 0, vec3(-0.1f, -0.1f, 0.1f)), vec3(1, 0, 0));
    EXPECT_EQ(evaluate(scene, 0, vec3(-0.1f, -0.1f, -0.1f)), vec3(0, 1, 0));
    Uniforms uniform(3);
    for (int i = 0; i < 10000; ++i) {
        const vec3 p = pointWithin(uniform, 1000);
        const dvec3 scaled = dvec3(p) / double(0.32f), cell = glm::floor(scaled);
        if (std::min({scaled.x - cell.x, scaled.y - cell.y, scaled.z - cell.z}) < 1e-3) continue;
        if (std::max({scaled.x - cell.x, scaled.y - cell.y, scaled.z - cell.z}) > 0.999) continue;
        const bool even = (static_cast<long>(cell.x + cell.y + cell.z) & 1) == 0;
        ASSERT_EQ(evaluate(scene, 0, p).x == 1, even);
    }
}

TEST(Textures, CheckersNestWithoutRecursion) {
    const TextureScene scene = checkerScene();
    EXPECT_EQ(evaluate(scene, 3, vec3(0.1f)), vec3(1, 0, 0));
    EXPECT_EQ(evaluate(scene, 3, vec3(0.4f, 0.1f, 0.1f)), vec3(0, 1, 0));
    EXPECT_EQ(evaluate(scene, 3, vec3(1.1f, 0.1f, 0.1f)), vec3(0, 0, 1));
    // A checker that refers to itself ends, with some colour.
    TextureScene cyclic;
    cyclic.textures.push_back(makeTexture(kTextureChecker, vec3(0.5f), 1, 0, 0, 0));
    EXPECT_TRUE(isFinite(vec3(evalTexture(kFeatureChecker, cyclic, 0, vec3(0), vec2(0), vec2(0)))));
}

// What the compiler refuses must not make a kernel read beyond a table: `first` of a checker is no Perlin table.
TEST(Textures, CheckersNestedTooDeepAreNotTakenForNoise) {
    TextureScene scene;
    for (uint i = 0; i <= kMaxCheckerDepth; ++i)
        scene.textures.push_back(makeTexture(kTextureChecker, vec3(0.25f), 1, 0, i + 1, i + 1));
    scene.textures.push_back(makeTexture(kTextureSolid, vec3(1), 1, 0, 0, 0));
    const Features features = kFeatureChecker | kFeatureNoise | kFeatureImages;
    EXPECT_EQ(vec3(evalTexture(features, scene, 1, vec3(0.5f), vec2(0), vec2(0))), vec3(1)) << "as deep as is allowed";
    EXPECT_EQ(vec3(evalTexture(features, scene, 0, vec3(0.5f), vec2(0), vec2(0))), vec3(0.25f)) << "one too deep";
}

// ---- noise ---------------------------------------------------------------------------------------------------------

TEST(Textures, NoiseMatchesTheBook) {
    const TextureScene scene = perlinScene(2);
    Uniforms uniform(4);
    Mean values;
    for (int i = 0; i < 20000; ++i) {
        const vec3 p = pointWithin(uniform, 300);
        const uint table = i & 1;
        const double exact = exactNoise(scene, table, dvec3(p));
        ASSERT_NEAR(perlinNoise(scene, table, p), exact, 1e-6);
        ASSERT_LE(std::abs(exact), 1.0);
        values.add(exact);
        if (i < 2000) {
            const vec3 near = p * 0.02f;
            ASSERT_NEAR(perlinTurbulence(scene, table, near), exactTurbulence(scene, table, dvec3(near)), 2e-6);
        }
    }
    EXPECT_GT(values.variance(), 0.02);
    // Zero on the lattice, continuous across it, of period 256, finite far out.
    for (int i = 0; i < 100; ++i) {
        const vec3 p(floor(float(uniform.between(-300, 300))), float(uniform.between(-3, 3)),
                     float(uniform.between(-3, 3)));
        EXPECT_EQ(perlinNoise(scene, 0, floor(p)), 0.0f);
        EXPECT_NEAR(perlinNoise(scene, 0, p - vec3(1e-4f, 0, 0)), perlinNoise(scene, 0, p + vec3(1e-4f, 0, 0)), 1e-3f);
        const vec3 q(0.25f, 0.5f, float(i) / 128.0f);
        EXPECT_EQ(perlinNoise(scene, 0, q), perlinNoise(scene, 0, q + 256.0f));
        EXPECT_EQ(perlinNoise(scene, 0, q), perlinNoise(scene, 0, q - 256.0f));
    }
    EXPECT_TRUE(isFinite(perlinTurbulence(scene, 0, vec3(1e20f, -1e30f, 3e7f))));
}

TEST(Textures, NoiseKinds) {
    TextureScene scene = perlinScene(1);
    const vec3 tint(0.5f, 1, 2);
    scene.textures.push_back(makeTexture(kTextureMarble, tint, 4, 4, 0, 0));
    scene.textures.push_back(makeTexture(kTextureTurbulence, tint, 4, 0, 0, 0));
    scene.textures.push_back(makeTexture(kTextureNoise, tint, 4, 0, 0, 0));
    Uniforms uniform(5);
    for (int i = 0; i < 2000; ++i) {
        const vec3 p = pointWithin(uniform, 5);
        const dvec3 scaled(p * 4.0f);
        const double turbulence = exactTurbulence(scene, 0, scaled);
        const vec3 marble = evaluate(scene, 0, p);
        ASSERT_NEAR(marble.y, 0.5 * (1 + std::sin(4 * double(p.z) + 10 * turbulence)), 3e-4);
        ASSERT_NEAR(marble.x, 0.5f * marble.y, 1e-7f);
        ASSERT_NEAR(evaluate(scene, 1, p).y, turbulence, 2e-5);
        ASSERT_NEAR(evaluate(scene, 2, p).y, 0.5 * (1 + exactNoise(scene, 0, scaled)), 1e-5);
    }
}

// ---- images --------------------------------------------------------------------------------------------------------

TextureScene imageScene() {
    TextureScene scene;
    scene.images.push_back({2, 4, 3, kTexelLinearF32});
    scene.texels.resize(2);
    for (uint y = 0; y < 3; ++y)
        for (uint x = 0; x < 4; ++x)
            for (const float channel : {float(x), float(y), 1.0f}) scene.texels.push_back(floatBitsToUint(channel));
    scene.textures.push_back(makeTexture(kTextureImage, vec3(1, 1, 0.5f), 1, 0, 0, 0));
    return scene;
}

TEST(Textures, FloatsMayHaveOpacity) {
    TextureScene scene;
    scene.images.push_back({1, 2, 1, kTexelLinearF32A});
    scene.texels.push_back(0);
    for (const float value : {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f})
        scene.texels.push_back(floatBitsToUint(value));
    EXPECT_EQ(loadTexel(scene, scene.images[0], 0, 0), vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(loadTexel(scene, scene.images[0], 1, 0), vec4(0.5f, 0.6f, 0.7f, 0.8f));
}

TEST(Textures, ImageIsBilinearBetweenTexelCentres) {
    const TextureScene scene = imageScene();
    const auto at = [&](float u, float v) { return evaluate(scene, 0, vec3(0), vec2(u, v)); };
    for (uint y = 0; y < 3; ++y)
        for (uint x = 0; x < 4; ++x) {
            const vec3 color = at((float(x) + 0.5f) / 4, 1 - (float(y) + 0.5f) / 3); // v = 1 is the first row
            EXPECT_NEAR(color.x, float(x), 1e-6f);
            EXPECT_NEAR(color.y, float(y), 1e-6f);
            EXPECT_EQ(color.z, 0.5f);
        }
    Uniforms uniform(6);
    for (int i = 0; i < 1000; ++i) {
        const float u = uniform(), v = uniform();
        EXPECT_NEAR(at(u, v).x, std::clamp(u * 4 - 0.5f, 0.0f, 3.0f), 1e-6f);
        EXPECT_NEAR(at(u, v).y, std::clamp((1 - v) * 3 - 0.5f, 0.0f, 2.0f), 1e-6f);
    }
    // Beyond the edge the edge goes on, and no texel outside is fetched.
    EXPECT_EQ(at(-7, 0.5f).x, 0.0f);
    EXPECT_EQ(at(1, 0.5f).x, 3.0f);
    EXPECT_EQ(at(9, 0.5f).x, 3.0f);
    EXPECT_EQ(at(0.5f, 1).y, 0.0f);
    EXPECT_EQ(at(0.5f, -1e30f).y, 2.0f);
}

TEST(Textures, ImagesWrap) {
    TextureScene scene = imageScene();
    Texture& t = scene.textures[0];
    const auto at = [&](float u, float v) { return vec2(evaluate(scene, 0, vec3(0), vec2(u, v))); };
    Uniforms uniform(7);
    for (int i = 0; i < 200; ++i) {
        const float u = uniform(), v = uniform();
        t.wrapU = t.wrapV = kWrapRepeat;
        const vec2 inside = at(u, v);
        EXPECT_NEAR(at(u + 3, v - 2).x, inside.x, 1e-4f);
        EXPECT_NEAR(at(u - 5, v + 7).y, inside.y, 1e-4f);
        t.wrapU = t.wrapV = kWrapMirror;
        const vec2 mirrored = at(u, v);
        EXPECT_NEAR(at(-u, v).x, mirrored.x, 1e-4f);
        EXPECT_NEAR(at(2 - u, 2 + v).x, mirrored.x, 1e-4f);
        EXPECT_NEAR(at(4 + u, -v).y, mirrored.y, 1e-4f);
    }
    // Across the seam the last column mixes with the first, and not with itself.
    t.wrapU = t.wrapV = kWrapRepeat;
    EXPECT_NEAR(at(0, 0.5f).x, 1.5f, 1e-6f);
    t.wrapU = kWrapMirror;
    EXPECT_NEAR(at(0, 0.5f).x, 0.0f, 1e-6f);
    for (const float far : {1e30f, -1e30f, 3e38f}) EXPECT_TRUE(isFinite(at(far, far).x));
}

TEST(Textures, CoordinatesOfImagesAreTransformed) {
    TextureScene scene = imageScene();
    Texture& t = scene.textures[0];
    t.uRow = vec3(0, 0.5f, 0.25f); // a quarter turn, to half the size
    t.vRow = vec3(-0.5f, 0, 0.75f);
    const vec2 turned = vec2(evaluate(scene, 0, vec3(0), vec2(0.3f, 0.6f)));
    t.uRow = vec3(1, 0, 0);
    t.vRow = vec3(0, 1, 0);
    EXPECT_NEAR(turned.x, evaluate(scene, 0, vec3(0), vec2(0.55f, 0.6f)).x, 1e-5f);
    EXPECT_NEAR(turned.y, evaluate(scene, 0, vec3(0), vec2(0.55f, 0.6f)).y, 1e-5f);
    t.uvSet = 1;
    EXPECT_EQ(evalTexture(kFeatureAll, scene, 0, vec3(0), vec2(0), vec2(0.55f, 0.6f)),
              evalTexture(kFeatureAll, scene, 0, vec3(0), vec2(9), vec2(0.55f, 0.6f)));
}

TEST(Textures, EightBitsMayBeLinearAndHaveOpacity) {
    TextureScene scene;
    scene.images.push_back({0, 1, 1, kTexelLinear8});
    scene.texels.push_back(0x40ff8000u);
    scene.textures.push_back(makeTexture(kTextureImage, vec3(0.5f, 1, 1), 1, 0, 0, 0));
    const vec4 texel = evalTexture(kFeatureAll, scene, 0, vec3(0), vec2(0.5f), vec2(0.5f));
    EXPECT_EQ(texel.x, 0.0f);
    EXPECT_NEAR(texel.y, 128.0f / 255.0f, 1e-6f);
    EXPECT_NEAR(texel.z, 1.0f, 1e-6f);
    EXPECT_NEAR(texel.w, 64.0f / 255.0f, 1e-6f);
}

TEST(Textures, SolidNeedsNoFeature) {
    const TextureScene scene = checkerScene();
    EXPECT_EQ(vec3(evalTexture(kFeatureNone, scene, 1, vec3(0), vec2(0), vec2(0))), vec3(1, 0, 0));
}

} // namespace
} // namespace rt::shared
