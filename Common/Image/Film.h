// Radiance sums that are exact for any number of samples: per pixel, blocks of 16 consecutive sample indices are summed in
// order in float and added in order to sums in double, so neither the size of a dispatch nor an interruption shows.
#pragma once
#include <cstdint>
#include <vector>

#include "Common/Image/Image.h"

namespace rt::image {

inline constexpr std::uint32_t kMaxImageSide = 16384;

struct FilmDesc {
    std::uint32_t width = 0;  // 1 to kMaxImageSide
    std::uint32_t height = 0;
    std::uint32_t replicates = 1; // independent scramblings, each with sums of its own
    bool secondMoments = false;   // keep sums of squares as well
    bool operator==(const FilmDesc&) const = default;
};

// Pixels are stored in tiles of 8x8, row by row; tiles at the right and lower edge are partly outside of the image.
// Distinct tiles may be read and written by distinct threads at the same time; nothing else is synchronised.
class Film {
  public:
    static constexpr std::uint32_t kBlock = 16; // samples
    static constexpr std::uint32_t kTile = 8;   // pixels
    static constexpr std::uint32_t kTilePixels = kTile * kTile;

    // Sums over the samples of one block, of one tile and replicate; channel-interleaved RGB, pixels row by row.
    struct TileBlock {
        std::uint32_t firstSample = 0; // index, in the replicate, of the block's first sample: a multiple of kBlock
        std::uint32_t count = 0;       // samples already summed, < kBlock when begin() returns it
        float sum[kTilePixels * 3] = {};
        float squares[kTilePixels * 3] = {}; // unused without second moments
    };

    Film() = default;
    explicit Film(const FilmDesc& desc); // throws RenderError when memory does not suffice

    const FilmDesc& desc() const { return desc_; }
    std::uint32_t tilesX() const;
    std::uint32_t tilesY() const;
    std::uint32_t tileCount() const { return tilesX() * tilesY(); }

    // Samples that each pixel of the tile has received in the replicate.
    std::uint32_t samples(std::uint32_t tile, std::uint32_t replicate) const;
    // The same over all replicates.
    std::uint64_t samples(std::uint32_t tile) const;
    // Least over all tiles: what a statistic may call "done".
    std::uint64_t minSamples() const;
    // Sum over all pixels of the image and all replicates.
    std::uint64_t totalSamples() const;

    // The tile's open block, to go on from: an empty one unless the last commit left it unfilled.
    void begin(std::uint32_t tile, std::uint32_t replicate, TileBlock& block) const;
    // Replaces the tile's open block. A full block is added to the sums and closed.
    void commit(std::uint32_t tile, std::uint32_t replicate, const TileBlock& block);

    // Mean radiance: sum over all replicates / true count; pixels without samples are black.
    Image resolve() const;
    // Variance of each pixel's mean, per channel. With two or more replicates it is taken across them and unbiased for every
    // sampler; with one it is within-run and only an upper bound for stratified samplers (errorIsUpperBound()). Pixels
    // with too few samples get 0. Requires secondMoments or replicates >= 2.
    Image varianceOfMean() const;
    bool errorIsUpperBound() const { return desc_.replicates < 2; }
    Image sampleCounts() const; // one channel

    // Raw state for checkpoints: written and read back bit for bit. readState throws InputError on a truncated or
    // inconsistent stream.
    void writeState(std::ostream& out) const;
    static Film readState(const FilmDesc& desc, std::istream& in, const std::string& name);

    std::uint64_t bytes() const; // of memory held

  private:
    FilmDesc desc_;
};

}  // namespace rt::image
