#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/Flip.h"

namespace rt::image {
namespace {

Image constant(std::uint32_t side, float r, float g, float b) {
    Image image(side, side, 3);
    for (std::size_t i = 0; i < image.data.size(); i += 3) {
        image.data[i] = r;
        image.data[i + 1] = g;
        image.data[i + 2] = b;
    }
    return image;
}

Image noise(std::uint32_t side, std::uint32_t seed) {
    Image image(side, side, 3);
    std::mt19937 random(seed);
    for (float& value : image.data) value = static_cast<float>(random() >> 8) * 0x1p-24f;
    return image;
}

// L*a*b* of a linear sRGB colour by the textbook, with Hunt's factor, for values computed by hand below.
struct Lab {
    double l, a, b;
};
double labRoot(double t) {
    return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}
Lab hunt(double r, double g, double b) {
    const double x = (0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047;
    const double y = 0.2126729 * r + 0.7151522 * g + 0.0721750 * b;
    const double z = (0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883;
    const double lightness = 116 * labRoot(y) - 16;
    return {lightness, 0.01 * lightness * 500 * (labRoot(x) - labRoot(y)),
            0.01 * lightness * 200 * (labRoot(y) - labRoot(z))};
}
double hyab(const Lab& p, const Lab& q) {
    return std::abs(p.l - q.l) + std::hypot(p.a - q.a, p.b - q.b);
}
// Of two constant images: there are no features, and the filters change nothing.
double expectedForConstants(const Lab& p, const Lab& q) {
    const double largest = std::pow(hyab(hunt(0, 1, 0), hunt(0, 0, 1)), 0.7);
    const double difference = std::pow(hyab(p, q), 0.7);
    const double knee = 0.4 * largest;
    return difference < knee ? difference / knee * 0.95 : 0.95 + (difference - knee) / (largest - knee) * 0.05;
}

TEST(Flip, EqualImagesDoNotDiffer) {
    const Image image = noise(40, 1);
    EXPECT_EQ(flip(image, image), 0.0);
}

TEST(Flip, ConstantColoursAreAsComputedByHand) {
    const Image black = constant(24, 0, 0, 0), white = constant(24, 1, 1, 1), grey = constant(24, 0.2f, 0.2f, 0.2f);
    const Image green = constant(24, 0, 1, 0), blue = constant(24, 0, 0, 1);
    // White is (100, 0, 0) and black (0, 0, 0): 100^0.7 = 25.12 beyond the knee at 16.5 of 41.3.
    EXPECT_NEAR(flip(white, black), 0.9674, 1e-3);
    EXPECT_NEAR(flip(white, black), expectedForConstants({100, 0, 0}, {0, 0, 0}), 1e-4);
    EXPECT_NEAR(flip(grey, black), expectedForConstants(hunt(0.2, 0.2, 0.2), {0, 0, 0}), 1e-4);
    EXPECT_NEAR(flip(green, blue), 1.0, 1e-4); // the largest difference that there is
}

TEST(Flip, IsSymmetricAndClamps) {
    const Image a = noise(32, 2), b = noise(32, 3);
    EXPECT_NEAR(flip(a, b), flip(b, a), 1e-6);
    EXPECT_GT(flip(a, b), 0.05);
    Image bright = a;
    for (float& value : bright.data) value = value > 0.5f ? value + 10 : value;
    Image clamped = bright;
    for (float& value : clamped.data) value = std::min(value, 1.0f);
    EXPECT_EQ(flip(bright, b), flip(clamped, b)); // a screen shows no more
}

// What the eye blurs away counts little: fine noise less than the same noise in coarse blocks; and the finer the
// screen, the less is seen.
TEST(Flip, FineNoiseIsSeenLess) {
    const std::uint32_t side = 64;
    const Image grey = constant(side, 0.4f, 0.4f, 0.4f);
    Image fine = grey, coarse = grey;
    std::mt19937 random(5);
    std::vector<float> signs(side * side);
    for (float& sign : signs) sign = random() & 1 ? 0.1f : -0.1f;
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x)
            for (int c = 0; c < 3; ++c) {
                fine.pixel(x, y)[c] += signs[y * side + x];
                coarse.pixel(x, y)[c] += signs[y / 16 * 16 * side + x / 16 * 16];
            }
    EXPECT_LT(flip(fine, grey), 0.7 * flip(coarse, grey));
    EXPECT_LT(flip(fine, grey, 120), flip(fine, grey, 30));
}

// An edge that is missing raises the difference beside it above that of its colours alone.
TEST(Flip, FeaturesAmplifyDifferences) {
    const std::uint32_t side = 64;
    Image plain = constant(side, 0.5f, 0.5f, 0.5f), line = plain;
    for (std::uint32_t y = 0; y < side; ++y)
        for (int c = 0; c < 3; ++c) line.pixel(side / 2, y)[c] = 0.0f;
    const Image map = flipMap(line, plain);
    EXPECT_GT(map.pixel(side / 2, 32)[0], 0.3f);
    EXPECT_LT(map.pixel(4, 32)[0], 0.02f); // far away nothing differs
    for (const float value : map.data) {
        EXPECT_GE(value, 0.0f);
        EXPECT_LE(value, 1.0f);
    }
}

TEST(Flip, RefusesWhatCannotBeCompared) {
    EXPECT_THROW(flip(noise(8, 1), noise(9, 1)), InputError);
    Image bad = noise(8, 1);
    bad.data[5] = std::nanf("");
    EXPECT_THROW(flip(bad, noise(8, 1)), InputError);
}

} // namespace
} // namespace rt::image
