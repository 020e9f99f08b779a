// The film on the device: exact on its way there and back, it does not stagnate, and what a plan asks for is listed.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/Interruption.h"
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
    const gpu::FilmPipeline reducer(context, cache, gpu::Shader::FilmReduce, sizeof(shared::ReduceLaunch));
    Film film({8, 8, 1, false});
    gpu::DeviceFilm onDevice(context, film.desc(), 1, false);
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
            reducer.run(commands, onDevice.reductionOf(launch), launch.slotCount);
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
    gpu::DeviceFilm onDevice(device(), desc, 1, false);
    onDevice.load(film, {0}, 0);
    Film back(desc);
    onDevice.store(back);
    EXPECT_TRUE(std::equal(sums.begin(), sums.end(), back.state(0, 0).sums.begin()));
    EXPECT_TRUE(std::equal(sums.begin(), sums.end(), back.state(0, 0).squares.begin()));
}

// Both its memory and its loading, which can come again.
TEST(DeviceFilmTest, ReservingCanBeCalledOff) {
    const image::FilmDesc desc{8, 8, 1, false};
    const std::vector<double> sums(Film::kTilePixels * 3, 7.0);
    Film film(desc);
    film.assign(0, 0, {16, sums, {}, {}});
    std::atomic<bool> isCalledOff{true};
    const Interruptible interruptible(isCalledOff);
    EXPECT_THROW(gpu::DeviceFilm(device(), desc, 1, false), Interrupted);
    isCalledOff = false;
    gpu::DeviceFilm onDevice(device(), desc, 1, false);
    isCalledOff = true;
    EXPECT_THROW(onDevice.load(film, {0}, 0), Interrupted);
    isCalledOff = false;
    onDevice.load(film, {0}, 0);
    Film back(desc);
    onDevice.store(back);
    EXPECT_TRUE(std::equal(sums.begin(), sums.end(), back.state(0, 0).sums.begin()));
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

// A film of 75 x 61 pixels, to which a plan gives no samples or a few at random, in groups of 2 x 2 alike if these
// share their paths.
Film plannedFilm(bool sharesPaths) {
    Film film({75, 61, 2, false, true});
    std::vector<std::uint32_t> plan(std::size_t{film.tileCount()} * 2 * Film::kTilePixels);
    std::mt19937 random(7);
    const std::uint32_t side = sharesPaths ? 2 : 1;
    for (std::size_t slot = 0; slot < plan.size() / Film::kTilePixels; ++slot)
        for (std::uint32_t y = 0; y < Film::kTile; ++y)
            for (std::uint32_t x = 0; x < Film::kTile; ++x) {
                const std::size_t tile = slot / 2;
                const bool isInside = tile % film.tilesX() * Film::kTile + x < film.desc().width &&
                                      tile / film.tilesX() * Film::kTile + y < film.desc().height;
                const bool isFirst = x % side == 0 && y % side == 0;
                const std::size_t pixel = slot * Film::kTilePixels + y * Film::kTile + x;
                const std::size_t first = pixel - y % side * Film::kTile - x % side;
                plan[pixel] = isFirst ? (random() % 3 == 0 ? 0 : random() % 40) : plan[first];
                if (!isInside) plan[pixel] = 0;
            }
    film.setPlan(std::move(plan));
    return film;
}

class SampleListTest : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(SharedOrNot, SampleListTest, ::testing::Bool());

// Launches that take some slots some samples further each list every sample that the plan asks for once, and number
// them without a gap; the reduction finds each of them.
TEST_P(SampleListTest, HasEverySampleOfAPlanOnce) {
    vulkan::VulkanContext& context = device();
    const vulkan::PipelineCache cache(context, "");
    const gpu::FilmPipeline lister(context, cache, gpu::Shader::SampleList, sizeof(shared::ListLaunch));
    const gpu::FilmPipeline reducer(context, cache, gpu::Shader::FilmReduce, sizeof(shared::ReduceLaunch));
    Film film = plannedFilm(GetParam());
    gpu::DeviceFilm onDevice(context, film.desc(), film.tileCount(), GetParam());
    onDevice.load(film, image::allTiles(film), 0);
    onDevice.reserveOpenBlocks();
    const std::size_t pixels = std::size_t{onDevice.slotCount()} * shared::kTilePixels;
    const auto bufferOf = [&](std::size_t words) {
        return vulkan::Buffer(context.memory(), words * sizeof(std::uint32_t), 0, vulkan::Memory::Device, "a test");
    };
    const vulkan::Buffer startsOnDevice = bufferOf(pixels);
    const vulkan::Buffer counters = bufferOf(std::size_t{shared::kCounters} * shared::kCounterLines);
    std::vector<std::uint32_t> found(pixels);              // samples of each
    std::vector<std::uint32_t> done(onDevice.slotCount()); // likewise, as far as the launches before lead
    const std::uint32_t all = onDevice.bandSlots();
    for (const auto& [first, width, steps] :
         {std::array{0u, all, 7u}, std::array{0u, 1u, 20u}, std::array{1u, all - 1, 13u}, std::array{0u, all, 40u}}) {
        shared::ListLaunch launch{};
        onDevice.describe(launch.film, first, width);
        launch.film.starts = startsOnDevice.address();
        launch.film.steps = steps;
        launch.film.spp = 80;
        const std::uint32_t numbers = launch.film.sampleCount = onDevice.numbersOf(launch.film);
        const vulkan::Buffer planned = bufferOf(2 * std::size_t{numbers});
        launch.planned = planned.address();
        launch.progress = counters.address();
        context.run([&](VkCommandBuffer commands) {
            vkCmdFillBuffer(commands, counters.get(), 0, counters.bytes(), 0);
            vulkan::barrier(commands, vulkan::kTransferWrite, vulkan::kComputeRead | vulkan::kComputeWrite);
            lister.run(commands, launch, launch.film.slotCount);
            vulkan::barrier(commands, vulkan::kComputeWrite, context.bufferUses());
        });
        std::vector<shared::PlannedSample> list(numbers);
        std::vector<std::uint32_t> starts(pixels);
        vulkan::download(context, planned, std::as_writable_bytes(std::span(list)));
        vulkan::download(context, startsOnDevice, std::as_writable_bytes(std::span(starts)));
        std::vector<shared::vec3> radiance(numbers, shared::vec3(0)); // of a sample its index + 1
        std::uint64_t samples = 0;
        for (const shared::PlannedSample& sample : list) {
            const std::uint32_t step = sample.place / shared::kTilePixels;
            const std::uint32_t slot = shared::launchSlot(launch.film, step / steps);
            ASSERT_LT(slot, onDevice.slotCount());
            const std::uint32_t inSlot = sample.place % shared::kTilePixels;
            const std::size_t pixel = std::size_t{slot} * shared::kTilePixels + inSlot;
            const std::uint32_t index = done[slot] + step % steps;
            EXPECT_EQ(sample.number, shared::plannedAt(launch.film, starts[pixel], index));
            ASSERT_LT(sample.number, numbers);
            EXPECT_EQ(radiance[sample.number].x, 0.0f);
            radiance[sample.number] = shared::vec3(static_cast<float>(index + 1));
            if (index >= film.plan(slot / 2, slot % 2)[inSlot]) continue; // outside of the image
            EXPECT_EQ(index, found[pixel]++);
            ++samples;
        }
        EXPECT_EQ(samples, onDevice.samplesOf(launch.film));
        EXPECT_LE(numbers, GetParam() ? samples * 5 / 4 : samples);
        const vulkan::Buffer brought = bufferOf(3 * std::size_t{numbers});
        vulkan::upload(context, brought, std::as_bytes(std::span(radiance)));
        launch.film.radiance = brought.address();
        context.run([&](VkCommandBuffer commands) {
            reducer.run(commands, onDevice.reductionOf(launch.film), launch.film.slotCount);
            vulkan::barrier(commands, vulkan::kComputeWrite, context.bufferUses());
        });
        for (std::uint32_t i = 0; i < launch.film.slotCount; ++i) {
            const std::uint32_t slot = shared::launchSlot(launch.film, i);
            if (slot < done.size()) done[slot] = shared::samplesAfter(launch.film, slot % 2, done[slot]);
        }
        onDevice.advance(launch.film);
    }
    onDevice.store(film);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const auto slot = static_cast<std::uint32_t>(pixel / Film::kTilePixels);
        const Film::TileState state = film.state(slot / 2, slot % 2);
        const std::size_t inSlot = pixel % Film::kTilePixels;
        const std::uint32_t samples = state.plan[inSlot];
        EXPECT_EQ(found[pixel], samples);
        const double open = state.open.empty() ? 0 : static_cast<double>(state.open[3 * inSlot]);
        EXPECT_EQ(state.sums[3 * inSlot] + open, samples * (samples + 1) / 2.0) << pixel;
    }
}

} // namespace
} // namespace rt::test
