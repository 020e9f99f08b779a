// The film against exact sums (numerics N15), split invariance, replicates, variance, tiles at the edge, memory.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Core/Hash.h"
#include "Common/Core/Interruption.h"
#include "Common/Image/Film.h"

namespace rt::image {
namespace {

// The value of sample `index` of a replicate at a pixel of the tile and channel.
using Stream = std::function<float(std::uint32_t index, std::size_t value)>;

// What an engine does: continues the tile by `count` samples.
void addSamples(Film& film, std::uint32_t tile, std::uint32_t replicate, std::uint32_t count, const Stream& stream) {
    while (count > 0) {
        Film::TileBlock block;
        film.begin(tile, replicate, block);
        for (; block.count < Film::kBlock && count > 0; ++block.count, --count)
            for (std::size_t value = 0; value < std::size(block.sum); ++value)
                block.sum[value] += stream(block.firstSample + block.count, value);
        film.commit(tile, replicate, block);
    }
}

std::string stateOfFilm(const Film& film) {
    std::ostringstream out;
    film.writeState(out);
    return out.str();
}

float uniform(std::uint32_t index, std::size_t value) {
    std::uint32_t x = index * 0x9e3779b9u + static_cast<std::uint32_t>(value) * 0x85ebca6bu;
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return static_cast<float>((x ^ x >> 16) >> 8) * 0x1p-24f;
}

// The four streams of N15. A running mean in float is off by 1e-3 to 1e-2 on them.
float syntheticSample(std::size_t stream, std::mt19937& random) {
    const float u = static_cast<float>(random() >> 8) * 0x1p-24f;
    switch (stream) {
        case 0:
            return 0.1f;
        case 1:
            return u < 0.999f ? 0.995f : 6.0f;
        case 2:
            return u < 1e-4f ? 2e4f : 0.02f * u;
        default: {
            float product = 1;
            for (int i = 0; i < 4; ++i) product *= -std::log1p(-static_cast<float>(random() >> 8) * 0x1p-24f);
            return product;
        }
    }
}

TEST(Film, SumsTheStreamsOfN15) {
    for (const std::uint32_t count : {200000u, 2000000u}) {
        Film film({8, 8});
        std::mt19937 random(7);
        double exact[4] = {}; // of at most 2e6 floats: its error is below 1e-10
        for (std::uint32_t first = 0; first < count; first += Film::kBlock) {
            Film::TileBlock block;
            film.begin(0, 0, block);
            ASSERT_EQ(block.firstSample, first);
            ASSERT_EQ(block.count, 0u);
            for (; block.count < Film::kBlock; ++block.count) {
                for (std::size_t stream = 0; stream < 4; ++stream) {
                    const float value = syntheticSample(stream, random);
                    block.sum[stream * 3] += value;
                    exact[stream] += value;
                }
            }
            film.commit(0, 0, block);
        }
        const Image mean = film.resolve();
        for (std::uint32_t stream = 0; stream < 4; ++stream)
            EXPECT_NEAR(mean.pixel(stream, 0)[0] / (exact[stream] / count), 1.0, 4e-7) << "stream " << stream;
    }
}

TEST(Film, IsTheSameHoweverSamplesAreSplit) {
    const Stream stream = [](std::uint32_t i, std::size_t v) { return 1e3f * uniform(i, v) * uniform(i, v + 500); };
    Film whole({8, 8});
    whole.reserveOpenBlocks();
    addSamples(whole, 0, 0, 1003, stream);

    for (const std::uint32_t step : {1u, 7u, 16u, 17u, 250u}) {
        Film split({8, 8});
        split.reserveOpenBlocks();
        for (std::uint32_t done = 0; done < 1003; done += step)
            addSamples(split, 0, 0, std::min(step, 1003 - done), stream);
        EXPECT_EQ(split.samples(0, 0), 1003u);
        EXPECT_EQ(stateOfFilm(split), stateOfFilm(whole)) << "steps of " << step;
        EXPECT_EQ(split.resolve().data, whole.resolve().data);
    }
}

TEST(Film, DividesByTheTrueCountOfAllReplicates) {
    Film film({8, 8, 3});
    film.reserveOpenBlocks();
    // 50 samples over three replicates: 17, 17, 16, of value 1, 2, 3.
    for (std::uint32_t r = 0; r < 3; ++r)
        addSamples(film, 0, r, r < 2 ? 17 : 16, [r](std::uint32_t, std::size_t) { return float(r + 1); });
    EXPECT_EQ(film.samples(0), 50u);
    EXPECT_EQ(film.samples(0, 1), 17u);
    EXPECT_FLOAT_EQ(film.resolve().pixel(3, 3)[1], (17 * 1 + 17 * 2 + 16 * 3) / 50.0f);
}

TEST(Film, MapsTilesToPixelsAtTheEdges) {
    Film film({13, 9});
    ASSERT_EQ(film.tilesX(), 2u);
    ASSERT_EQ(film.tileCount(), 4u);
    for (std::uint32_t tile = 0; tile < 4; ++tile) {
        if (tile == 2) continue; // stays black
        addSamples(film, tile, 0, 16 * (tile + 1),
                   [tile](std::uint32_t, std::size_t value) { return float(tile * 1000 + value); });
    }
    const Image image = film.resolve();
    const Image counts = film.sampleCounts();
    for (std::uint32_t y = 0; y < 9; ++y) {
        for (std::uint32_t x = 0; x < 13; ++x) {
            const std::uint32_t tile = y / 8 * 2 + x / 8;
            const std::uint32_t value = (y % 8 * 8 + x % 8) * 3;
            EXPECT_EQ(image.pixel(x, y)[2], tile == 2 ? 0.0f : float(tile * 1000 + value + 2));
            EXPECT_EQ(counts.pixel(x, y)[0], tile == 2 ? 0.0f : 16.0f * float(tile + 1));
        }
    }
    EXPECT_EQ(film.minSamples(), 0u);
    EXPECT_EQ(film.totalSamples(), 16u * (64 * 1 + 40 * 2 + 5 * 4));
}

TEST(Film, VarianceWithinOneReplicateIsThatOfBlocks) {
    Film film({8, 8, 1, true});
    film.reserveOpenBlocks();
    const std::uint32_t count = 16 * 60 + 5;
    // N15: the float formula E[x^2] - E[x]^2 gives 14.9 here instead of 1/12.
    const Stream stream = [](std::uint32_t i, std::size_t v) { return 100 + uniform(i, v); };
    addSamples(film, 0, 0, count, stream);
    const Image variance = film.varianceOfMean();

    double mean = 0;
    for (const float v : variance.data) mean += v / double(variance.data.size());
    // 192 estimates of 60 degrees of freedom each
    EXPECT_NEAR(mean * count * 12, 1.0, 4 * std::sqrt(2.0 / 60 / 192));

    // The variance from its definition, for one value, with the open block as a group of 5.
    double sum = 0, squares = 0, block = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        block += stream(i, 30);
        if (i % 16 != 15 && i + 1 != count) continue;
        sum += block;
        squares += block * block / (i % 16 + 1);
        block = 0;
    }
    EXPECT_NEAR(variance.data[30] * 60.0 * count / (squares - sum * sum / count), 1.0, 1e-3);
}

TEST(Film, VarianceOfEqualBlocksIsNone) {
    Film film({8, 8, 1, true});
    addSamples(film, 0, 0, 160, [](std::uint32_t i, std::size_t) { return float(i % 16); }); // perfectly stratified
    EXPECT_LT(film.varianceOfMean().data[0], 1e-12f);
    EXPECT_EQ(film.resolve().data[0], 7.5f);
}

TEST(Film, VarianceAcrossReplicatesIsUnbiased) {
    constexpr std::uint32_t kReplicates = 4, kSamples = 64;
    Film film({8, 8, kReplicates});
    for (std::uint32_t r = 0; r < kReplicates; ++r)
        addSamples(film, 0, r, kSamples,
                   [r](std::uint32_t i, std::size_t v) { return uniform(i + 1000 * r, v) < 0.25f ? 4.0f : 0.0f; });
    const Image variance = film.varianceOfMean();
    double mean = 0;
    for (const float v : variance.data) mean += v / double(variance.data.size());
    // Values 4 with probability 1/4: variance 3. 192 estimates of 3 degrees of freedom.
    EXPECT_NEAR(mean * kReplicates * kSamples / 3, 1.0, 4 * std::sqrt(2.0 / 3 / 192));
}

TEST(Film, VarianceNeedsTwoGroups) {
    Film one({8, 8, 1, true});
    addSamples(one, 0, 0, 16, [](std::uint32_t i, std::size_t v) { return uniform(i, v); });
    EXPECT_EQ(one.varianceOfMean().data[0], 0.0f);
    Film two({8, 8, 2});
    addSamples(two, 0, 1, 16, [](std::uint32_t i, std::size_t v) { return uniform(i, v); });
    EXPECT_EQ(two.varianceOfMean().data[0], 0.0f);
    EXPECT_THROW(Film({8, 8}).varianceOfMean(), std::logic_error);
}

TEST(Film, RefusesBlocksThatDoNotContinue) {
    Film film({8, 8});
    Film::TileBlock block;
    block.count = 3;
    EXPECT_THROW(film.commit(0, 0, block), std::logic_error); // nothing reserved
    film.reserveOpenBlocks();
    film.commit(0, 0, block);
    block.count = 2;
    EXPECT_THROW(film.commit(0, 0, block), std::logic_error); // goes back
    block.count = 17;
    EXPECT_THROW(film.commit(0, 0, block), std::logic_error);
    block.count = 16;
    block.firstSample = 16;
    EXPECT_THROW(film.commit(0, 0, block), std::logic_error); // leaves samples out
    EXPECT_EQ(film.samples(0, 0), 3u);
}

TEST(Film, GoesOnAtTwoToThe31Samples) {
    // A film of 2^31 - 16 samples of 0.1, made as a checkpoint, then one block more of 1000 each.
    const std::uint32_t before = Film::kMaxSamples - Film::kBlock;
    std::string state(sizeof before + 192 * sizeof(double), '\0');
    std::memcpy(state.data(), &before, sizeof before);
    for (std::size_t i = 0; i < 192; ++i) {
        const double sum = 0.1 * before;
        std::memcpy(&state[sizeof before + i * sizeof sum], &sum, sizeof sum);
    }
    const std::uint64_t hash = hashBytes(std::as_bytes(std::span(state)));
    state.append(reinterpret_cast<const char*>(&hash), sizeof hash);
    std::istringstream in(state);
    Film film = Film::readState({8, 8}, in, "state");

    addSamples(film, 0, 0, Film::kBlock, [](std::uint32_t, std::size_t) { return 1000.0f; });
    EXPECT_EQ(film.samples(0), Film::kMaxSamples);
    double sum = 0;
    std::memcpy(&sum, &stateOfFilm(film)[sizeof before], sizeof sum);
    EXPECT_NEAR(sum - 0.1 * before, 16000.0, 1e-6); // nothing is lost
    EXPECT_FLOAT_EQ(film.resolve().data[0], static_cast<float>((0.1 * before + 16000) / Film::kMaxSamples));
}

TEST(Film, TakesDistinctTilesFromDistinctThreads) {
    const FilmDesc desc{64, 64, 2};
    const auto fill = [](Film& film, std::uint32_t first, std::uint32_t step) {
        for (std::uint32_t tile = first; tile < film.tileCount(); tile += step)
            for (std::uint32_t r = 0; r < 2; ++r)
                addSamples(film, tile, r, 37 + tile,
                           [=](std::uint32_t i, std::size_t v) { return uniform(i + tile, v); });
    };
    Film serial(desc), parallel(desc);
    serial.reserveOpenBlocks();
    parallel.reserveOpenBlocks();
    fill(serial, 0, 1);
    std::thread other([&] { fill(parallel, 1, 2); });
    fill(parallel, 0, 2);
    other.join();
    EXPECT_EQ(stateOfFilm(parallel), stateOfFilm(serial));
}

TEST(Film, HoldsToItsMemory) {
    const std::uint64_t pixels = 600 * 600, tiles = 75 * 75;
    Film film({600, 600});
    EXPECT_EQ(film.bytes(), 24 * pixels + 4 * tiles);
    film.reserveOpenBlocks();
    film.reserveOpenBlocks();
    EXPECT_EQ(film.bytes(), 36 * pixels + 4 * tiles);
    EXPECT_EQ(Film({600, 600, 1, true}).bytes(), 48 * pixels + 4 * tiles);
}

TEST(Film, RefusesBadSizes) {
    EXPECT_THROW(Film({0, 8}), UsageError);
    EXPECT_THROW(Film({8, 0}), UsageError);
    EXPECT_THROW(Film({kMaxImageSide + 1, 8}), UsageError);
    EXPECT_THROW(Film({8, 100000}), UsageError);
    EXPECT_THROW(Film({8, 8, 0}), UsageError);
    EXPECT_THROW(Film({kMaxImageSide, kMaxImageSide, 0xffffffffu}), RenderError); // more than any machine has
}

// Where somebody waits for something else: a large one after a piece of it at most, a small one is there at once.
TEST(Film, ReservingALargeOneCanBeCalledOff) {
    const std::atomic<bool> isCalledOff{true};
    const Interruptible interruptible(isCalledOff);
    EXPECT_THROW(Film({4096, 4096}), Interrupted);
    EXPECT_EQ(Film({64, 64}).tileCount(), 64u);
}

TEST(Film, ALargeOneIsEmptyThroughout) {
    const Film film({2048, 2048}); // of two pieces
    double maximum = 0;
    for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile)
        for (const double sum : film.state(tile, 0).sums) maximum = std::max(maximum, std::abs(sum));
    EXPECT_EQ(maximum, 0);
    EXPECT_EQ(film.totalSamples(), 0u);
}

} // namespace
} // namespace rt::image
