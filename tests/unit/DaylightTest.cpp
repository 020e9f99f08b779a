// The daylight of a clear sky, and the image that is made of it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Primaries.h"
#include "Common/Scene/Compiler/SunSkyMap.h"
#include "Common/Scene/Daylight.h"
#include "tests/unit/Oracles.h"

namespace rt::scene {
namespace {

using glm::dvec3;
using test::kPi;

constexpr double kLuxOfPi = 1e5; // the illuminance that is an irradiance of pi

SunSkyBackground skyOf(double turbidity, double elevation) {
    SunSkyBackground sky;
    sky.turbidity = turbidity;
    sky.sunElevation = elevation;
    return sky;
}

dvec3 toYxy(const dvec3& rgb) {
    const dvec3 xyz = toXyz(kRec709).value() * rgb;
    const double sum = xyz.x + xyz.y + xyz.z;
    return {xyz.y, xyz.x / sum, xyz.y / sum};
}

// ---- formulas ------------------------------------------------------------------------------------------------------

// Luminance in kcd/m2 and chromaticity, worked out apart from the code.
struct SkySample {
    double turbidity, elevation, zenith, toSun;
    dvec3 yxy;
};
constexpr SkySample kSkySamples[] = {
    {2, 60, 0, 30, {5.88674, 0.251421, 0.255924}},
    {3, 40, 80, 30, {18.9187, 0.310376, 0.319015}},
    {3, 40, 80, 130, {7.5294, 0.279643, 0.296513}},
    {6, 20, 45, 76.0045546411, {6.41918, 0.283433, 0.304766}},
    {10, 5, 85, 29.8831752231, {4.84662, 0.437038, 0.403615}},
    {2.5, 89, 30, 29.7895047857, {10.7211, 0.250328, 0.255712}},
};

TEST(Daylight, SkiesAreThoseOfTheModel) {
    for (const SkySample& sample : kSkySamples) {
        const Daylight daylight(skyOf(sample.turbidity, sample.elevation));
        const dvec3 yxy = toYxy(daylight.sky(std::cos(glm::radians(sample.zenith)), glm::radians(sample.toSun)));
        EXPECT_NEAR(yxy.x / (kPi / kLuxOfPi * 1e3 * sample.yxy.x), 1, 1e-5) << sample.turbidity;
        EXPECT_NEAR(yxy.y, sample.yxy.y, 1e-5) << sample.turbidity;
        EXPECT_NEAR(yxy.z, sample.yxy.z, 1e-5) << sample.turbidity;
    }
}

// Illuminance across the sun's direction in lx, likewise. Of the last three the colour is beyond Rec. 709.
struct SunSample {
    double turbidity, elevation;
    dvec3 yxy;
    bool isInGamut;
};
constexpr SunSample kSunSamples[] = {
    {2, 90, {106508, 0.335676, 0.347206}, true},  {3, 40, {80672.3, 0.348383, 0.35886}, true},
    {6, 20, {22381.5, 0.400541, 0.395353}, true}, {10, 5, {6.66861, 0.602921, 0.386281}, false},
    {3, 1, {69.9682, 0.605603, 0.386315}, false},
};

TEST(Daylight, TheSunShinesThroughTheAir) {
    for (const SunSample& sample : kSunSamples) {
        const dvec3 sun = Daylight(skyOf(sample.turbidity, sample.elevation)).sun(), yxy = toYxy(sun);
        EXPECT_NEAR(yxy.x / (kPi / kLuxOfPi * sample.yxy.x), 1, 1e-5) << sample.turbidity;
        if (sample.isInGamut) {
            EXPECT_NEAR(yxy.y, sample.yxy.y, 1e-5) << sample.turbidity;
            EXPECT_NEAR(yxy.z, sample.yxy.z, 1e-5) << sample.turbidity;
        } else {
            EXPECT_GT(sun.r, sun.g);
            EXPECT_EQ(sun.b, 0);
        }
    }
}

// What anybody can see: blue away from the sun, brighter around it; a low sun is weaker and redder, haze makes the sky
// whiter and the sun weaker.
TEST(Daylight, IsAsOneKnowsIt) {
    const Daylight clear(skyOf(2.5, 50)), hazy(skyOf(8, 50)), evening(skyOf(2.5, 5));
    const dvec3 away = clear.sky(std::cos(glm::radians(30.0)), glm::radians(70.0)),
                white = hazy.sky(std::cos(glm::radians(30.0)), glm::radians(70.0));
    EXPECT_GT(away.b, 1.8 * away.r);
    EXPECT_LT(white.b / white.r, 0.8 * away.b / away.r);
    EXPECT_GT(clear.sky(std::cos(glm::radians(40.0)), glm::radians(1.0)).g,
              3 * clear.sky(std::cos(glm::radians(40.0)), glm::radians(80.0)).g);
    EXPECT_LT(hazy.sun().g, 0.8 * clear.sun().g);
    EXPECT_LT(evening.sun().g, 0.3 * clear.sun().g);
    EXPECT_GT(evening.sun().r / evening.sun().b, 2 * clear.sun().r / clear.sun().b);
}

// ---- the image -----------------------------------------------------------------------------------------------------

struct SkyMap {
    explicit SkyMap(const SunSkyBackground& sky) { image = scene.images[appendSunSkyMap(sky, scene)]; }

    dvec3 at(std::uint32_t row, std::uint32_t column) const {
        dvec3 color;
        const std::size_t first = image.firstTexel + 3 * (std::size_t{row} * image.width + column);
        for (int c = 0; c < 3; ++c)
            color[c] = shared::uintBitsToFloat(scene.texels[first + static_cast<std::size_t>(c)]);
        return color;
    }
    double solidAngle(std::uint32_t row) const {
        const auto cosine = [&](double edge) { return std::cos(kPi * edge / image.height); };
        return 2 * kPi / image.width * (cosine(row) - cosine(row + 1.0));
    }
    // To the middle of a texel, in the image's frame: +X is its middle.
    dvec3 direction(std::uint32_t row, std::uint32_t column) const {
        const double down = kPi * (row + 0.5) / image.height, around = 2 * kPi * ((column + 0.5) / image.width - 0.5);
        return {std::sin(down) * std::cos(around), std::cos(down), std::sin(down) * std::sin(around)};
    }

    CompiledScene scene;
    shared::Image image{};
};

TEST(SunSkyMap, IsFiniteAndLit) {
    for (const double turbidity : {kLeastTurbidity, kMostTurbidity})
        for (const double elevation : {0.0, 0.1, 45.0, 90.0}) {
            const SkyMap map(skyOf(turbidity, elevation));
            std::size_t bad = 0;
            for (std::uint32_t row = 0; row < map.image.height; ++row)
                for (std::uint32_t column = 0; column < map.image.width; ++column) {
                    const dvec3 color = map.at(row, column);
                    for (int c = 0; c < 3; ++c) bad += !(std::isfinite(color[c]) && color[c] >= 0);
                    bad += !(color.g > 0);
                }
            EXPECT_EQ(bad, 0u) << turbidity << " " << elevation;
        }
}

// The irradiance of the sky by a quadrature in other coordinates: around the sun.
dvec3 irradianceBelow(const SunSkyBackground& sky) {
    constexpr int kRings = 400, kSectors = 400;
    const Daylight daylight(sky);
    const double height = glm::radians(sky.sunElevation);
    const dvec3 sun(std::cos(height), std::sin(height), 0), side(0, 0, 1), up = glm::cross(side, sun);
    dvec3 sum(0);
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            const double toSun = kPi * (i + 0.5) / kRings, around = 2 * kPi * (j + 0.5) / kSectors;
            const dvec3 d = std::cos(toSun) * sun + std::sin(toSun) * (std::cos(around) * up + std::sin(around) * side);
            if (d.y > 0) sum += std::sin(toSun) * d.y * daylight.sky(d.y, toSun);
        }
    return 2 * kPi * kPi / (kRings * kSectors) * sum + std::sin(height) * daylight.sun();
}

TEST(SunSkyMap, LightsTheGroundAsSunAndSkyDo) {
    for (const double elevation : {5.0, 40.0, 90.0}) {
        SunSkyBackground sky = skyOf(3, elevation);
        sky.ground = {0.4, 0.3, 0.2};
        const SkyMap map(sky);
        dvec3 irradiance(0);
        for (std::uint32_t row = 0; row < map.image.height / 2; ++row)
            for (std::uint32_t column = 0; column < map.image.width; ++column)
                irradiance += map.solidAngle(row) * map.direction(row, column).y * map.at(row, column);
        const dvec3 expected = irradianceBelow(sky);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(irradiance[c] / expected[c], 1, 2e-3) << elevation;
            EXPECT_NEAR(map.at(map.image.height / 2, 7)[c] * kPi / (sky.ground[c] * expected[c]), 1, 2e-3) << elevation;
        }
    }
}

// What the sky lacks is the sun: its irradiance from where it stands, and nothing beyond its edge.
TEST(SunSkyMap, TheSunIsADiskOfItsIrradiance) {
    for (const double elevation : {0.4, 12.34, 60.0, 89.9, 90.0}) {
        const SunSkyBackground sky = skyOf(2.5, elevation);
        const SkyMap map(sky);
        const Daylight daylight(sky);
        const double height = glm::radians(elevation), texel = kPi / map.image.height;
        const dvec3 sun(std::cos(height), std::sin(height), 0);
        dvec3 sum(0), middle(0);
        double widest = 0;
        for (std::uint32_t row = 0; row < map.image.height / 2; ++row)
            for (std::uint32_t column = 0; column < map.image.width; ++column) {
                const dvec3 d = map.direction(row, column);
                const double toSun = std::acos(std::clamp(glm::dot(d, sun), -1.0, 1.0));
                const dvec3 rest = map.at(row, column) - daylight.sky(d.y, toSun);
                if (glm::length(rest) < 1e-4) continue;
                sum += map.solidAngle(row) * rest;
                middle += map.solidAngle(row) * rest.g * d;
                widest = std::max(widest, toSun);
            }
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], daylight.sun()[c], 1e-4 * daylight.sun().r) << elevation;
        EXPECT_LT(glm::length(glm::normalize(middle) - sun), 0.1 * kSunRadius) << elevation;
        EXPECT_GT(widest, 0.5 * kSunRadius) << elevation;
        EXPECT_LT(widest, kSunRadius + texel) << elevation;
    }
}

TEST(SunSkyMap, OfASettingSunTheHalfAboveTheHorizonIsThere) {
    const SunSkyBackground sky = skyOf(2, 0);
    const SkyMap map(sky);
    const std::uint32_t horizon = map.image.height / 2, middle = map.image.width / 2;
    EXPECT_GT(map.at(horizon - 1, middle).r, 2 * map.at(horizon - 1, middle + 20).r);
    EXPECT_EQ(map.at(horizon, middle), map.at(horizon, 0));
}

} // namespace
} // namespace rt::scene
