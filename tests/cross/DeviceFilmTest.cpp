// The film on the device: exact on its way there and back, it does not stagnate, and launches leave out what is done.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/DeviceFilm.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

using image::Film;

// Feeds `blocks` blocks of samples of one tile to the reduction and returns the largest relative error of the film's
// sums.
double reductionError(std::uint32_t blocks, const std::function<float()>& next) {
    constexpr std::uint32_t kSteps = 256 * shared::kBlock;
    vulkan::VulkanContext& context = device();
    const vulkan::PipelineCache cache(context, "");
    const gpu::FilmPipeline reducer(context, cache, gpu::Shader::FilmReduce, sizeof(shared::FilmLaunch));
    Film film({8, 8, 1, false});
    gpu::DeviceFilm onDevice(context, film.desc(), 1);
    onDevice.load(film, {0}, 0);
    std::vector<shared::vec3> radiance(std::size_t{kSteps} * shared::kTilePixels);
    const vulkan::Buffer buffer(context.memory(), radiance.size() * sizeof radiance[0], 0, vulkan::Memory::Device,
                                "radiance");
    std::vector<glm::dvec3> exact(shared::kTilePixels, glm::dvec3(0));
    std::vector<shared::vec3> block(shared::kTilePixels, shared::vec3(0));
    for (std::uint32_t done = 0; done < blocks * shared::kBlock; done += kSteps) {
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            const std::size_t pixel = i % shared::kTilePixels;
            for (int c = 0; c < 3; ++c) radiance[i][c] = next();
            block[pixel] += radiance[i];
            if ((i / shared::kTilePixels + 1) % shared::kBlock != 0) continue;
            exact[pixel] += glm::dvec3(block[pixel]);
            block[pixel] = shared::vec3(0);
        }
        vulkan::upload(context, buffer, std::as_bytes(std::span(radiance)));
        shared::FilmLaunch launch{};
        onDevice.describe(launch, 0, 1);
        launch.radiance = buffer.address();
        launch.steps = kSteps;
        launch.spp = done + kSteps;
        context.run([&](VkCommandBuffer commands) {
            reducer.run(commands, launch, launch.slotCount);
            vulkan::barrier(commands, vulkan::kComputeWrite, context.bufferUses());
        });
        onDevice.advance(launch);
    }
    onDevice.store(film);
    EXPECT_EQ(film.minSamples(), std::uint64_t{blocks} * shared::kBlock);
    double worst = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double sum = film.state(0, 0).sums[3 * i + static_cast<std::size_t>(c)];
            worst = std::max(worst, std::abs(sum / exact[i][c] - 1));
        }
    }
    return worst;
}

// Sums of more bits than a float has come back from the device as they went.
TEST(DeviceFilmTest, RoundTripIsExact) {
    const image::FilmDesc desc{8, 8, 1, true};
    Film film(desc);
    std::vector<double> sums(Film::kTilePixels * 3);
    std::mt19937 random(3);
    for (double& sum : sums) {
        const float high = std::uniform_real_distribution<float>(1, 1000)(random);
        sum = static_cast<double>(high) * (1 + std::ldexp(1.0, -24) * 0.25);
        sum = static_cast<double>(static_cast<float>(sum)) + static_cast<double>(high) * std::ldexp(1.0, -26);
    }
    film.assign(0, 0, {32, sums, sums, {}});
    gpu::DeviceFilm onDevice(device(), desc, 1);
    onDevice.load(film, {0}, 0);
    Film back(desc);
    onDevice.store(back);
    EXPECT_TRUE(std::equal(sums.begin(), sums.end(), back.state(0, 0).sums.begin()));
    EXPECT_TRUE(std::equal(sums.begin(), sums.end(), back.state(0, 0).squares.begin()));
}

constexpr std::uint32_t kManyBlocks = 1u << 15; // 524 288 samples

TEST(DeviceFilmTest, ConstantSumsDoNotStagnate) {
    EXPECT_LE(reductionError(kManyBlocks, [] { return 1.6f; }), 1e-9);
}

TEST(DeviceFilmTest, RareLargeSumsKeepTheSmallOnes) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform;
    const auto next = [&] { return uniform(random) < 1e-4f ? 2e4f * uniform(random) : 0.02f * uniform(random); };
    EXPECT_LE(reductionError(kManyBlocks, next), 1e-9);
}

// Of 16 tiles one lacks 100 samples of each pixel, one 50 in one replicate, and the others none.
TEST(DeviceFilmTest, LaunchesLeaveOutTilesThatAreDone) {
    Film film({32, 32, 2, false, true});
    std::vector<std::uint32_t> plan(std::size_t{16} * 2 * Film::kTilePixels);
    const auto give = [&plan](std::size_t slot, std::uint32_t samples) {
        std::fill_n(&plan[slot * Film::kTilePixels], Film::kTilePixels, samples);
    };
    give(3 * 2, 100);
    give(3 * 2 + 1, 100);
    give(5 * 2 + 1, 50);
    film.setPlan(std::move(plan));
    gpu::DeviceFilm onDevice(device(), film.desc(), 16);
    onDevice.load(film, {3, 5, 0, 1, 2, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, 0);
    const auto launch = [&onDevice] {
        shared::FilmLaunch all{};
        onDevice.describe(all, 0, onDevice.bandSlots());
        all.steps = all.spp = 1000;
        return all;
    };
    EXPECT_EQ(launch().activeSlots, 32u);
    EXPECT_EQ(onDevice.samplesOf(launch()), 250u * Film::kTilePixels);
    onDevice.leaveOutDone();
    EXPECT_EQ(launch().activeSlots, 4u);
    EXPECT_EQ(onDevice.samplesOf(launch()), 250u * Film::kTilePixels);
    EXPECT_EQ(onDevice.stepsOfHalf(), 50u);
    EXPECT_EQ(onDevice.bands() * onDevice.bandSlots(), 4u);
}

} // namespace
} // namespace rt::test
