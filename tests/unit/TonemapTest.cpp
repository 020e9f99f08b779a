// Display transform against its definitions in double.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "Common/Image/Display.h"
#include "Common/Shared/Tonemap.h"

namespace rt::shared {
namespace {

double exactEncode(double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

TEST(Tonemap, SrgbIsThatOfTheStandard) {
    for (int i = 0; i <= 100000; ++i) {
        const float x = float(i) / 100000;
        ASSERT_NEAR(srgbEncode(x), exactEncode(x), 5e-7) << x;
        ASSERT_NEAR(srgbDecode(srgbEncode(x)), x, 1e-6) << x;
    }
    EXPECT_EQ(srgbEncode(0.0f), 0.0f);
    EXPECT_NEAR(srgbEncode(1.0f), 1.0f, 1e-6f);
    EXPECT_NEAR(srgbEncode(0.18f), 0.461356, 1e-5); // middle grey; a square root would give 0.4243
    EXPECT_NEAR(srgbDecode(0.04045f), 0.04045 / 12.92, 1e-8);
}

TEST(Tonemap, SrgbGrowsAndKeepsEveryByte) {
    float before = -1;
    for (int i = 0; i < 256; ++i) {
        const float linear = srgbDecode(float(i) / 255);
        EXPECT_GT(linear, before);
        EXPECT_EQ(int(srgbEncode(linear) * 255 + 0.5f), i);
        before = linear;
    }
}

TEST(Tonemap, ExposureIsInStops) {
    const vec3 color(0.1f, 0.2f, 0.05f);
    for (const uint curve : {kTonemapNone, kTonemapReinhard, kTonemapAces, kTonemapAgx, kTonemapNeutral}) {
        const vec3 shown = tonemap(color, 2.0f, curve), scaled = tonemap(color * 4.0f, 0.0f, curve);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], scaled[c], 1e-6f);
    }
    EXPECT_NEAR(tonemap(color, 1.0f, kTonemapNone).x, 0.2f, 1e-7f);
    EXPECT_EQ(tonemap(vec3(3, -1, 0.5f), 0.0f, kTonemapNone), vec3(1, 0, 0.5f));
}

TEST(Tonemap, ReinhardActsOnLuminance) {
    EXPECT_NEAR(tonemap(vec3(1.0f), 0.0f, kTonemapReinhard).x, 0.5f, 1e-6f);
    const vec3 color(0.9f, 0.3f, 0.1f);
    const float luminance = 0.2126f * 0.9f + 0.7152f * 0.3f + 0.0722f * 0.1f;
    const vec3 shown = tonemap(color, 0.0f, kTonemapReinhard);
    EXPECT_NEAR(displayLuminance(shown), luminance / (1 + luminance), 1e-6f);
    EXPECT_NEAR(shown.x / shown.y, 3.0f, 1e-5f); // the hue stays
}

TEST(Tonemap, AcesIsNarkowiczsCurve) {
    for (const double x : {0.0, 0.01, 0.18, 0.5, 1.0, 3.0}) {
        const double y = 0.6 * x;
        const double curve = y * (2.51 * y + 0.03) / (y * (2.43 * y + 0.59) + 0.14);
        EXPECT_NEAR(tonemap(vec3(float(x)), 0.0f, kTonemapAces).y, std::min(curve, 1.0), 1e-6);
    }
}

// Middle grey becomes half of what the display's power makes of it, and the ends of the 16.5 stops black and white.
TEST(Tonemap, AgxHoldsItsStopsAndFadesLightsToWhite) {
    const auto grey = [](double stops) {
        return double(tonemap(vec3(float(0.18 * std::exp2(stops))), 0.0f, kTonemapAgx).y);
    };
    EXPECT_NEAR(grey(0), std::pow(0.5, 2.2), 1e-4);
    EXPECT_NEAR(grey(-10), 0, 1e-6);
    EXPECT_NEAR(grey(6.5), 1, 1e-4);
    // The encoding's slope at middle grey is 2 for all of its range, also on both sides of the pivot.
    for (const double side : {-0.1, 0.1}) EXPECT_NEAR((std::pow(grey(side), 1 / 2.2) - 0.5) / side, 2 / 16.5, 1e-3);
    // A blue light of five stops above white is paler than one below it, and not clipped to pure blue.
    const vec3 bright = tonemap(vec3(0.5f, 0.5f, 4.0f), 5.0f, kTonemapAgx);
    const vec3 dim = tonemap(vec3(0.5f, 0.5f, 4.0f), -2.0f, kTonemapAgx);
    EXPECT_GT(bright.x / bright.z, dim.x / dim.z);
    EXPECT_GT(bright.x, 0.5f);
}

// By its specification, in double: colours of materials in white light come out as they are (4 % is what a dielectric
// of index 1.5 reflects), and what is far beyond white is white.
TEST(Tonemap, NeutralKeepsColoursBelowWhite) {
    const auto shown = [](const vec3& color) { return tonemap(color, 0.0f, kTonemapNeutral); };
    const vec3 blue = shown(vec3(0.14f, 0.34f, 0.74f));
    EXPECT_NEAR(blue.x, 0.10, 1e-6);
    EXPECT_NEAR(blue.y, 0.30, 1e-6);
    EXPECT_NEAR(blue.z, 0.70, 1e-6);
    EXPECT_NEAR(shown(vec3(0.02f)).x, 6.25 * 0.02 * 0.02, 1e-7);
    // Continuous where both pieces meet, in value.
    EXPECT_NEAR(shown(vec3(0.7999f)).x, shown(vec3(0.8001f)).x, 3e-4);
    EXPECT_NEAR(shown(vec3(0.0799f)).x, shown(vec3(0.0801f)).x, 3e-4);
    for (const double grey : {1.0, 2.0, 16.0}) {
        const double peak = grey - 0.04;
        EXPECT_NEAR(shown(vec3(float(grey))).x, 1 - 0.24 * 0.24 / (peak + 0.24 - 0.76), 1e-6) << grey;
    }
    // A bright blue light keeps its blue ahead of the others and pales.
    const vec3 lamp = shown(vec3(1, 1, 8)), glare = shown(vec3(100, 100, 800));
    EXPECT_GT(lamp.z, lamp.x);
    EXPECT_GT(glare.x, 0.95f);
    EXPECT_GT(glare.x / glare.z, lamp.x / lamp.z);
}

TEST(Tonemap, AnyRadianceStaysInRange) {
    for (const uint curve : {kTonemapNone, kTonemapReinhard, kTonemapAces, kTonemapAgx, kTonemapNeutral}) {
        float before = 0;
        for (const float x : {0.0f, 1e-38f, 1e-6f, 0.1f, 1.0f, 100.0f, 1e10f, 1e30f, 3e38f}) {
            for (const float stops : {-20.0f, 0.0f, 20.0f}) {
                const float shown = tonemap(vec3(x), stops, curve).z;
                EXPECT_TRUE(shown >= 0 && shown <= 1) << x;
            }
            const float shown = tonemap(vec3(x), 0.0f, curve).x;
            EXPECT_GE(shown, before) << x;
            before = shown;
        }
        EXPECT_GT(before, 0.999f);
        EXPECT_EQ(tonemap(vec3(-5.0f), 0.0f, curve), vec3(0.0f));
    }
}

TEST(Tonemap, DisplaysWholeImages) {
    image::Image radiance(2, 1);
    radiance.data = {0.25f, 0.5f, 4.0f, 0, 0.125f, 1};
    EXPECT_EQ(toImage(image::toDisplay(radiance, 1, kTonemapNone)).data, (std::vector<float>{0.5f, 1, 1, 0, 0.25f, 1}));
    image::Image grey(2, 1, 1);
    grey.data = {0.25f, 3.0f};
    EXPECT_EQ(toImage(image::toDisplay(grey, 0, kTonemapNone)).data,
              (std::vector<float>{0.25f, 0.25f, 0.25f, 1, 1, 1}));
}

TEST(Tonemap, AutoExposureMakesTheMeanMiddleGrey) {
    image::Image picture(20, 20);
    std::fill(picture.data.begin(), picture.data.end(), 0.045f);
    EXPECT_NEAR(image::autoExposure(picture), 2, 1e-5);
    // A lamp, a black border and a sample that is no number change nothing.
    for (std::size_t i = 0; i < 3 * 20; ++i) picture.data[i] = i < 3 * 10 ? 1e6f : 0;
    picture.data[3 * 30] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NEAR(image::autoExposure(picture), 2, 1e-5);
    std::fill(picture.data.begin(), picture.data.end(), 0.0f);
    EXPECT_EQ(image::autoExposure(picture), 0);
    EXPECT_EQ(image::autoExposure(image::Image(0, 0)), 0);
}

} // namespace
} // namespace rt::shared
