#include "Common/App/Ranks/TilePool.h"

#include <algorithm>
#include <limits>
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
    isDone_ = image::minSamples(film_, plan_.tiles) >= plan_.spp || plan_.tiles.empty();
}

// With the tiles of the next round that has any. Its length is that of whole blocks, for which no rank keeps an open
// one.
void TilePool::refill() {
    std::uint64_t fewest = std::numeric_limits<std::uint64_t>::max();
    for (const std::uint32_t tile : plan_.tiles)
        if (holders_[tile] == 0) fewest = std::min(fewest, film_.samples(tile));
    if (fewest >= plan_.spp) return;
    const std::uint64_t block = std::uint64_t{image::Film::kBlock} * film_.desc().replicates;
    std::uint64_t end = plan_.spp;
    if (plan_.evenly) {
        end = block;
        while (end <= fewest) end *= 2;
    }
    round_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(end, plan_.spp));
    for (const std::uint32_t tile : plan_.tiles)
        if (holders_[tile] == 0 && film_.samples(tile) < round_) waiting_.push_back(tile);
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
    holder.isCopied = false;
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
    constexpr double kTilePixels = image::Film::kTilePixels;
    const double tileSamples =
        kTilePixels *
        static_cast<double>(round_ - std::min<std::uint64_t>(film_.samples(waiting_.front()), round_ - 1));
    const double rate = ranks_[rank].rate, all = totalRate();
    double wanted = least; // until its rate is known, as few as possible
    if (rate > 0)
        wanted =
            std::max(std::min(kPart * rate / all * static_cast<double>(waiting_.size()), kLongest * rate / tileSamples),
                     std::min<double>(least, kLongestLeast * rate / tileSamples));
    const std::size_t most = std::min(waiting_.size(), std::max<std::size_t>(1, kMostSlots / film_.desc().replicates));
    const std::size_t count = std::clamp<std::size_t>(static_cast<std::size_t>(wanted), 1, most);
    const double expected = rate > 0 ? static_cast<double>(count) * tileSamples / rate : kLongest / kPatience;
    Lease lease{{}, round_, kPatience * expected + kLeastPatience};
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(count);
    lease.tiles.assign(waiting_.begin(), end);
    waiting_.erase(waiting_.begin(), end);
    std::sort(lease.tiles.begin(), lease.tiles.end());
    keep(rank, lease, now);
    return lease;
}

std::optional<Lease> TilePool::copyOverdue(double now) {
    Rank* latest = nullptr;
    double most = 0;
    for (Rank& rank : ranks_) {
        if (!rank.lease || rank.isCopied) continue;
        const double late = now - rank.since - rank.lease->seconds;
        if (late <= most) continue;
        most = late;
        latest = &rank;
    }
    if (latest == nullptr) return std::nullopt;
    latest->isCopied = true;
    Lease copy = *latest->lease;
    std::erase_if(copy.tiles, [&](std::uint32_t tile) { return film_.samples(tile) >= copy.spp; });
    if (copy.tiles.empty()) return std::nullopt;
    return copy;
}

void TilePool::giveBack(std::size_t rank, std::uint64_t samples, double busy) {
    Rank& holder = ranks_[rank];
    if (!holder.lease) return;
    if (samples > 0 && busy > 0) holder.rate = static_cast<double>(samples) / busy;
    for (const std::uint32_t tile : holder.lease->tiles) {
        --holders_[tile];
        if (holders_[tile] == 0 && film_.samples(tile) < round_) waiting_.push_front(tile);
    }
    holder.lease.reset();
    isDrained_ = false;
    isDone_ = waiting_.empty() && image::minSamples(film_, plan_.tiles) >= plan_.spp;
}

bool TilePool::isLeased() const {
    return std::any_of(ranks_.begin(), ranks_.end(), [](const Rank& rank) { return rank.lease.has_value(); });
}

} // namespace rt::app
