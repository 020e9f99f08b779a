#include "Common/App/Ranks/TilePool.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace rt::app {
namespace {

constexpr std::size_t kAhead = 2;           // leases that a rank holds at most
constexpr double kPart = 0.25;              // of what is left for a rank when it asks, that it gets
constexpr double kLongest = 4;              // seconds, of a lease as expected: what is lost with a rank that dies
constexpr double kLongestMin = 1;           // seconds, of the least number of tiles
constexpr double kPatience = 2;             // times as long as expected a lease may take, and
constexpr double kMinPatience = 0.25;       // seconds more
constexpr std::size_t kMaxSlots = 1u << 16; // of a lease: 100 MB, or 200 MB with second moments
constexpr std::size_t kRun = 16;            // tiles side by side

double patience(double expectedSeconds) {
    return kPatience * expectedSeconds + kMinPatience;
}
// What the lease was expected to take when it was made.
double expectedAtFirst(const Lease& lease) {
    return (lease.seconds - kMinPatience) / kPatience;
}

// Runs from all over the image, so that a lease costs what any other of its size costs.
image::TileList spread(const image::TileList& tiles) {
    const std::size_t runs = (tiles.size() + kRun - 1) / kRun;
    std::size_t step = std::max<std::size_t>(1, static_cast<std::size_t>(0.618 * static_cast<double>(runs)));
    while (std::gcd(step, runs) > 1) ++step;
    image::TileList order;
    order.reserve(tiles.size());
    for (std::size_t i = 0; i < runs; ++i) {
        const std::size_t first = i * step % runs * kRun;
        for (std::size_t k = first; k < std::min(first + kRun, tiles.size()); ++k) order.push_back(tiles[k]);
    }
    return order;
}

} // namespace

TilePool::TilePool(const image::Film& film, TilePlan plan, std::size_t ranks)
    : film_(film), plan_(std::move(plan)), ranks_(ranks), holders_(film.tileCount(), 0) {
    refill();
    updateDone();
}

void TilePool::goOn(TilePlan plan) {
    plan_ = std::move(plan);
    for (Rank& rank : ranks_) {
        for (Lease& lease : rank.leases) {
            release(lease.tiles);
            lease.tiles.clear();
        }
    }
    isDrained_ = false;
    refill();
    updateDone();
}

void TilePool::updateDone() {
    isDone_ = waiting_.empty() && image::nextSample(film_, plan_.tiles, plan_.spp) == image::Film::kNoSample;
}

// If nobody holds it and it lacks samples of this round.
void TilePool::enqueue(std::uint32_t tile, End end) {
    const std::uint64_t samples = holders_[tile] > 0 ? 0 : image::missingSamples(film_, {&tile, 1}, round_);
    if (samples == 0) return;
    waiting_.insert(end == End::Front ? waiting_.begin() : waiting_.end(), {tile, samples});
    waitingSamples_ += samples;
}

// Samples per pixel that a lease of these tiles leads to.
std::uint32_t TilePool::lengthOf(const image::TileList& tiles) const {
    if (!film_.hasPlan()) return round_;
    std::uint32_t end = 0;
    for (const std::uint32_t tile : tiles)
        for (std::uint32_t r = 0; r < film_.desc().replicates; ++r) end = std::max(end, film_.planEnd(tile, r));
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(round_, std::uint64_t{end} * film_.desc().replicates));
}

// With the tiles of the next round that has any. Its length is that of whole blocks, for which no rank keeps an open
// one.
void TilePool::refill() {
    std::uint64_t fewest = image::Film::kNoSample;
    for (const std::uint32_t tile : plan_.tiles)
        if (holders_[tile] == 0) fewest = std::min(fewest, film_.nextSample(tile, plan_.spp));
    if (fewest == image::Film::kNoSample) return;
    const std::uint64_t block = std::uint64_t{image::Film::kBlock} * film_.desc().replicates;
    std::uint64_t end = plan_.spp;
    if (plan_.evenly) {
        end = block;
        while (end <= fewest) end *= 2;
    }
    round_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(end, plan_.spp));
    for (const std::uint32_t tile : spread(plan_.tiles)) enqueue(tile, End::Back);
}

double TilePool::totalRate() const {
    double known = 0;
    std::size_t count = 0;
    for (const Rank& rank : ranks_) {
        if (rank.rate <= 0) continue;
        known += rank.rate;
        ++count;
    }
    return count == 0 ? 0 : known / static_cast<double>(count) * static_cast<double>(ranks_.size());
}

void TilePool::keep(std::size_t rank, Lease& lease, double now) {
    lease.id = ++leaseCount_;
    for (const std::uint32_t tile : lease.tiles) ++holders_[tile];
    Rank& holder = ranks_[rank];
    if (holder.leases.empty()) holder.since = now;
    holder.leases.push_back(lease);
}

void TilePool::release(const image::TileList& tiles) {
    for (const std::uint32_t tile : tiles) --holders_[tile];
}

std::optional<Lease> TilePool::lease(std::size_t rank, std::uint32_t minimum, double now) {
    recalled_.reset();
    const std::size_t held = ranks_[rank].leases.size();
    if (held >= kAhead) return std::nullopt;
    // The next round begins when others do not hold this one back.
    if (waiting_.empty() && held == 0) {
        if (auto taken = takeUnbegun(rank, now)) {
            keep(rank, *taken, now);
            return taken;
        }
    }
    if (waiting_.empty() && !isDrained_) refill();
    isDrained_ = waiting_.empty();
    if (isDrained_) {
        auto copy = held == 0 ? copyOverdue(now) : std::nullopt;
        if (copy) keep(rank, *copy, now);
        return copy;
    }
    const double rate = ranks_[rank].rate;
    double wanted = 0, atLeast = 0; // samples; of `least` tiles no more than these
    if (rate > 0) {
        wanted = std::min(kPart * rate / totalRate() * static_cast<double>(waitingSamples_), kLongest * rate);
        atLeast = kLongestMin * rate;
    }
    const std::size_t maximum = std::max<std::size_t>(1, kMaxSlots / film_.desc().replicates);
    Lease lease;
    double samples = 0;
    while (!waiting_.empty() && lease.tiles.size() < maximum) {
        const Waiting& next = waiting_.front();
        const double more = samples + static_cast<double>(next.samples);
        const bool isMin = lease.tiles.size() < minimum && (rate <= 0 || more <= atLeast);
        if (!lease.tiles.empty() && !isMin && more > wanted) break;
        samples = more;
        waitingSamples_ -= next.samples;
        lease.tiles.push_back(next.tile);
        waiting_.pop_front();
    }
    lease.spp = lengthOf(lease.tiles);
    lease.seconds = patience(rate > 0 ? samples / rate : kLongest / kPatience);
    std::sort(lease.tiles.begin(), lease.tiles.end());
    keep(rank, lease, now);
    return lease;
}

double TilePool::expectedSeconds(const Rank& rank, const Lease& lease) const {
    if (rank.rate <= 0) return expectedAtFirst(lease);
    return static_cast<double>(image::missingSamples(film_, lease.tiles, lease.spp)) / rank.rate;
}

// Seconds that the rank takes longer for what it works at than it may.
double TilePool::overdue(const Rank& rank, double now) const {
    return rank.leases.empty() ? 0 : std::max(0.0, now - rank.since - rank.leases.front().seconds);
}

// Of the rank that would begin it last, if `rank`, which has nothing to do, is expected to be done with it before.
// What has taken longer than expected is expected to take as long again, so that a rank that has stopped, however fast
// it was, keeps nothing.
std::optional<Lease> TilePool::takeUnbegun(std::size_t rank, double now) {
    std::optional<Lease> taken;
    double latest = 0; // seconds from now
    for (std::size_t from = 0; from < ranks_.size(); ++from) {
        const Rank& holder = ranks_[from];
        if (holder.leases.size() < 2 || holder.leases.back().tiles.empty()) continue;
        const Lease& last = holder.leases.back();
        const double begin = std::abs(holder.since + expectedAtFirst(holder.leases.front()) - now);
        const bool isFaster = expectedSeconds(ranks_[rank], last) < begin + expectedSeconds(holder, last);
        if (!isFaster || begin < latest) continue;
        latest = begin;
        taken = last;
        recalled_ = Recalled{from, last.id};
    }
    if (!taken) return taken;
    Lease& left = ranks_[recalled_->rank].leases.back();
    release(left.tiles);
    left.tiles.clear();
    taken->seconds = patience(expectedSeconds(ranks_[rank], *taken));
    return taken;
}

// Of the rank that is most overdue, the tiles that only such ranks hold. A copy that comes back unfinished is made
// anew.
std::optional<Lease> TilePool::copyOverdue(double now) const {
    std::optional<Lease> copy;
    const auto isOverdue = [&](const Rank& rank) { return overdue(rank, now) > 0; };
    if (std::none_of(ranks_.begin(), ranks_.end(), isOverdue)) return copy;
    std::vector<bool> isExpected(holders_.size(), false); // of a rank that is not overdue
    for (const Rank& rank : ranks_) {
        if (isOverdue(rank)) continue;
        for (const Lease& lease : rank.leases)
            for (const std::uint32_t tile : lease.tiles) isExpected[tile] = true;
    }
    double maximum = 0;
    for (const Rank& rank : ranks_) {
        const double late = overdue(rank, now);
        if (late <= maximum) continue;
        Lease lease = rank.leases.front();
        std::erase_if(lease.tiles, [&](std::uint32_t tile) {
            return isExpected[tile] || film_.nextSample(tile, lease.spp) == image::Film::kNoSample;
        });
        if (lease.tiles.empty()) continue;
        maximum = late;
        copy = std::move(lease);
    }
    return copy;
}

void TilePool::giveBack(std::size_t rank, std::uint64_t id, std::uint64_t samples, double busy, double now) {
    Rank& holder = ranks_[rank];
    const auto isIt = [id](const Lease& lease) { return lease.id == id; };
    const auto found = std::find_if(holder.leases.begin(), holder.leases.end(), isIt);
    if (found == holder.leases.end()) return;
    if (samples > 0 && busy > 0) holder.rate = static_cast<double>(samples) / busy;
    if (found == holder.leases.begin()) holder.since = now;
    const image::TileList tiles = std::move(found->tiles);
    holder.leases.erase(found);
    release(tiles);
    for (const std::uint32_t tile : tiles) enqueue(tile, End::Front);
    isDrained_ = false;
    updateDone();
}

void TilePool::giveUp(std::size_t rank, double now) {
    while (isLeased(rank)) giveBack(rank, ranks_[rank].leases.back().id, 0, 0, now);
}

} // namespace rt::app
