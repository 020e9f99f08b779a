// Radiance sums that are exact for any number of samples: per pixel, blocks of 16 consecutive sample indices are summed
// in order in float and added in order to sums in double, so neither the size of a dispatch nor an interruption shows.
#pragma once
#include <algorithm>
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "Common/Image/Image.h"

namespace rt::image {

inline constexpr std::uint32_t kMaxImageSide = 16384;

struct FilmDesc {
    std::uint32_t width = 0; // 1 to kMaxImageSide
    std::uint32_t height = 0;
    std::uint32_t replicates = 1; // independent scramblings, each with sums of its own
    bool secondMoments = false;   // keep what the variance within a single replicate needs
    bool adaptive = false;        // a plan follows a pilot, see SamplePlan.h; replicates are even in number then
    bool operator==(const FilmDesc&) const = default;
};

// Pixels are stored in tiles of 8x8, row by row; tiles at the right and lower edge are partly outside of the image.
// Distinct tiles may be read and written by distinct threads at the same time; nothing else is synchronised.
// Memory per pixel and replicate: 24 bytes, 24 more with second moments, 12 more once open blocks are reserved; of an
// adaptive film 24 more during the pilot and 4 more after it.
class Film {
  public:
    static constexpr std::uint32_t kBlock = 16; // samples
    static constexpr std::uint32_t kTile = 8;   // pixels
    static constexpr std::uint32_t kTilePixels = kTile * kTile;
    static constexpr std::uint32_t kMaxSamples = 1u << 31; // per pixel and replicate

    // Sums over the samples of one block, of one tile and replicate; channel-interleaved RGB, pixels row by row.
    struct TileBlock {
        std::uint32_t firstSample = 0; // index, in the replicate, of the block's first sample: a multiple of kBlock
        std::uint32_t count = 0;       // samples already summed, < kBlock when begin() returns it
        float sum[kTilePixels * 3] = {};
        // Of an adaptive film's pilot: sums of the squares of the samples since begin().
        float squares[kTilePixels * 3] = {};
    };

    Film() = default;
    explicit Film(const FilmDesc& desc); // throws UsageError for a bad size, RenderError when memory does not suffice
    // Part of a film of such an image, without room for any tile until hold(). Only members that take tiles may be
    // called, with tiles that it holds. Throws UsageError for a bad size.
    static Film part(const FilmDesc& desc);
    // Of a part: forgets all that it has and holds these tiles, without samples or plan. Memory is kept for the next
    // ones. Throws RenderError when it does not suffice.
    void hold(std::span<const std::uint32_t> tiles);
    bool isPart() const { return !places_.empty(); }
    // Whether the tile is one of the image, and of the part if this is one.
    bool holds(std::uint32_t tile) const { return tile < tileCount() && (!isPart() || places_[tile] != kNowhere); }

    const FilmDesc& desc() const { return desc_; }
    std::uint32_t tilesX() const { return (desc_.width + kTile - 1) / kTile; }
    std::uint32_t tilesY() const { return (desc_.height + kTile - 1) / kTile; }
    std::uint32_t tileCount() const { return tilesX() * tilesY(); }

    // Samples that each pixel of the tile has received in the replicate; where there is a plan, each that is not done
    // before.
    std::uint32_t samples(std::uint32_t tile, std::uint32_t replicate) const { return samples_[slot(tile, replicate)]; }
    // The same over all replicates.
    std::uint64_t samples(std::uint32_t tile) const;
    // Least over all tiles.
    std::uint64_t minSamples() const;
    // Most over all tiles.
    std::uint64_t maxSamples() const;
    // Least over all tiles and replicates.
    std::uint32_t minReplicateSamples() const;
    // Sum over all pixels of the image and all replicates.
    std::uint64_t totalSamples() const;
    // What a statistic may call "done": samples of every pixel, or where there is a plan their mean, rounded down.
    std::uint64_t samplesPerPixel() const;
    // The replicates of an adaptive film make two halves.
    static constexpr std::uint32_t halfOf(std::uint32_t replicate) { return replicate % 2; }
    // The least index, below `spp`, of a sample that some pixel lacks, of the tile or of all; with a plan, of those
    // that it gives the pixel. kNoSample: there is none.
    // Sample s of a pixel is number s / replicates of replicate s mod replicates.
    static constexpr std::uint64_t kNoSample = ~std::uint64_t{0};
    std::uint64_t nextSample(std::uint32_t tile, std::uint64_t spp) const;
    std::uint64_t nextSample(std::uint64_t spp) const;

    // Of an adaptive film, once its pilot is done: how many samples each pixel gets in all, kTilePixels a slot, the
    // slots of a tile's replicates side by side. The pilot's squares are dropped.
    void setPlan(std::vector<std::uint32_t> plan);
    // The same for one tile and replicate, of a film that renders only some of its tiles: the others get no samples
    // until they have a plan. Throws std::logic_error like setPlan() when the film is not adaptive.
    void assignPlan(std::uint32_t tile, std::uint32_t replicate, std::span<const std::uint32_t> plan);
    bool hasPlan() const { return !plan_.empty(); }
    bool isPilot() const { return desc_.adaptive && !hasPlan(); }
    // What each pixel of the tile gets in the replicate; empty without a plan.
    std::span<const std::uint32_t> plan(std::uint32_t tile, std::uint32_t replicate) const;
    // Where all pixels of the tile are done in the replicate: the most that the plan gives one of them.
    std::uint32_t planEnd(std::uint32_t tile, std::uint32_t replicate) const { return ends_[slot(tile, replicate)]; }
    // The most that the plan gives any pixel.
    std::uint32_t planEnd() const { return *std::max_element(ends_.begin(), ends_.end()); }

    // Makes room for blocks that stay unfilled. To be called, by one thread, before work that may commit such a block;
    // costs nothing when called again. Throws RenderError when memory does not suffice.
    void reserveOpenBlocks();

    // The tile's open block, to go on from: an empty one unless the last commit left it unfilled.
    void begin(std::uint32_t tile, std::uint32_t replicate, TileBlock& block) const;
    // Replaces the tile's open block. A full block is added to the sums and closed; an unfilled one needs
    // reserveOpenBlocks(). Throws std::logic_error when the block does not continue what the tile has.
    void commit(std::uint32_t tile, std::uint32_t replicate, const TileBlock& block);

    // What a tile and replicate hold: kTilePixels * 3 values each, laid out as in TileBlock.
    struct TileState {
        std::uint32_t samples = 0;
        std::span<const double> sums;    // of all closed blocks
        std::span<const double> squares; // of (block sum)^2 / kBlock, or of a pilot's samples; empty without either
        std::span<const float> open;     // the open block; empty unless there is one
        std::span<const std::uint32_t> plan{}; // most samples of each pixel; empty without one; assign() keeps its own
        // Of a pixel, numbered row by row in the tile.
        std::uint32_t samplesOf(std::size_t pixel) const {
            return plan.empty() ? samples : std::min(samples, plan[pixel]);
        }
    };
    // For engines that keep the film elsewhere and copy it. assign() replaces the state; an open block needs
    // reserveOpenBlocks().
    TileState state(std::uint32_t tile, std::uint32_t replicate) const;
    void assign(std::uint32_t tile, std::uint32_t replicate, const TileState& state);

    // Mean radiance: sum over all replicates / true count; pixels without samples are black. Where there is a plan, the
    // mean of the means of both halves, see SamplePlan.h.
    Image resolve() const;
    // Variance of each pixel's mean, per channel. With two or more replicates it is taken across them, with a plan in
    // halves that have two or more, and unbiased for every sampler; with one it is taken across blocks: unbiased for
    // independent samples, too large by factors for Sobol's and strata, which spread blocks evenly. Where fewer than
    // two replicates or blocks have samples it is 0. Requires secondMoments or replicates >= 2.
    Image varianceOfMean() const;
    Image sampleCounts() const; // one channel

    // Raw state for checkpoints, little-endian: written and read back bit for bit. readState throws InputError, naming
    // `name`, on a truncated or damaged stream, and allocates nothing that the rest of the stream cannot fill.
    void writeState(std::ostream& out) const;
    static Film readState(const FilmDesc& desc, std::istream& in, const std::string& name);

    std::uint64_t bytes() const; // of memory held

  private:
    static constexpr std::size_t kTileValues = std::size_t{kTilePixels} * 3;
    static constexpr std::uint32_t kNowhere = ~0u;

    void allocateSlots();
    std::size_t slot(std::uint32_t tile, std::uint32_t replicate) const {
        return std::size_t{isPart() ? places_[tile] : tile} * desc_.replicates + replicate;
    }
    std::size_t slotCount() const { return std::size_t{tilesHeld_} * desc_.replicates; }
    std::span<const float> openBlock(std::size_t slot) const; // empty unless the slot has an unfilled block
    void setEnds();

    FilmDesc desc_;
    std::uint32_t tilesHeld_ = 0;
    std::vector<std::uint32_t> places_;  // of a part, per tile of the image: its position among those held, or kNowhere
    std::vector<std::uint32_t> samples_; // per slot; modulo kBlock it is the size of the slot's open block
    std::vector<double> sums_;           // kTileValues per slot: all closed blocks
    std::vector<double> squares_;        // kTileValues per slot, see TileState
    std::vector<float> open_;            // kTileValues per slot: the open block; empty until reserved
    std::vector<std::uint32_t> plan_;    // kTilePixels per slot; empty without a plan
    std::vector<std::uint32_t> ends_;    // per slot: the largest of these
};

} // namespace rt::image
