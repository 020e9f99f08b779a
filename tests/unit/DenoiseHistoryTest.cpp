// What a live picture takes over from the one before: where a point was, whether it is the same one, and how much it
// counts.
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "Common/Scene/CameraRecord.h"
#include "Common/Shared/Denoise/DenoiseHistory.h"

namespace rt::test::history { // whose names are not those of other tests
namespace {

using namespace rt::shared;

constexpr int kDraws = 2000;

float uniform(std::mt19937& random, float from, float to) {
    return std::uniform_real_distribution<float>(from, to)(random);
}
vec3 directionOf(std::mt19937& random) {
    const vec3 v(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    return normalize(v + vec3(1e-3f, 0, 0));
}

Camera cameraOf(std::mt19937& random) {
    scene::CameraDesc desc;
    desc.lookFrom = glm::dvec3(directionOf(random)) * 3.0;
    desc.lookAt = glm::dvec3(directionOf(random));
    desc.up = {0.1, 1, 0.2};
    desc.verticalFov = uniform(random, 20, 110);
    desc.focusDistance = uniform(random, 0.5f, 20);
    return scene::makeCamera(desc, 160, 90, {0, 0, 0});
}

TEST(DenoiseHistory, APointIsWhereItsRayHasBegun) {
    std::mt19937 random(1);
    for (int i = 0; i < kDraws; ++i) {
        const Camera camera = cameraOf(random);
        const vec2 place(uniform(random, 0, 1), uniform(random, 0, 1));
        const float depth = uniform(random, 0.1f, 100);
        const vec3 point = historyDirection(camera, place) * depth;
        const vec3 found = historyPlace(camera, point);
        ASSERT_NEAR(found.x, place.x, 1e-5f);
        ASSERT_NEAR(found.y, place.y, 1e-5f);
        ASSERT_GT(found.z, 0);
        ASSERT_FALSE(historyPlace(camera, -point).z > 0);
        // The next pixel's point on the plane across the view is a pixel's width away.
        const vec3 beside = historyDirection(camera, vec2(place.x + 1.0f / 160, place.y));
        const float width = length(beside * (found.z / historyPlace(camera, beside).z) - point);
        ASSERT_NEAR(width, historyPixelWidth(camera, found.z, 160), 2e-3f * width);
    }
}

HistorySurface wall() {
    return {vec3(0.1f, 0.2f, -5), vec3(0, 0, 1), vec3(0.5f, 0.5f, 0.5f), true};
}

TEST(DenoiseHistory, OnlyTheSameSurfaceIsTakenOver) {
    constexpr float kPixel = 0.01f;
    const HistorySurface now = wall();
    EXPECT_TRUE(isSameSurface(now, now, kPixel));
    HistorySurface last = wall();
    last.point += vec3(3, 0, 0); // in its plane: which pixel it is, is the projection's affair
    EXPECT_TRUE(isSameSurface(now, last, kPixel));
    last.point.z += 0.3f; // in front of it
    EXPECT_FALSE(isSameSurface(now, last, kPixel));
    EXPECT_TRUE(isSameSurface(now, last, 0.3f)); // but not for pixels as large as that
    last = wall();
    last.normal = vec3(0.6f, 0, 0.8f);
    EXPECT_FALSE(isSameSurface(now, last, kPixel));
    last = wall();
    last.albedo.x = 0.8f;
    EXPECT_FALSE(isSameSurface(now, last, kPixel));
    last = wall();
    last.isHit = false;
    EXPECT_FALSE(isSameSurface(now, last, kPixel));
    EXPECT_FALSE(isSameSurface(last, now, kPixel));
    EXPECT_TRUE(isSameSurface(last, last, kPixel));
}

// Scaling a scene by a power of two decides nothing.
TEST(DenoiseHistory, LengthsHaveNoUnit) {
    std::mt19937 random(2);
    for (int i = 0; i < kDraws; ++i) {
        HistorySurface now = wall(), last = wall();
        last.point.z += uniform(random, 0, 0.2f);
        const bool isSame = isSameSurface(now, last, 0.02f);
        now.point *= 1024.0f;
        last.point *= 1024.0f;
        ASSERT_EQ(isSameSurface(now, last, 1024 * 0.02f), isSame);
    }
}

TEST(DenoiseHistory, IsTheMeanOfAllSamplesUntilItIsFull) {
    std::mt19937 random(3);
    vec4 history(0, 0, 0, 0);
    double sum = 0;
    for (int i = 1; i <= static_cast<int>(kHistorySamples); ++i) {
        const float sample = uniform(random, 0, 2);
        sum += sample;
        history = withNewSamples(history, vec3(sample, 2 * sample, 0), 1);
        EXPECT_FLOAT_EQ(history.w, static_cast<float>(i));
        EXPECT_NEAR(history.x, sum / i, 1e-5);
        EXPECT_NEAR(history.y, 2 * sum / i, 2e-5);
    }
    // From then on what is old fades: after n frames (1 - 1 / (n + 1))^n of it are left.
    const vec4 full(1, 1, 1, kHistorySamples);
    vec4 fading = full;
    for (int i = 0; i < static_cast<int>(kHistorySamples); ++i) {
        fading = withNewSamples(fading, vec3(0, 0, 0), 1);
        EXPECT_EQ(fading.w, kHistorySamples);
    }
    EXPECT_NEAR(fading.x, std::pow(1 - 1 / (kHistorySamples + 1.0), kHistorySamples), 1e-5);
    // New samples of a film count as many as they are, and what is the same stays the same.
    EXPECT_FLOAT_EQ(withNewSamples(full, vec3(0, 0, 0), 3 * kHistorySamples).x, 0.25f);
    const vec4 same = withNewSamples(vec4(0.1f, 0.7f, 3, 5), vec3(0.1f, 0.7f, 3), 2);
    EXPECT_EQ(same, vec4(0.1f, 0.7f, 3, 7));
    EXPECT_EQ(withNewSamples(vec4(0, 0, 0, 0), vec3(0.1f, 0.7f, 3), 2), vec4(0.1f, 0.7f, 3, 2));
}

// Of a square of pixels, of which each adds a difference.
struct Square {
    double sum = 0, squares = 0;
    int count = 0;
    void add(double value) {
        sum += value;
        squares += value * value;
        ++count;
    }
    float trust() const { return historyTrust(static_cast<float>(sum / count), static_cast<float>(squares / count)); }
};

TEST(DenoiseHistory, NoiseIsTrustedAndOtherLightIsNot) {
    std::mt19937 random(4);
    std::exponential_distribution<double> noise(1);
    constexpr int kSquares = 400, kPixels = 49;
    double ofNoise = 0, ofChange = 0;
    for (int i = 0; i < kSquares; ++i) {
        Square same, changed;
        for (int p = 0; p < kPixels; ++p) {
            const double fresh = noise(random);
            same.add(fresh - 1);
            changed.add(0.2 * fresh - 1); // a fifth of the light is left
        }
        ofNoise += same.trust() / kSquares;
        ofChange += changed.trust() / kSquares;
    }
    EXPECT_GT(ofNoise, 0.97);
    EXPECT_LT(ofChange, 0.01);
    EXPECT_EQ(historyTrust(0, 0), 1); // no difference at all
    EXPECT_EQ(historyTrust(3, 9), 0); // nothing but difference
}

TEST(DenoiseHistory, LampsBesideWallsAreEdgesAndNoiseOfAHalfIsNot) {
    EXPECT_TRUE(isHistoryEdge(vec2(0.6f, 0.6f), vec2(45, 45)));
    EXPECT_FALSE(isHistoryEdge(vec2(0.6f, 0.6f), vec2(45, 0.9f)));
    EXPECT_FALSE(isHistoryEdge(vec2(0.6f, 0.6f), vec2(1.5f, 1.5f)));
    EXPECT_FALSE(isHistoryEdge(vec2(0, 0), vec2(0.02f, 0.02f))); // both are black to the eye
    EXPECT_FALSE(isHistoryEdge(vec2(1e15f, 1e15f), vec2(0, 0))); // no pixel at all
}

TEST(DenoiseHistory, SurfacesFitIntoAWord) {
    std::mt19937 random(5);
    for (int i = 0; i < kDraws; ++i) {
        HistorySurface surface{directionOf(random), directionOf(random), vec3(0, 0, 0), true};
        surface.albedo = vec3(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1));
        const HistorySurface got = unpackHistorySurface(surface.point, packHistorySurface(surface));
        ASSERT_TRUE(got.isHit);
        ASSERT_EQ(got.point, surface.point);
        ASSERT_GT(dot(got.normal, surface.normal), 0.9998f); // a degree
        ASSERT_LE(length(got.albedo - surface.albedo), std::sqrt(3.0f) * 0.5f / 31 + 1e-6f);
    }
    HistorySurface sky = wall();
    sky.isHit = false;
    EXPECT_FALSE(unpackHistorySurface(sky.point, packHistorySurface(sky)).isHit);
}

} // namespace
} // namespace rt::test::history
