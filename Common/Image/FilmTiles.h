// Some tiles of a film apart from the others: parts of an image that are rendered elsewhere and joined, bit for bit.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "Common/Image/Film.h"

namespace rt::image {

using TileList = std::vector<std::uint32_t>; // ascending

TileList allTiles(const Film& film);

// Samples that each pixel of these tiles has at least.
std::uint64_t minSamples(const Film& film, std::span<const std::uint32_t> tiles);
// Film::nextSample() of these tiles.
std::uint64_t nextSample(const Film& film, std::span<const std::uint32_t> tiles, std::uint64_t spp);
// What all pixels inside of the image lack of their first `spp` samples; with a plan, of those that it gives them.
std::uint64_t missingSamples(const Film& film, std::span<const std::uint32_t> tiles, std::uint64_t spp);
// Pixels inside of the image, and samples of all of them.
std::uint64_t pixelCount(const Film& film, std::span<const std::uint32_t> tiles);
std::uint64_t totalSamples(const Film& film, std::span<const std::uint32_t> tiles);

// Makes packed tiles of the states of tiles, in the order in which they are added.
class TilePacker {
  public:
    // `bytes` of room, as packedSize() adds up to.
    explicit TilePacker(std::size_t bytes);
    static std::size_t packedSize(const Film::TileState& state);
    void add(std::uint32_t tile, std::uint32_t replicate, const Film::TileState& state);
    std::vector<std::byte> take() { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
};

// What these tiles hold and what a plan gives them, to be sent between processes of one program on machines of one
// kind; a tile without samples and plan takes few bytes.
std::vector<std::byte> packTiles(const Film& film, std::span<const std::uint32_t> tiles);
// Takes over each tile and replicate that has more samples there than in this film, which must have the same
// description, and every plan. Returns the tiles that were packed. Throws RenderError when the bytes are not those of
// such tiles.
TileList unpackTiles(std::span<const std::byte> bytes, Film& film);

} // namespace rt::image
