// Who renders which tiles: leases of tiles to ranks, so that all are busy to the end.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "Common/Image/FilmTiles.h"

namespace rt::app {

struct Lease {
    image::TileList tiles;
    std::uint32_t spp = 0; // samples per pixel to take them to
    double seconds = 0;    // of work, after which they are to be given back, done or not
    std::uint64_t id = 0;
};

// The lease's holder is to give it back.
struct Recalled {
    std::size_t rank = 0;
    std::uint64_t id = 0;
};

// What has to be done: these tiles, to `spp` samples per pixel, or where the film has a plan to what that gives of
// these. `evenly`: in rounds that double the samples, because a limit may end the render at any time.
struct TilePlan {
    image::TileList tiles;
    std::uint32_t spp = 0;
    bool evenly = false;
};

// Looks at the film, which must outlive it, for what is done. Times are seconds on any clock that all calls share.
class TilePool {
  public:
    TilePool(const image::Film& film, TilePlan plan, std::size_t ranks);

    // Begins another plan, when all is done. What ranks still hold is of no use any more, whenever they give it back.
    void goOn(TilePlan plan);

    // If there is anything for the rank to do, besides the lease that it works at: it holds two at most, so that it
    // need not wait for the next. Leases take a rank about as long as a fraction of what is left takes all ranks, so
    // that they shrink towards the end; of fewer than `least` tiles a rank does not make the best. When no tile is
    // left to be handed out, a rank without a lease gets one that another has not begun, which is then recalled(), or
    // the tiles of one that takes far longer than it was expected to.
    std::optional<Lease> lease(std::size_t rank, std::uint32_t minimum, double now);
    // What the last lease() has taken from another rank.
    const std::optional<Recalled>& recalled() const { return recalled_; }
    // The lease's tiles are on the film, as far as the rank got in `busy` seconds of work.
    void giveBack(std::size_t rank, std::uint64_t id, std::uint64_t samples, double busy, double now);
    // All that the rank holds.
    void giveUp(std::size_t rank, double now);

    bool isDone() const { return isDone_; } // every tile has its samples
    bool isLeased(std::size_t rank) const { return !ranks_[rank].leases.empty(); }

  private:
    struct Rank {
        std::deque<Lease> leases; // it works at the first; one that was taken from it has no tiles
        double since = 0;         // when it began that
        double rate = 0;          // samples a second; 0: not known yet
    };

    struct Waiting {
        std::uint32_t tile = 0;
        std::uint64_t samples = 0; // that it lacks of this round
    };

    void refill();
    enum class End { Front, Back };
    void enqueue(std::uint32_t tile, End end);
    std::uint32_t lengthOf(const image::TileList& tiles) const;
    void updateDone();
    double overdue(const Rank& rank, double now) const;
    std::optional<Lease> takeUnbegun(std::size_t rank, double now);
    std::optional<Lease> copyOverdue(double now) const;
    double expectedSeconds(const Rank& rank, const Lease& lease) const;
    void release(const image::TileList& tiles);
    void keep(std::size_t rank, Lease& lease, double now);
    double totalRate() const;

    const image::Film& film_;
    TilePlan plan_;
    std::vector<Rank> ranks_;
    std::vector<std::uint16_t> holders_; // of each tile of the film
    std::deque<Waiting> waiting_;        // nobody holds these tiles, and they lack samples of this round
    std::uint64_t waitingSamples_ = 0;   // of all of them
    std::uint32_t round_ = 0;            // leads to so many samples
    bool isDrained_ = false;             // no tile can be waiting before one is given back
    bool isDone_ = false;
    std::uint64_t leaseCount_ = 0; // so far
    std::optional<Recalled> recalled_;
};

} // namespace rt::app
