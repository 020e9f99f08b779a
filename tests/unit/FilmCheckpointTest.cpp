// Checkpoints: bit for bit, and no damage goes unnoticed.
#include <algorithm>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Image/Checkpoint.h"
#include "tests/TempFolder.h"

namespace rt::image {
namespace {

const FilmDesc kDesc{5, 3, 2, true};

// Both replicates with closed blocks, the second with an open one too.
Film makeFilm() {
    Film film(kDesc);
    film.reserveOpenBlocks();
    for (std::uint32_t r = 0; r < 2; ++r) {
        for (std::uint32_t b = 0; b < 2 + r; ++b) {
            Film::TileBlock block;
            film.begin(0, r, block);
            block.count = b == 2 ? 7 : Film::kBlock;
            for (std::size_t i = 0; i < std::size(block.sum); ++i)
                block.sum[i] = 0.1f * float(i + 1) / float(r + b + 1);
            film.commit(0, r, block);
        }
    }
    return film;
}

std::string stateOf(const Film& film) {
    std::ostringstream out;
    film.writeState(out);
    return out.str();
}

const nlohmann::json kRender = {{"seed", 7}, {"scene", "box"}};

std::string makeCheckpoint() {
    std::ostringstream out;
    writeCheckpoint(out, kRender, makeFilm());
    return out.str();
}

// The error of reading these bytes as the file render.rtc; empty when there is none.
std::string errorOf(const std::string& bytes) {
    std::istringstream in(bytes);
    try {
        readCheckpoint(in, "render.rtc");
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(FilmCheckpoint, ComesBackBitForBit) {
    const test::TempFolder folder;
    writeCheckpoint(folder / "render.rtc", kRender, makeFilm());
    const Checkpoint checkpoint = readCheckpoint(folder / "render.rtc");
    EXPECT_EQ(checkpoint.render, kRender);
    EXPECT_EQ(checkpoint.film.desc(), kDesc);
    EXPECT_EQ(checkpoint.film.samples(0, 1), 39u);
    EXPECT_EQ(stateOf(checkpoint.film), stateOf(makeFilm()));
    EXPECT_EQ(checkpoint.film.resolve().data, makeFilm().resolve().data);
    EXPECT_EQ(checkpoint.film.varianceOfMean().data, makeFilm().varianceOfMean().data);

    Film::TileBlock restored, original;
    checkpoint.film.begin(0, 1, restored);
    makeFilm().begin(0, 1, original);
    EXPECT_EQ(restored.count, 7u);
    EXPECT_TRUE(std::equal(std::begin(restored.sum), std::end(restored.sum), std::begin(original.sum)));
}

// Made by hand, as its hash fits.
TEST(FilmCheckpoint, SumsThatNoRenderHasAreRefused) {
    for (const float value : {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        for (const std::uint32_t count : {7u, Film::kBlock}) {
            Film film = makeFilm();
            Film::TileBlock block;
            film.begin(0, 0, block);
            block.count = count;
            block.sum[1] = value;
            film.commit(0, 0, block);
            std::ostringstream out;
            writeCheckpoint(out, kRender, film);
            EXPECT_NE(errorOf(out.str()).find("damaged: a sum is negative or not finite"), std::string::npos) << value;
        }
}

TEST(FilmCheckpoint, TruncationIsNoticedAtEveryByte) {
    const std::string whole = makeCheckpoint();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const std::string error = errorOf(whole.substr(0, size));
        ASSERT_NE(error.find("render.rtc"), std::string::npos) << "at " << size << ": " << error;
    }
    EXPECT_EQ(errorOf(whole), "");
    EXPECT_NE(errorOf(whole + '\0'), "");
}

TEST(FilmCheckpoint, DamageIsNoticedInEveryByte) {
    std::string bytes = makeCheckpoint();
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        const char flip = static_cast<char>(1 << at % 8);
        bytes[at] = static_cast<char>(bytes[at] ^ flip);
        ASSERT_NE(errorOf(bytes), "") << "at " << at;
        bytes[at] = static_cast<char>(bytes[at] ^ flip);
    }
}

TEST(FilmCheckpoint, ErrorsSayWhatIsWrong) {
    std::string bytes = makeCheckpoint();
    EXPECT_NE(errorOf("hello").find("not a checkpoint"), std::string::npos);
    bytes[8] = 9;
    EXPECT_NE(errorOf(bytes).find("version 9"), std::string::npos);
    EXPECT_THROW(readCheckpoint(test::TempFolder() / "missing.rtc"), InputError);
    EXPECT_THROW(writeCheckpoint(test::TempFolder() / "missing" / "a.rtc", kRender, makeFilm()), RenderError);
}

// A copy of a value recurses: nested without end it would leave the stack.
TEST(FilmCheckpoint, AHeaderIsNotNestedWithoutEnd) {
    const auto nested = [](int depth) {
        nlohmann::json render = kRender;
        for (int i = 0; i < depth; ++i) render = nlohmann::json::array({std::move(render)});
        std::ostringstream out;
        writeCheckpoint(out, render, makeFilm());
        return errorOf(out.str());
    };
    EXPECT_EQ(nested(50), "");
    EXPECT_EQ(nested(100), "render.rtc: checkpoint is damaged: its header is nested deeper than 64");
}

TEST(FilmCheckpoint, AHugeImageInASmallFileCostsNoMemory) {
    std::istringstream in("short");
    const FilmDesc huge{kMaxImageSide, kMaxImageSide, 0xffffffffu, true}; // would throw RenderError when allocated
    EXPECT_THROW(Film::readState(huge, in, "state"), InputError);
}

} // namespace
} // namespace rt::image
