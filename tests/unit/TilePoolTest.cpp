// How tiles are shared out, in a simulation: ranks take the time that their speed says.
#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "Common/App/Ranks/TilePool.h"

namespace rt::app {
namespace {

using image::Film;

constexpr std::uint32_t kTilesX = 60, kTilesY = 34;
constexpr std::uint32_t kMin = 8; // tiles of a lease
constexpr double kNever = std::numeric_limits<double>::infinity();

class Simulation {
  public:
    // Samples a second of each rank, at a time since the start.
    using Speed = std::function<double(std::size_t rank, double now)>;

    Simulation(std::size_t ranks, std::uint32_t spp, bool evenly, Speed speed)
        : spp_(spp),
          speed_(std::move(speed)),
          busy_(ranks),
          pool_(film_, {image::allTiles(film_), spp, evenly}, ranks) {}

    // Seconds until all is done; kNever: it takes for ever.
    double run(const std::function<void()>& afterEach = {}) {
        double now = 0;
        while (!pool_.isDone()) {
            for (std::size_t rank = 0; rank < busy_.size(); ++rank)
                if (!pool_.isLeased(rank)) give(rank, now);
            for (std::size_t rank = 0; rank < busy_.size(); ++rank) give(rank, now); // ahead
            const auto next = std::min_element(busy_.begin(), busy_.end(),
                                               [](const Busy& a, const Busy& b) { return a.until < b.until; });
            if (now > 1e4) return kNever;
            now = std::min(next->until, now + 0.01); // who waits asks again
            if (next->until > now) continue;
            finish(static_cast<std::size_t>(next - busy_.begin()), now);
            if (afterEach) afterEach();
        }
        return now;
    }
    double work() const { return 1.0 * film_.tileCount() * Film::kTilePixels * spp_; }
    const Film& film() const { return film_; }

  private:
    struct Busy {
        std::deque<Lease> leases; // it works at the first
        double since = 0, until = kNever;
    };

    void give(std::size_t rank, double now) {
        Busy& busy = busy_[rank];
        const auto lease = pool_.lease(rank, kMin, now);
        if (!lease) return;
        if (const auto recalled = pool_.recalled()) takeBack(*recalled, now);
        busy.leases.push_back(*lease);
        if (busy.leases.size() == 1) begin(rank, now);
    }

    void takeBack(const Recalled& recalled, double now) {
        std::deque<Lease>& leases = busy_[recalled.rank].leases;
        ASSERT_EQ(leases.size(), 2u);
        ASSERT_EQ(leases.back().id, recalled.id);
        leases.pop_back();
        pool_.giveBack(recalled.rank, recalled.id, 0, 0, now);
    }

    void begin(std::size_t rank, double now) {
        Busy& busy = busy_[rank];
        busy.since = now;
        busy.until = kNever;
        if (busy.leases.empty()) return;
        const Lease& lease = busy.leases.front();
        double samples = 0;
        for (const std::uint32_t tile : lease.tiles)
            samples += std::max(0.0, 1.0 * lease.spp - static_cast<double>(film_.samples(tile)));
        const double seconds = samples * Film::kTilePixels / speed_(rank, now);
        if (seconds < kNever) busy.until = now + std::min(seconds, lease.seconds);
    }

    // What fits into the time of the lease, in whole blocks, of all of its tiles.
    void finish(std::size_t rank, double now) {
        Busy& busy = busy_[rank];
        const Lease lease = busy.leases.front();
        busy.leases.pop_front();
        const double perTile =
            speed_(rank, busy.since) * (now - busy.since) / Film::kTilePixels / static_cast<double>(lease.tiles.size());
        std::uint64_t made = 0;
        for (const std::uint32_t tile : lease.tiles) {
            const auto before = static_cast<std::uint32_t>(film_.samples(tile));
            const double reached = before + perTile * (1 + 1e-9);
            std::uint32_t samples = lease.spp;
            if (reached < samples) samples = static_cast<std::uint32_t>(reached) / Film::kBlock * Film::kBlock;
            if (samples <= before) continue;
            film_.assign(tile, 0, {samples, sums_, {}, {}});
            made += std::uint64_t{samples - before} * Film::kTilePixels;
        }
        pool_.giveBack(rank, lease.id, made, now - busy.since, now);
        begin(rank, now);
    }

    std::uint32_t spp_;
    Speed speed_;
    std::vector<double> sums_ = std::vector<double>(Film::kTilePixels * 3);
    Film film_{{kTilesX * Film::kTile, kTilesY* Film::kTile, 1, false}};
    std::vector<Busy> busy_;
    TilePool pool_;
};

TEST(TilePool, RanksOfOneSpeedEndTogether) {
    for (const std::size_t ranks : {1u, 2u, 3u, 5u, 16u}) {
        Simulation simulation(ranks, 64, false, [](std::size_t, double) { return 1e6; });
        const double ideal = simulation.work() / (1e6 * static_cast<double>(ranks));
        const double smallest = kMin * Film::kTilePixels * 64 / 1e6; // seconds, of a lease
        EXPECT_LE(simulation.run(), 1.01 * ideal + smallest) << ranks;
        EXPECT_EQ(simulation.film().minSamples(), 64u);
    }
}

TEST(TilePool, ASlowRankHoldsNobodyUp) {
    for (const double slowFrom : {0.0, 3.0, 6.0}) { // from the start, in the middle, near the end
        Simulation simulation(3, 256, false,
                              [=](std::size_t rank, double now) { return rank == 2 && now >= slowFrom ? 1e6 : 1e7; });
        const double before = std::min(simulation.work(), 3e7 * slowFrom);
        const double ideal = before / 3e7 + (simulation.work() - before) / 2.1e7;
        EXPECT_LE(simulation.run(), 1.2 * ideal) << slowFrom;
    }
}

TEST(TilePool, ARankThatNeverAnswersIsDoneWithout) {
    for (const std::size_t ranks : {2u, 4u}) {
        Simulation simulation(ranks, 64, false,
                              [=](std::size_t rank, double) { return rank + 1 == ranks ? 0.0 : 1e6; });
        EXPECT_LT(simulation.run(), kNever);
        EXPECT_EQ(simulation.film().minSamples(), 64u);
    }
}

// With a lease that it has not begun, and a copy of what another one that has stopped was to do.
TEST(TilePool, RanksThatWereFastAndStopAreDoneWithout) {
    for (const double first : {0.0, 0.2, 0.5, 0.9}) {
        for (const double second : {0.1, 0.4, 0.8, 1.2, 1.6, 2.0, 3.0, 5.0}) {
            Simulation simulation(3, 64, false, [=](std::size_t rank, double now) {
                if (rank == 0) return 1e6;
                return now < (rank == 1 ? first : second) ? 3e6 : 0.0;
            });
            EXPECT_LT(simulation.run(), kNever) << first << " " << second;
            EXPECT_EQ(simulation.film().minSamples(), 64u);
        }
    }
}

TEST(TilePool, RoundsKeepTheImageEven) {
    Simulation simulation(3, 1008, true,
                          [](std::size_t rank, double) { return 1e7 * (1.0 + static_cast<double>(rank)); });
    const auto check = [&] {
        const Film& film = simulation.film();
        std::uint64_t maximum = 0;
        for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile) maximum = std::max(maximum, film.samples(tile));
        EXPECT_LE(maximum, std::max<std::uint64_t>(Film::kBlock, 4 * film.minSamples())); // this round and the next
    };
    EXPECT_LT(simulation.run(check), kNever);
    EXPECT_EQ(simulation.film().minSamples(), 1008u);
}

// An adaptive film's pilot and what its plan adds, with a rank that keeps its tiles of the pilot for ever.
TEST(TilePool, GoesOnToAPlan) {
    constexpr std::uint32_t kPilot = 16; // samples of both halves
    Film film({32, 32, 2, false, true});
    film.reserveOpenBlocks();
    const image::TileList all = image::allTiles(film);
    const std::vector<double> sums(Film::kTilePixels * 3);
    const std::vector<float> open(Film::kTilePixels * 3);
    const auto render = [&](const Lease& lease) {
        for (const std::uint32_t tile : lease.tiles) {
            for (std::uint32_t r = 0; r < 2; ++r) {
                std::uint32_t end = lease.spp / 2;
                if (film.hasPlan()) end = std::min(end, film.planEnd(tile, r));
                film.assign(tile, r, {end, sums, film.hasPlan() ? std::span<const double>{} : sums, open});
            }
        }
        return static_cast<std::uint64_t>(lease.tiles.size());
    };
    TilePool pool(film, {all, kPilot, false}, 2);
    const auto stuck = pool.lease(0, 2, 0);
    ASSERT_TRUE(stuck);
    double now = 100; // when the other rank finds it overdue
    const auto work = [&] {
        while (!pool.isDone()) {
            const auto lease = pool.lease(1, 2, now);
            ASSERT_TRUE(lease);
            pool.giveBack(1, lease->id, render(*lease), 1, now);
        }
    };
    work();
    EXPECT_EQ(film.nextSample(kPilot), Film::kNoSample);

    std::vector<std::uint32_t> plan;
    for (const std::uint32_t tile : all) plan.insert(plan.end(), 2 * Film::kTilePixels, kPilot / 2 + tile % 3);
    film.setPlan(plan);
    pool.goOn({all, 2 * (kPilot / 2 + 2), false});
    EXPECT_FALSE(pool.isDone());
    EXPECT_TRUE(pool.isLeased(0)); // it gets no other before it answers
    work();
    for (const std::uint32_t tile : all) EXPECT_EQ(film.samples(tile, 1), kPilot / 2 + tile % 3) << tile;
    pool.giveBack(0, stuck->id, 0, 200, now);
    EXPECT_FALSE(pool.lease(0, 2, now));
    EXPECT_TRUE(pool.isDone());
}

// Recalls, as for checkpoints, interrupt who does the work of a rank that hangs.
TEST(TilePool, CopiesThatComeBackUnfinishedAreMadeAnew) {
    Film film({32, 32, 1, false});
    TilePool pool(film, {image::allTiles(film), 64, false}, 2);
    const std::vector<double> sums(Film::kTilePixels * 3);
    ASSERT_TRUE(pool.lease(0, 4, 0)); // and never comes back
    for (int recalls = 0; !pool.isDone(); ++recalls) {
        ASSERT_LT(recalls, 1000);
        const auto lease = pool.lease(1, 4, 100);
        ASSERT_TRUE(lease);
        const std::uint32_t tile = lease->tiles[static_cast<std::size_t>(recalls) % lease->tiles.size()];
        const std::uint32_t samples = film.samples(tile, 0) + (film.samples(tile, 0) < lease->spp ? Film::kBlock : 0);
        film.assign(tile, 0, {samples, sums, {}, {}});
        pool.giveBack(1, lease->id, Film::kBlock * Film::kTilePixels, 0.2, 100);
    }
    EXPECT_EQ(film.minSamples(), 64u);
}

TEST(TilePool, LeasesDoNotOverlap) {
    const Film film({kTilesX * Film::kTile, kTilesY * Film::kTile, 1, false});
    TilePool pool(film, {image::allTiles(film), 16, false}, 3);
    std::set<std::uint32_t> seen;
    for (std::size_t rank = 0; rank < 3; ++rank) {
        const auto lease = pool.lease(rank, kMin, 0);
        ASSERT_TRUE(lease);
        for (const std::uint32_t tile : lease->tiles) EXPECT_TRUE(seen.insert(tile).second) << tile;
    }
}

} // namespace
} // namespace rt::app
