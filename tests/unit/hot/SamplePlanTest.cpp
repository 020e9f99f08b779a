// Adaptive sampling: unbiased on pictures made to fool it, its budget exact, its variance that of the picture, and the
// same after an interruption.
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/SamplePlan.h"
#include "Common/Shared/Base/Random.h"
#include "tests/unit/Statistics.h"

namespace rt::image {
namespace {

using test::Mean;

// What a sample of a pixel brings, from a number that is uniform in [0, 1).
using Radiance = std::function<float(std::uint32_t x, std::uint32_t y, double u)>;

constexpr std::uint32_t kPlanWidth = 11, kPlanHeight = 9; // tiles at the edges are cut

struct Picture {
    const char* name;
    Radiance radiance;
    std::function<double(std::uint32_t x, std::uint32_t y)> expected;
};

bool isLit(std::uint32_t x, std::uint32_t y) {
    return x == 5 && y == 4;
}

const Picture kPictures[] = {
    {"a light that one in 10^4 samples sees",
     [](std::uint32_t, std::uint32_t, double u) { return u < 1e-4 ? 1000.0f : 0.125f; },
     [](std::uint32_t, std::uint32_t) { return 1e-4 * 1000 + (1 - 1e-4) * 0.125; }},
    {"black", [](std::uint32_t, std::uint32_t, double) { return 0.0f; },
     [](std::uint32_t, std::uint32_t) { return 0.0; }},
    {"one bright pixel",
     [](std::uint32_t x, std::uint32_t y, double u) { return isLit(x, y) && u < 0.125 ? 80.0f : 0.0f; },
     [](std::uint32_t x, std::uint32_t y) { return isLit(x, y) ? 10.0 : 0.0; }},
    {"a checker of noise",
     [](std::uint32_t x, std::uint32_t y, double u) { return (x + y) % 2 == 0 ? 1.0f
                                                             : u < 0.0625     ? 16.0f
                                                                              : 0.0f; },
     [](std::uint32_t, std::uint32_t) { return 1.0; }},
};

// Renders such a picture as an engine would.
class Renderer {
  public:
    Renderer(const Radiance& radiance, std::uint32_t seed, std::uint32_t spp, std::uint32_t replicates = 2,
             std::uint32_t width = kPlanWidth, std::uint32_t height = kPlanHeight)
        : radiance_(radiance), seed_(seed), spp_(spp) {
        film = Film({width, height, replicates, false, pilotSamples(spp) > 0});
        film.reserveOpenBlocks();
    }

    void pilot() { upTo(pilotSamples(spp_)); }
    void finish() { upTo(goalOf(film, spp_)); }
    void plan() { film.setPlan(makeSamplePlan(film, spp_, 1)); }
    const Film& render() {
        pilot();
        if (film.isPilot()) plan();
        finish();
        return film;
    }

    // So many samples of each pixel, those that they have included.
    void upTo(std::uint64_t samples) {
        for (std::uint64_t next = film.nextSample(samples); next < samples; next = film.nextSample(samples))
            for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile)
                for (std::uint32_t r = 0; r < film.desc().replicates; ++r) {
                    const auto replicates = film.desc().replicates;
                    addBlock(tile, r, static_cast<std::uint32_t>((samples + replicates - 1 - r) / replicates));
                }
    }

    Film film;

  private:
    void addBlock(std::uint32_t tile, std::uint32_t replicate, std::uint32_t end) {
        if (film.hasPlan()) end = std::min(end, film.planEnd(tile, replicate));
        if (film.samples(tile, replicate) >= end) return;
        Film::TileBlock block;
        film.begin(tile, replicate, block);
        const std::uint32_t first = block.firstSample + block.count;
        const std::uint32_t last = std::min(block.firstSample + Film::kBlock, end);
        for (std::uint32_t pixel = 0; pixel < Film::kTilePixels; ++pixel) {
            const std::uint32_t x = tile % film.tilesX() * Film::kTile + pixel % Film::kTile;
            const std::uint32_t y = tile / film.tilesX() * Film::kTile + pixel / Film::kTile;
            const std::uint32_t stop = film.hasPlan() ? std::min(last, film.plan(tile, replicate)[pixel]) : last;
            for (std::uint32_t i = first; i < stop; ++i) {
                const auto words = shared::hash3({y * film.desc().width + x, i, seed_ * 64 + replicate});
                const float value = radiance_(x, y, words.x * 0x1p-32);
                for (std::size_t c = 0; c < 3; ++c) {
                    block.sum[3 * pixel + c] += value;
                    if (film.isPilot()) block.squares[3 * pixel + c] += value * value;
                }
            }
        }
        block.count = last - block.firstSample;
        film.commit(tile, replicate, block);
    }

    const Radiance& radiance_;
    std::uint32_t seed_, spp_;
};

// By the same film with its halves swapped: each half decides on itself.
void planByOwnSamples(Film& film, std::uint32_t spp) {
    Film swapped(film.desc());
    swapped.reserveOpenBlocks();
    for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile)
        for (std::uint32_t r = 0; r < 2; ++r) swapped.assign(tile, r, film.state(tile, 1 - r));
    film.setPlan(makeSamplePlan(swapped, spp, 1));
}

constexpr std::uint32_t kSeeds = 1000, kSpp = 16;

struct Regions {
    Mean all, left, lit; // means of the picture, of its left half, and of one pixel
    void add(const Image& picture, const Picture& of) {
        double sum = 0, left_ = 0;
        for (std::uint32_t y = 0; y < kPlanHeight; ++y)
            for (std::uint32_t x = 0; x < kPlanWidth; ++x) {
                const double error = *picture.pixel(x, y) - of.expected(x, y);
                sum += error;
                if (x < kPlanWidth / 2) left_ += error;
                if (isLit(x, y)) lit.add(error);
            }
        constexpr std::uint32_t kAll = kPlanWidth * kPlanHeight, kLeft = kPlanWidth / 2 * kPlanHeight;
        all.add(sum / kAll);
        left.add(left_ / kLeft);
    }
};

TEST(SamplePlan, TheMeanIsThatOfUniformSamples) {
    for (const Picture& picture : kPictures) {
        Regions regions;
        for (std::uint32_t seed = 0; seed < kSeeds; ++seed)
            regions.add(Renderer(picture.radiance, seed, kSpp).render().resolve(), picture);
        EXPECT_TRUE(test::agrees(regions.all, 0)) << picture.name;
        EXPECT_TRUE(test::agrees(regions.left, 0)) << picture.name;
        EXPECT_TRUE(test::agrees(regions.lit, 0)) << picture.name;
    }
}

// The test above would see it, wherever there is noise.
TEST(SamplePlan, OwnSamplesWouldDarken) {
    for (const Picture& picture : kPictures) {
        if (picture.name == std::string("black")) continue;
        Regions regions;
        for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
            Renderer renderer(picture.radiance, seed, kSpp);
            renderer.pilot();
            planByOwnSamples(renderer.film, kSpp);
            renderer.finish();
            regions.add(renderer.film.resolve(), picture);
        }
        EXPECT_LT(regions.all.mean(), -4 * regions.all.standardError()) << picture.name;
    }
}

TEST(SamplePlan, TheBudgetIsExact) {
    struct Size {
        std::uint32_t width, height;
    };
    for (const auto [width, height] : {Size{1, 1}, Size{7, 3}, Size{8, 8}, Size{19, 17}})
        for (const std::uint32_t spp : {1u, 2u, 15u, 16u, 17u, 31u, 64u, 75u, 100u, 257u})
            for (const std::uint32_t replicates : {2u, 4u, 6u}) {
                Renderer renderer(kPictures[3].radiance, 1, spp, replicates, width, height);
                const Film& film = renderer.render();
                double sum = 0;
                for (const float count : film.sampleCounts().data) sum += static_cast<double>(count);
                const std::uint64_t budget = std::uint64_t{spp} * width * height;
                EXPECT_EQ(film.totalSamples(), budget) << width << "x" << height << ", " << spp << ", " << replicates;
                EXPECT_EQ(sum, static_cast<double>(budget));
                EXPECT_EQ(film.samplesPerPixel(), spp);
                EXPECT_EQ(film.hasPlan(), spp >= 16);
            }
}

TEST(SamplePlan, NoiseGetsSamplesAndNothingDoesNot) {
    Renderer bright(kPictures[2].radiance, 3, 256);
    const Image counts = bright.render().sampleCounts();
    EXPECT_GT(*counts.pixel(5, 4), 4 * 256.0f);
    EXPECT_EQ(*counts.pixel(0, 0), *counts.pixel(10, 8)); // both far from it
    EXPECT_LT(*counts.pixel(0, 0), 256.0f);
    EXPECT_GE(*counts.pixel(0, 0), static_cast<float>(pilotSamples(256)));
    for (const float count : Renderer(kPictures[1].radiance, 3, 50).render().sampleCounts().data) EXPECT_EQ(count, 50);
}

// Overflow to infinity and its like do not spoil the plan of other pixels.
TEST(SamplePlan, VarianceThatIsNoNumberCostsNoMoreThanTheLimit) {
    const Radiance huge = [](std::uint32_t x, std::uint32_t y, double) { return isLit(x, y) ? 1e30f : 1.0f; };
    const Film film = Renderer(huge, 0, 64).render();
    EXPECT_EQ(film.totalSamples(), 64u * kPlanWidth * kPlanHeight);
    for (const float count : film.sampleCounts().data) EXPECT_LE(count, 16 * 64 + 2);
}

// Over many seeds the film's variance is that of its pictures.
TEST(SamplePlan, VarianceIsThatOfThePictures) {
    for (const std::uint32_t replicates : {2u, 4u}) {
        Mean stated, squares;
        for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
            const Film film = Renderer(kPictures[3].radiance, seed, 64, replicates).render();
            const Image mean = film.resolve(), variance = film.varianceOfMean();
            double statedSum = 0, squareSum = 0;
            for (std::size_t i = 0; i < mean.data.size(); i += 3) {
                statedSum += static_cast<double>(variance.data[i]);
                squareSum += std::pow(static_cast<double>(mean.data[i]) - 1, 2);
            }
            stated.add(statedSum);
            squares.add(squareSum);
        }
        const double error = std::hypot(stated.standardError(), squares.standardError());
        EXPECT_NEAR(stated.mean(), squares.mean(), 4 * error) << replicates;
    }
}

// A picture of several chunks of rows, one of them cut.
TEST(SamplePlan, DependsOnNoNumberOfThreads) {
    for (const std::uint32_t spp : {16u, 75u}) {
        Renderer renderer(kPictures[3].radiance, 2, spp, 4, 21, 53);
        renderer.pilot();
        const std::vector<std::uint32_t> expected = makeSamplePlan(renderer.film, spp, 2, {.threads = 1});
        for (const std::size_t threads : {2u, 3u, 8u})
            EXPECT_EQ(makeSamplePlan(renderer.film, spp, 2, {.threads = threads}), expected) << threads;
        renderer.film.setPlan(expected);
        renderer.finish();
        EXPECT_EQ(renderer.film.totalSamples(), std::uint64_t{spp} * 21 * 53);
    }
}

// With one sample of rounding between them, and others than their neighbours.
TEST(SamplePlan, PixelsThatDependOnEachOtherGetAlikeMany) {
    constexpr std::uint32_t kSide = 2, kMany = 64;
    const Radiance noisyLeft = [](std::uint32_t x, std::uint32_t, double u) {
        return x < 5 ? static_cast<float>(u) : 0.5f; // the edge is within a square
    };
    Renderer renderer(noisyLeft, 3, kMany);
    renderer.pilot();
    const std::vector<std::uint32_t> alone = makeSamplePlan(renderer.film, kMany, 1);
    const std::vector<std::uint32_t> plan = makeSamplePlan(renderer.film, kMany, kSide);
    const auto spread = [](const std::vector<std::uint32_t>& of, std::uint32_t x, std::uint32_t y) { // in one square
        std::uint32_t minimum = of[y * Film::kTile + x], maximum = minimum;
        for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
            const std::uint32_t samples = of[(y + i / kSide) * Film::kTile + x + i % kSide];
            minimum = std::min(minimum, samples);
            maximum = std::max(maximum, samples);
        }
        return maximum - minimum;
    };
    std::uint32_t largest = 0, largestAlone = 0; // of the first tile
    for (std::uint32_t y = 0; y < Film::kTile; y += kSide)
        for (std::uint32_t x = 0; x < Film::kTile; x += kSide) {
            largest = std::max(largest, spread(plan, x, y));
            largestAlone = std::max(largestAlone, spread(alone, x, y));
        }
    EXPECT_LE(largest, 1u);
    EXPECT_GT(largestAlone, 4u);
    EXPECT_GT(plan[0], plan[Film::kTile - 1] + 4);
}

TEST(SamplePlan, CanBeCancelled) {
    Renderer renderer(kPictures[3].radiance, 2, 16);
    renderer.pilot();
    std::atomic<bool> cancel{true};
    EXPECT_TRUE(makeSamplePlan(renderer.film, 16, 1, {.cancel = &cancel}).empty());
    cancel = false;
    EXPECT_EQ(makeSamplePlan(renderer.film, 16, 1, {.cancel = &cancel}), makeSamplePlan(renderer.film, 16, 1));
}

TEST(SamplePlan, GoesOnFromACheckpointInAnyPhase) {
    constexpr std::uint32_t kMany = 200; // whose pilot has 64
    const Radiance& radiance = kPictures[3].radiance;
    const auto stateOf = [](const Film& film) {
        std::ostringstream out;
        film.writeState(out);
        return out.str();
    };
    Renderer whole(radiance, 5, kMany);
    const std::string expected = stateOf(whole.render());
    for (const std::uint64_t stop : {7u, 63u, 64u, 65u, 150u, 100000u}) {
        Renderer first(radiance, 5, kMany), second(radiance, 5, kMany);
        first.upTo(std::min<std::uint64_t>(stop, pilotSamples(kMany)));
        if (stop > pilotSamples(kMany)) {
            first.plan();
            first.upTo(std::min(stop, goalOf(first.film, kMany)));
        }
        std::istringstream in(stateOf(first.film));
        second.film = Film::readState(first.film.desc(), in, "state");
        second.film.reserveOpenBlocks();
        EXPECT_EQ(stateOf(second.render()), expected) << stop;
        EXPECT_EQ(second.film.resolve().data, whole.film.resolve().data);
    }
}

} // namespace
} // namespace rt::image
