// The denoiser on the device against that of the CPU, which the unit tests prove.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Denoise/LiveDenoiser.h"
#include "Common/Image/Metrics.h"
#include "Common/Shared/Denoise/DenoiseMix.h"
#include "Common/Vulkan/PipelineCache.h"
#include "RayTracingGPU/DeviceDenoiser.h"
#include "RayTracingGPU/EmbeddedShaders.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

using image::Denoised;
using image::DenoiseInput;
using image::Image;

struct CompiledDenoiser {
    vulkan::PipelineCache cache{device(), ""};
    gpu::DenoisePipelines pipelines{device(), cache};
};
std::optional<CompiledDenoiser> compiledDenoiser;

class DeviceDenoiserTest : public ::testing::Test {
  protected:
    static void TearDownTestSuite() { compiledDenoiser.reset(); } // the device ends with all tests
};

gpu::DenoisePipelines& pipelines() {
    if (!compiledDenoiser) compiledDenoiser.emplace();
    return compiledDenoiser->pipelines;
}

// A wall with squares of another albedo, a lamp before it, and a ball whose normals and depth vary: tiles without
// features of the surface, and with as many as there can be.
struct Surface {
    float albedo, normal[3], depth, radiance;
};
Surface surfaceAt(std::uint32_t x, std::uint32_t y) {
    const float dx = (static_cast<float>(x) - 60) / 20, dy = (static_cast<float>(y) - 25) / 20;
    const float height = 1 - dx * dx - dy * dy;
    if (height > 0) return {0.6f, {dx, dy, std::sqrt(height)}, 3 - height, 0.2f + std::max(dx, 0.0f)};
    if (x > 8 && x < 17 && y > 10 && y < 15) return {0, {0, 0, 1}, 2, 15};
    const float albedo = x > 30 && (x / 4 + y / 4) % 2 == 0 ? 0.1f : 0.8f;
    return {albedo, {0, 0, 1}, 4, albedo * (1 + 0.01f * static_cast<float>(y))};
}

// Its halves with exponential noise, as rare and bright as noise of few paths is, but for the lamp; less of it for more
// samples.
DenoiseInput noisyInput(std::uint32_t width, std::uint32_t height, std::uint64_t samples = 1) {
    DenoiseInput input;
    input.samplesOfHalf = samples;
    input.halfA = input.halfB = input.albedo = input.normal = Image(width, height);
    input.depth = Image(width, height, 1);
    std::mt19937 random(7);
    std::exponential_distribution<float> noise(1.0f);
    const float share = 1 / std::sqrt(static_cast<float>(samples));
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const Surface surface = surfaceAt(x, y);
            input.depth.pixel(x, y)[0] = surface.depth;
            for (std::uint32_t c = 0; c < 3; ++c) {
                input.albedo.pixel(x, y)[c] = surface.albedo * (c == 0 ? 1.0f : 0.7f);
                input.normal.pixel(x, y)[c] = surface.normal[c];
                for (Image* half : {&input.halfA, &input.halfB})
                    half->pixel(x, y)[c] =
                        surface.radiance * (surface.radiance > 10 ? 1 : 1 + share * (noise(random) - 1));
            }
        }
    return input;
}

gpu::DeviceDenoiser makeDenoiser(const DenoiseInput& input) {
    gpu::DeviceDenoiser denoiser(device(), pipelines(), input.halfA.width, input.halfA.height);
    denoiser.setSurfaces(input.albedo, input.normal, input.depth);
    denoiser.setHalves(input.halfA, input.halfB);
    return denoiser;
}

Denoised denoiseOnDevice(const DenoiseInput& input, std::uint32_t dependentSide) {
    gpu::DeviceDenoiser denoiser = makeDenoiser(input);
    EXPECT_TRUE(denoiser.run(input.samplesOfHalf, dependentSide));
    return denoiser.read(true);
}

double relMse(const Image& got, const Image& expected) {
    EXPECT_EQ(got.data.size(), expected.data.size());
    double sum = 0;
    for (std::size_t i = 0; i < got.data.size(); ++i) {
        const double difference = static_cast<double>(got.data[i]) - static_cast<double>(expected.data[i]);
        const double value = expected.data[i];
        sum += difference * difference / (value * value + image::kRelativeFloor);
    }
    return sum / static_cast<double>(got.data.size());
}

// The bound is that of what both may differ by; pictures of one filter with other parameters differ by hundreds of it.
void expectTheSame(const DenoiseInput& input, std::uint32_t dependentSide) {
    const Denoised got = denoiseOnDevice(input, dependentSide), expected = image::denoise(input, dependentSide);
    EXPECT_LE(relMse(got.picture, expected.picture), 1e-4);
    EXPECT_LE(relMse(got.halfA, expected.halfA), 1e-4);
    EXPECT_LE(relMse(got.halfB, expected.halfB), 1e-4);
    EXPECT_LE(relMse(got.error, expected.error), 1e-3);
    EXPECT_LE(relMse(got.bandwidth, expected.bandwidth), 0.05); // a pixel whose choice is a matter of rounding: 0.016
    EXPECT_NEAR(got.relmse.value, expected.relmse.value, 0.02 * expected.relmse.value + 1e-7);
    EXPECT_NEAR(got.relmse.standardError, expected.relmse.standardError, 0.02 * expected.relmse.standardError + 1e-7);
    // One such pixel is a part of the choice of 25, or of five in a row.
    const double share = 0.01 + 1 / static_cast<double>(got.bandwidth.data.size());
    for (std::size_t i = 0; i < got.shares.size(); ++i) EXPECT_NEAR(got.shares[i], expected.shares[i], share);
}

TEST_F(DeviceDenoiserTest, MakesThePictureOfTheCpu) {
    expectTheSame(noisyInput(97, 61), 1);
}

TEST_F(DeviceDenoiserTest, KnowsOfPixelsWhoseNoiseIsAlike) {
    expectTheSame(noisyInput(97, 61), 2);
}

// Of many samples a pixel may also stay as it is, and some do where next to no noise is left.
TEST_F(DeviceDenoiserTest, LeavesPixelsAsTheyAre) {
    const DenoiseInput input = noisyInput(97, 61, 10'000'000);
    expectTheSame(input, 2);
    EXPECT_GT(denoiseOnDevice(input, 2).shares.back(), 0.01);
}

// On either side of the numbers of samples from which on something is given back, and pictures are mixed.
TEST_F(DeviceDenoiserTest, MixesAsTheCpuDoes) {
    expectTheSame(noisyInput(97, 61, shared::kDenoiseCoarseSamples), 1);
    expectTheSame(noisyInput(97, 61, shared::kDenoiseMixSamples - 1), 1);
    expectTheSame(noisyInput(97, 61, shared::kDenoiseMixSamples), 1);
}

TEST_F(DeviceDenoiserTest, NeedsNoFeatures) {
    DenoiseInput input = noisyInput(97, 61);
    input.depth = {};
    expectTheSame(input, 1);
    input.albedo = {};
    input.normal = {};
    expectTheSame(input, 1);
}

TEST_F(DeviceDenoiserTest, TakesPicturesOfAnySize) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, std::pair{1u, 50u}, std::pair{50u, 1u}, std::pair{33u, 2u},
                                        std::pair{37u, 67u}, std::pair{64u, 32u}}) {
        SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
        expectTheSame(noisyInput(width, height), 2);
    }
}

TEST_F(DeviceDenoiserTest, TakesWhateverAPictureMayHold) {
    DenoiseInput input = noisyInput(97, 61);
    input.halfA.pixel(5, 6)[0] = std::numeric_limits<float>::infinity();
    input.halfB.pixel(7, 6)[1] = std::numeric_limits<float>::quiet_NaN();
    input.halfA.pixel(9, 9)[2] = std::numeric_limits<float>::max();
    for (std::uint32_t y = 0; y < 61; ++y) input.albedo.pixel(3, y)[0] = std::numeric_limits<float>::quiet_NaN();
    std::fill(input.depth.data.begin(), input.depth.data.end(), 0.0f); // nothing is hit
    const Denoised got = denoiseOnDevice(input, 2);
    for (const Image* image : {&got.picture, &got.halfA, &got.halfB, &got.error, &got.bandwidth})
        for (const float value : image->data) ASSERT_TRUE(std::isfinite(value) && value >= 0);
    EXPECT_LE(relMse(got.picture, image::denoise(input, 2).picture), 1e-4);
    DenoiseInput black;
    black.halfA = black.halfB = Image(20, 20);
    EXPECT_EQ(denoiseOnDevice(black, 1).picture.data, black.halfA.data);
}

// What the unit of depths is found by, too, where features have never been on the host.
TEST_F(DeviceDenoiserTest, FindsTheUnitOfDepthsOnTheDevice) {
    DenoiseInput input = noisyInput(97, 61);
    std::mt19937 random(3);
    std::lognormal_distribution<float> depths(0, 4);
    for (const bool seesSomething : {true, false}) {
        for (float& depth : input.depth.data) depth = seesSomething ? depths(random) : 0;
        input.depth.pixel(1, 1)[0] = std::numeric_limits<float>::infinity();
        input.depth.pixel(2, 1)[0] = std::numeric_limits<float>::quiet_NaN();
        input.depth.pixel(3, 1)[0] = -1;
        gpu::DeviceDenoiser denoiser = makeDenoiser(input);
        ASSERT_TRUE(denoiser.run(1, 1));
        const Image expected = denoiser.read(false).picture;
        denoiser.surfacesChanged();
        ASSERT_TRUE(denoiser.run(1, 1));
        EXPECT_EQ(denoiser.read(false).picture.data, expected.data);
        EXPECT_GT(denoiser.passSeconds()[static_cast<std::size_t>(gpu::DenoisePass::Depths)], 0);
    }
}

// An array of an invocation that is indexed by a loop lies in memory unless a driver unrolls it, which made these ten
// times as slow. So they have none, whatever a driver does.
TEST(DenoiseShaderTest, NoInvocationHasAnArrayWhereTimeGoes) {
    constexpr std::uint32_t kArray = 28, kStruct = 30, kPointer = 32, kFunction = 7; // of SPIR-V
    for (const gpu::Shader shader : {gpu::Shader::DenoiseFit, gpu::Shader::DenoiseLive}) {
        const auto code = gpu::shaderCode(shader);
        std::set<std::uint32_t> arrays; // types that are or hold some
        for (std::size_t i = 5; i < code.size(); i += code[i] >> 16) {
            ASSERT_GT(code[i] >> 16, 0u);
            const std::uint32_t operation = code[i] & 0xffff;
            if (operation == kArray) arrays.insert(code[i + 1]);
            if (operation == kStruct)
                for (std::size_t member = 2; member < code[i] >> 16; ++member)
                    if (arrays.count(code[i + member]) > 0) arrays.insert(code[i + 1]);
            const bool isOfInvocation = operation == kPointer && code[i + 2] == kFunction;
            EXPECT_FALSE(isOfInvocation && arrays.count(code[i + 3]) > 0);
        }
    }
}

TEST_F(DeviceDenoiserTest, MakesTheLivePictureOfTheCpu) {
    for (const auto& [width, height] :
         {std::pair{97u, 61u}, std::pair{1u, 1u}, std::pair{1u, 50u}, std::pair{37u, 2u}}) {
        DenoiseInput input = noisyInput(width, height);
        input.halfA.data[0] = std::numeric_limits<float>::infinity();
        for (const bool hasFeatures : {true, false}) {
            if (!hasFeatures) input.albedo = input.normal = input.depth = {};
            gpu::DeviceDenoiser denoiser = makeDenoiser(input);
            denoiser.runLive();
            EXPECT_LE(relMse(denoiser.readLive(), image::LiveDenoiser().filter(input)), 1e-4);
        }
    }
}

// Frame after frame with the memory of the first, and to the same bits.
TEST_F(DeviceDenoiserTest, TakesNoMemoryForAFrame) {
    const DenoiseInput input = noisyInput(40, 30);
    gpu::DeviceDenoiser denoiser = makeDenoiser(input);
    const auto bytes = device().memory().deviceBytes();
    ASSERT_TRUE(denoiser.run(1, 2));
    const Image first = denoiser.read(false).picture;
    ASSERT_TRUE(denoiser.run(1, 2));
    EXPECT_EQ(denoiser.read(false).picture.data, first.data);
    EXPECT_EQ(device().memory().deviceBytes(), bytes);
    for (const gpu::DenoisePass pass : {gpu::DenoisePass::Prepare, gpu::DenoisePass::Fit, gpu::DenoisePass::Blend})
        EXPECT_GT(denoiser.passSeconds()[static_cast<std::size_t>(pass)], 0);
    const std::atomic<bool> cancel = true;
    EXPECT_FALSE(denoiser.run(1, 2, &cancel));
}

} // namespace
} // namespace rt::test
