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
