#include "Common/App/Ranks/TilePool.h"

#include <algorithm>
#include <utility>

namespace rt::app {
namespace {

constexpr double kPart = 0.5;                // of what is left for a rank when it asks, that it gets
constexpr double kLongest = 4;               // seconds, of a lease as expected: what is lost with a rank that dies
constexpr double kLongestLeast = 1;          // seconds, of the least number of tiles
constexpr double kPatience = 2;              // times as long as expected a lease may take, and
constexpr double kLeastPatience = 0.25;      // seconds more
constexpr std::size_t kMostSlots = 1u << 16; // of a lease: 100 MB, or 200 MB with second moments

} // namespace

TilePool::TilePool(const image::Film& film, TilePlan plan, std::size_t ranks)
    : film_(film), plan_(std::move(plan)), ranks_(ranks), holders_(film.tileCount(), 0) {
    refill();
    updateDone();
}

void TilePool::goOn(TilePlan plan) {
    plan_ = std::move(plan);
    for (Rank& rank : ranks_) {
        if (!rank.lease) continue;
        for (const std::uint32_t tile : rank.lease->tiles) --holders_[tile];
        rank.lease->tiles.clear();
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
    for (const std::uint32_t tile : plan_.tiles) enqueue(tile, End::Back);
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

void TilePool::keep(std::size_t rank, Lease lease, double now) {
    for (const std::uint32_t tile : lease.tiles) ++holders_[tile];
    Rank& holder = ranks_[rank];
    holder.since = now;
    holder.lease = std::move(lease);
}

std::optional<Lease> TilePool::lease(std::size_t rank, std::uint32_t least, double now) {
    if (waiting_.empty() && !isDrained_) refill();
    isDrained_ = waiting_.empty();
    if (isDrained_) {
        auto copy = copyOverdue(now);
        if (copy) keep(rank, *copy, now);
        return copy;
    }
    const double rate = ranks_[rank].rate;
    double wanted = 0, atLeast = 0; // samples; of `least` tiles no more than these
    if (rate > 0) {
        wanted = std::min(kPart * rate / totalRate() * static_cast<double>(waitingSamples_), kLongest * rate);
        atLeast = kLongestLeast * rate;
    }
    const std::size_t most = std::max<std::size_t>(1, kMostSlots / film_.desc().replicates);
    Lease lease{{}, 0, 0};
    double samples = 0;
    while (!waiting_.empty() && lease.tiles.size() < most) {
        const Waiting& next = waiting_.front();
        const double more = samples + static_cast<double>(next.samples);
        const bool isLeast = lease.tiles.size() < least && (rate <= 0 || more <= atLeast);
        if (!lease.tiles.empty() && !isLeast && more > wanted) break;
        samples = more;
        waitingSamples_ -= next.samples;
        lease.tiles.push_back(next.tile);
        waiting_.pop_front();
    }
    lease.spp = lengthOf(lease.tiles);
    const double expected = rate > 0 ? samples / rate : kLongest / kPatience;
    lease.seconds = kPatience * expected + kLeastPatience;
    std::sort(lease.tiles.begin(), lease.tiles.end());
    keep(rank, lease, now);
    return lease;
}

// Of the rank that is most overdue, the tiles that nobody else holds. A copy that comes back unfinished is made anew.
std::optional<Lease> TilePool::copyOverdue(double now) const {
    std::optional<Lease> copy;
    double most = 0;
    for (const Rank& rank : ranks_) {
        const double late = rank.lease ? now - rank.since - rank.lease->seconds : 0;
        if (late <= most) continue;
        Lease lease = *rank.lease;
        std::erase_if(lease.tiles, [&](std::uint32_t tile) {
            return holders_[tile] > 1 || film_.nextSample(tile, lease.spp) == image::Film::kNoSample;
        });
        if (lease.tiles.empty()) continue;
        most = late;
        copy = std::move(lease);
    }
    return copy;
}

void TilePool::giveBack(std::size_t rank, std::uint64_t samples, double busy) {
    Rank& holder = ranks_[rank];
    if (!holder.lease) return;
    if (samples > 0 && busy > 0) holder.rate = static_cast<double>(samples) / busy;
    for (const std::uint32_t tile : holder.lease->tiles) {
        --holders_[tile];
        enqueue(tile, End::Front);
    }
    holder.lease.reset();
    isDrained_ = false;
    updateDone();
}

} // namespace rt::app
