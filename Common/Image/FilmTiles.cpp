#include "Common/Image/FilmTiles.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "Common/Core/Error.h"
#include "Common/Core/SystemMemory.h"

namespace rt::image {
namespace {

constexpr std::size_t kTileValues = std::size_t{Film::kTilePixels} * 3;

constexpr std::size_t kRoom = 4096; // bytes that whoever sends packed tiles may add without a copy

struct Header { // of a tile's state in one replicate
    std::uint32_t tile = 0;
    std::uint32_t replicate = 0;
    std::uint32_t samples = 0;
    std::uint32_t isPlanned = 0; // 1: the plan of its pixels comes first
};

// Of a tile, inside of the image.
struct Extent {
    std::uint32_t columns, rows;
};

Extent extentOf(const Film& film, std::uint32_t tile) {
    const FilmDesc& desc = film.desc();
    return {std::min(Film::kTile, desc.width - tile % film.tilesX() * Film::kTile),
            std::min(Film::kTile, desc.height - tile / film.tilesX() * Film::kTile)};
}

std::uint64_t samplesIn(const Extent& extent, const Film::TileState& state) {
    if (state.plan.empty()) return std::uint64_t{state.samples} * extent.columns * extent.rows;
    std::uint64_t total = 0;
    for (std::uint32_t y = 0; y < extent.rows; ++y)
        for (std::uint32_t x = 0; x < extent.columns; ++x) total += state.samplesOf(std::size_t{y} * Film::kTile + x);
    return total;
}

template <class T>
void append(std::vector<std::byte>& bytes, std::span<const T> values) {
    const auto more = std::as_bytes(values);
    bytes.insert(bytes.end(), more.begin(), more.end());
}

class TileReader {
  public:
    explicit TileReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    bool atEnd() const { return bytes_.empty(); }
    template <class T>
    void read(std::span<T> values) {
        if (bytes_.size() < values.size_bytes()) throw RenderError("tiles of a film were received incompletely");
        std::ranges::copy(bytes_.first(values.size_bytes()), std::as_writable_bytes(values).begin());
        bytes_ = bytes_.subspan(values.size_bytes());
    }

  private:
    std::span<const std::byte> bytes_;
};

} // namespace

TileList allTiles(const Film& film) {
    TileList tiles(film.tileCount());
    std::iota(tiles.begin(), tiles.end(), 0u);
    return tiles;
}

std::uint64_t minSamples(const Film& film, std::span<const std::uint32_t> tiles) {
    std::uint64_t minimum = std::numeric_limits<std::uint64_t>::max();
    for (const std::uint32_t tile : tiles) minimum = std::min(minimum, film.samples(tile));
    return tiles.empty() ? 0 : minimum;
}

std::uint64_t nextSample(const Film& film, std::span<const std::uint32_t> tiles, std::uint64_t spp) {
    std::uint64_t minimum = Film::kNoSample;
    for (const std::uint32_t tile : tiles) minimum = std::min(minimum, film.nextSample(tile, spp));
    return minimum;
}

std::uint64_t missingSamples(const Film& film, std::span<const std::uint32_t> tiles, std::uint64_t spp) {
    const std::uint64_t replicates = film.desc().replicates;
    std::uint64_t missing = 0;
    for (const std::uint32_t tile : tiles) {
        for (std::uint32_t replicate = 0; replicate < replicates; ++replicate) {
            Film::TileState state = film.state(tile, replicate);
            const std::uint64_t had = samplesIn(extentOf(film, tile), state);
            const std::uint64_t end = (spp + replicates - 1 - replicate) / replicates;
            if (state.samples >= end) continue;
            state.samples = static_cast<std::uint32_t>(end);
            missing += samplesIn(extentOf(film, tile), state) - had;
        }
    }
    return missing;
}

std::uint64_t pixelCount(const Film& film, std::span<const std::uint32_t> tiles) {
    std::uint64_t pixels = 0;
    for (const std::uint32_t tile : tiles) {
        const Extent extent = extentOf(film, tile);
        pixels += std::uint64_t{extent.columns} * extent.rows;
    }
    return pixels;
}

std::uint64_t totalSamples(const Film& film, std::span<const std::uint32_t> tiles) {
    std::uint64_t total = 0;
    for (const std::uint32_t tile : tiles)
        for (std::uint32_t replicate = 0; replicate < film.desc().replicates; ++replicate)
            total += samplesIn(extentOf(film, tile), film.state(tile, replicate));
    return total;
}

TilePacker::TilePacker(std::size_t bytes) {
    reserveLarge(bytes_, bytes + kRoom);
}

std::size_t TilePacker::packedSize(const Film::TileState& state) {
    const std::size_t sums = state.sums.size_bytes() + state.squares.size_bytes() + state.open.size_bytes();
    return sizeof(Header) + state.plan.size_bytes() + (state.samples > 0 ? sums : 0);
}

void TilePacker::add(std::uint32_t tile, std::uint32_t replicate, const Film::TileState& state) {
    const Header header{tile, replicate, state.samples, state.plan.empty() ? 0u : 1u};
    append(bytes_, std::span(&header, 1));
    append(bytes_, state.plan);
    if (state.samples == 0) return;
    append(bytes_, state.sums);
    append(bytes_, state.squares);
    append(bytes_, state.open);
}

std::vector<std::byte> packTiles(const Film& film, std::span<const std::uint32_t> tiles) {
    const std::uint32_t replicates = film.desc().replicates;
    const auto forEachState = [&](const auto& visit) {
        for (const std::uint32_t tile : tiles)
            for (std::uint32_t replicate = 0; replicate < replicates; ++replicate)
                visit(tile, replicate, film.state(tile, replicate));
    };
    std::size_t size = 0; // may be most of a film: room for it is asked for once
    forEachState(
        [&size](std::uint32_t, std::uint32_t, const Film::TileState& state) { size += TilePacker::packedSize(state); });
    TilePacker packer(size);
    forEachState([&packer](std::uint32_t tile, std::uint32_t replicate, const Film::TileState& state) {
        packer.add(tile, replicate, state);
    });
    return packer.take();
}

TileList unpackTiles(std::span<const std::byte> bytes, Film& film) {
    const FilmDesc& desc = film.desc();
    TileList tiles;
    std::vector<double> sums(kTileValues), squares;
    std::vector<float> open;
    std::vector<std::uint32_t> plan(Film::kTilePixels);
    for (TileReader reader(bytes); !reader.atEnd();) {
        Header header;
        reader.read(std::span(&header, 1));
        if (!film.holds(header.tile) || header.replicate >= desc.replicates ||
            (header.isPlanned != 0 && !desc.adaptive))
            throw RenderError("tiles of another film were received");
        if (tiles.empty() || tiles.back() != header.tile) tiles.push_back(header.tile);
        if (header.isPlanned != 0) {
            reader.read(std::span(plan));
            film.assignPlan(header.tile, header.replicate, plan);
        }
        if (header.samples == 0) continue;
        const bool hasSquares = desc.secondMoments || (desc.adaptive && header.isPlanned == 0);
        squares.resize(hasSquares ? kTileValues : 0);
        open.resize(header.samples % Film::kBlock == 0 ? 0 : kTileValues);
        reader.read(std::span(sums));
        reader.read(std::span(squares));
        reader.read(std::span(open));
        if (header.samples <= film.samples(header.tile, header.replicate)) continue;
        if (!open.empty()) film.reserveOpenBlocks();
        film.assign(header.tile, header.replicate, {header.samples, sums, squares, open});
    }
    return tiles;
}

} // namespace rt::image
