// Tiles apart from their film: what is packed comes back bit for bit, and joined films are whole ones.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/FilmTiles.h"

namespace rt::image {
namespace {

// Tile t has 5 t samples, of which some are in an open block.
Film makeFilm(const FilmDesc& desc) {
    Film film(desc);
    film.reserveOpenBlocks();
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform;
    for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile) {
        for (std::uint32_t replicate = 0; replicate < desc.replicates; ++replicate) {
            for (std::uint32_t left = 5 * tile; left > 0;) {
                Film::TileBlock block;
                film.begin(tile, replicate, block);
                block.count = std::min(left, Film::kBlock);
                for (float& value : block.sum) value = uniform(random);
                film.commit(tile, replicate, block);
                left -= block.count;
            }
        }
    }
    return film;
}

bool sameBits(const Film& a, const Film& b) {
    if (a.desc() != b.desc()) return false;
    for (std::uint32_t tile = 0; tile < a.tileCount(); ++tile) {
        for (std::uint32_t replicate = 0; replicate < a.desc().replicates; ++replicate) {
            const Film::TileState s = a.state(tile, replicate), t = b.state(tile, replicate);
            if (s.samples != t.samples || !std::equal(s.sums.begin(), s.sums.end(), t.sums.begin()) ||
                !std::equal(s.squares.begin(), s.squares.end(), t.squares.begin(), t.squares.end()) ||
                !std::equal(s.open.begin(), s.open.end(), t.open.begin(), t.open.end()))
                return false;
        }
    }
    return true;
}

TEST(FilmTiles, PartsMakeTheWholeInAnyOrder) {
    for (const FilmDesc& desc : {FilmDesc{33, 20, 1, true}, FilmDesc{33, 20, 3, false}}) {
        const Film film = makeFilm(desc);
        Film joined(desc);
        const TileList odd = {1, 3, 5, 7, 9, 11, 13}, even = {0, 2, 4, 6, 8, 10, 12, 14};
        EXPECT_EQ(unpackTiles(packTiles(film, odd), joined), odd);
        EXPECT_FALSE(sameBits(film, joined));
        EXPECT_EQ(unpackTiles(packTiles(film, even), joined), even);
        EXPECT_TRUE(sameBits(film, joined));
        EXPECT_EQ(totalSamples(film, odd) + totalSamples(film, even), film.totalSamples());
        EXPECT_EQ(pixelCount(film, allTiles(film)), 33u * 20u);
        EXPECT_EQ(minSamples(film, odd), 5u * desc.replicates);
        EXPECT_EQ(nextSample(film, odd, 1000), 5u * desc.replicates);
        EXPECT_EQ(missingSamples(film, odd, 0), 0u);
        const std::uint64_t end = 100u * desc.replicates;
        EXPECT_EQ(missingSamples(film, odd, end) + totalSamples(film, odd), pixelCount(film, odd) * end);
    }
}

TEST(FilmTiles, FewerSamplesNeverReplaceMore) {
    const FilmDesc desc{16, 8, 1, false};
    Film film = makeFilm(desc); // 0 and 5 samples
    const Film before = film;
    const TileList all = allTiles(film);
    EXPECT_EQ(unpackTiles(packTiles(Film(desc), all), film), all);
    EXPECT_TRUE(sameBits(film, before));
}

// Of each tile, what its number says.
std::vector<std::uint32_t> makePlan(const Film& film) {
    std::vector<std::uint32_t> plan;
    for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile)
        plan.insert(plan.end(), film.desc().replicates * Film::kTilePixels, 8 * tile + 3);
    return plan;
}

TEST(FilmTiles, PlansTravelWithTheirTiles) {
    const FilmDesc desc{16, 16, 2, false, true};
    const TileList some = {1, 3};
    Film joined(desc);
    Film planned = makeFilm(desc); // 0, 5, 10 and 15 samples, in each replicate
    const auto late = packTiles(planned, some);
    planned.setPlan(makePlan(planned));
    unpackTiles(packTiles(planned, some), joined);
    ASSERT_TRUE(joined.hasPlan());
    for (const std::uint32_t tile : some) {
        EXPECT_EQ(joined.planEnd(tile, 1), 8 * tile + 3);
        EXPECT_TRUE(std::ranges::equal(joined.plan(tile, 1), planned.plan(tile, 1)));
    }
    EXPECT_EQ(totalSamples(joined, some), totalSamples(planned, some));
    // Tile 1 gets 11 samples and has 5, tile 3 gets 27 and has 15, in 64 pixels and two replicates each.
    EXPECT_EQ(missingSamples(joined, some, 1000), (6u + 12u) * 64 * 2);
    EXPECT_EQ(missingSamples(joined, some, 2 * 16), (6u + 1u) * 64 * 2);
    EXPECT_EQ(nextSample(joined, some, 1000), 10u);
    EXPECT_EQ(joined.nextSample(3, 1000), 30u);
    EXPECT_EQ(joined.nextSample(3, 30), Film::kNoSample);
    EXPECT_EQ(joined.nextSample(0, 1000), Film::kNoSample); // which has no plan
    unpackTiles(late, joined);                              // of the pilot, which is over
    EXPECT_EQ(missingSamples(joined, some, 1000), (6u + 12u) * 64 * 2);
    Film uniform({16, 16, 2, false, false});
    EXPECT_THROW(unpackTiles(packTiles(planned, some), uniform), RenderError);
}

// As a rank does with one lease after the other: nothing of the one before is left.
TEST(FilmTiles, PartsHoldWhatTheyAreToldTo) {
    for (const FilmDesc& desc :
         {FilmDesc{33, 20, 1, true}, FilmDesc{33, 20, 3, false}, FilmDesc{33, 20, 2, false, true}}) {
        const Film film = makeFilm(desc);
        Film part = Film::part(desc);
        EXPECT_FALSE(part.holds(3));
        Film joined(desc);
        for (const TileList& tiles : {TileList{3}, TileList{0, 2, 7, 9, 14}, TileList{1, 4, 5, 6, 8, 10, 11, 12, 13}}) {
            part.hold(tiles);
            EXPECT_EQ(totalSamples(part, tiles), 0u);
            EXPECT_EQ(missingSamples(part, tiles, 70), missingSamples(Film(desc), tiles, 70));
            const auto packed = packTiles(film, tiles);
            EXPECT_EQ(unpackTiles(packed, part), tiles);
            EXPECT_TRUE(packTiles(part, tiles) == packed);
            unpackTiles(packTiles(part, tiles), joined);
        }
        EXPECT_TRUE(sameBits(film, joined));
        EXPECT_LT(part.bytes(), film.bytes());
        EXPECT_TRUE(part.holds(13));
        EXPECT_FALSE(part.holds(14));
        EXPECT_FALSE(part.holds(film.tileCount()));
        const TileList other = {14};
        EXPECT_THROW(unpackTiles(packTiles(film, other), part), RenderError);
    }
}

// A plan is forgotten as well.
TEST(FilmTiles, PartsGoOnToAPlanAndBack) {
    const FilmDesc desc{16, 16, 2, false, true};
    Film planned = makeFilm(desc);
    const auto pilot = packTiles(planned, TileList{2});
    planned.setPlan(makePlan(planned));
    Film part = Film::part(desc);
    const TileList some = {1, 3}, other = {2};
    part.hold(some);
    EXPECT_TRUE(part.isPilot());
    const auto packed = packTiles(planned, some);
    unpackTiles(packed, part);
    EXPECT_EQ(part.planEnd(3, 1), planned.planEnd(3, 1));
    EXPECT_TRUE(packTiles(part, some) == packed);
    part.hold(other);
    EXPECT_TRUE(part.isPilot());
    unpackTiles(pilot, part);
    EXPECT_TRUE(packTiles(part, other) == pilot);
}

TEST(FilmTiles, BytesOfOtherFilmsAreRefused) {
    const Film film = makeFilm({64, 64, 1, false});
    const TileList last = {63};
    const auto bytes = packTiles(film, last);
    Film small({16, 16, 1, false});
    EXPECT_THROW(unpackTiles(bytes, small), RenderError);
    Film same({64, 64, 1, false});
    EXPECT_THROW(unpackTiles(std::span(bytes).first(bytes.size() - 1), same), RenderError);
}

} // namespace
} // namespace rt::image
