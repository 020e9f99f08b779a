// Halves of pictures whose truth is known, for denoisers.
#pragma once
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "Common/Image/Denoise/Denoiser.h"

namespace rt::test {

// radiance(x, y, channel)
template <class Radiance>
image::Image picture(std::uint32_t width, std::uint32_t height, const Radiance& radiance) {
    image::Image result(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (std::uint32_t c = 0; c < 3; ++c) result.pixel(x, y)[c] = radiance(x, y, c);
    return result;
}

inline const auto kGrey = [](auto, auto, auto) { return 0.5f; };

// Two halves of the picture with exponential noise: as rare and bright as noise of few paths is.
template <class Radiance>
image::DenoiseInput noisyHalves(const Radiance& radiance, std::uint32_t seed, std::uint32_t side) {
    std::mt19937 random(seed);
    std::exponential_distribution<float> noise(1.0f);
    const auto noisy = [&](std::uint32_t x, std::uint32_t y, std::uint32_t c) {
        return radiance(x, y, c) * noise(random);
    };
    image::DenoiseInput input;
    input.halfA = picture(side, side, noisy);
    input.halfB = picture(side, side, noisy);
    return input;
}

inline image::DenoiseInput equalHalves(const image::Image& picture) {
    image::DenoiseInput input;
    input.halfA = input.halfB = picture;
    return input;
}

// A lamp without noise, right of `edge`, before a noisy wall.
inline image::DenoiseInput lampBeforeAWall(std::uint32_t side, std::uint32_t edge) {
    image::DenoiseInput input = noisyHalves([edge](auto x, auto, auto) { return x < edge ? 0.2f : 0.0f; }, 3, side);
    for (image::Image* half : {&input.halfA, &input.halfB})
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = edge; x < side; ++x)
                for (std::uint32_t c = 0; c < 3; ++c) half->pixel(x, y)[c] = 15.0f;
    return input;
}
inline void expectTheEdgeOfTheLamp(const image::Image& result, std::uint32_t edge) {
    for (std::uint32_t y = 0; y < result.height; ++y) {
        EXPECT_LT(result.pixel(edge - 1, y)[0], 1.5f);
        EXPECT_NEAR(result.pixel(edge, y)[0], 15.0f, 0.15f);
    }
}

// Infinite, not a number, as large as there is; nothing is hit.
inline image::DenoiseInput whateverThereMayBe(std::uint32_t side) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    image::DenoiseInput input = noisyHalves(kGrey, 4, side);
    input.halfA.pixel(5, 6)[0] = std::numeric_limits<float>::infinity();
    input.halfB.pixel(7, 6)[1] = kNan;
    input.halfA.pixel(9, 9)[2] = std::numeric_limits<float>::max();
    input.albedo = picture(side, side, [](auto x, auto, auto) { return x == 3 ? kNan : 0.5f; });
    input.depth = image::Image(side, side, 1);
    return input;
}

} // namespace rt::test
