#include "Common/Image/Film.h"

#include <limits>
#include <new>
#include <stdexcept>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Image/FilmRows.h"
#include "Common/Image/FilmTiles.h"

namespace rt::image {

namespace {

[[noreturn]] void throwOutOfMemory(const FilmDesc& desc) {
    throw RenderError("not enough memory for an image of " + std::to_string(desc.width) + "x" +
                      std::to_string(desc.height) + " pixels with " + std::to_string(desc.replicates) +
                      " replicate(s)");
}

// In pieces, on all threads: a large film takes seconds, in which its user may want something else.
template <class T>
void resizeInPieces(std::vector<T>& values, std::size_t count) {
    constexpr std::size_t kPiece = (std::size_t{1} << 26) / sizeof(T); // 64 MiB
    reserveLarge(values, count);
    if (count > kPiece)
        parallelChunks(0, count, kPiece, [&](std::size_t begin, std::size_t end) {
            interruptionPoint();
            providePages(values.data() + begin, (end - begin) * sizeof(T));
        });
    while (values.size() < count) {
        if (!values.empty()) interruptionPoint();
        values.resize(std::min(count, values.size() + kPiece));
    }
}

template <class T>
void allocateFor(std::vector<T>& values, std::size_t count, const FilmDesc& desc) {
    try {
        resizeInPieces(values, count);
    } catch (const std::bad_alloc&) {
        throwOutOfMemory(desc);
    } catch (const std::length_error&) {
        throwOutOfMemory(desc);
    }
}

void checkSide(const char* what, std::uint32_t side) {
    if (side < 1 || side > kMaxImageSide)
        throw UsageError("image " + std::string(what) + " " + std::to_string(side) + " is not in 1 to " +
                         std::to_string(kMaxImageSide));
}

void check(const FilmDesc& desc) {
    checkSide("width", desc.width);
    checkSide("height", desc.height);
    if (desc.replicates < 1) throw UsageError("replicates 0 is less than 1");
    if (desc.adaptive && desc.replicates % 2 != 0) throw UsageError("an adaptive film's replicates are not even");
}

// All rows of a film, on all threads.
Image allRows(const ImageRows& rows) {
    constexpr std::size_t kRows = 16; // that a thread takes at a time
    Image image(rows.width, rows.height, rows.channels);
    parallelChunks(0, rows.height, kRows, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto y = static_cast<std::uint32_t>(i);
            rows.read(y, {image.pixel(0, y), rows.rowValues()});
        }
    });
    return image;
}

} // namespace

Film::Film(const FilmDesc& desc) : desc_(desc) {
    check(desc);
    tilesHeld_ = tileCount();
    allocateSlots();
}

Film Film::part(const FilmDesc& desc) {
    check(desc);
    Film film;
    film.desc_ = desc;
    film.places_.assign(film.tileCount(), kNowhere);
    return film;
}

void Film::hold(std::span<const std::uint32_t> tiles) {
    if (!isPart()) throw std::logic_error("the film is not a part of one");
    std::fill(places_.begin(), places_.end(), kNowhere);
    tilesHeld_ = 0;
    for (const std::uint32_t tile : tiles) places_.at(tile) = tilesHeld_++;
    samples_.clear();
    sums_.clear();
    squares_.clear();
    open_.clear();
    plan_.clear();
    ends_.clear();
    allocateSlots();
}

void Film::allocateSlots() {
    allocateFor(sums_, slotCount() * kTileValues, desc_); // the largest first: what cannot be had is refused untouched
    allocateFor(samples_, slotCount(), desc_);
    if (desc_.secondMoments || desc_.adaptive) allocateFor(squares_, slotCount() * kTileValues, desc_);
}

std::uint64_t Film::samples(std::uint32_t tile) const {
    std::uint64_t total = 0;
    for (std::uint32_t r = 0; r < desc_.replicates; ++r) total += samples(tile, r);
    return total;
}

std::uint64_t Film::minSamples() const {
    std::uint64_t minimum = std::numeric_limits<std::uint64_t>::max();
    for (std::uint32_t tile = 0; tile < tileCount(); ++tile) minimum = std::min(minimum, samples(tile));
    return tileCount() == 0 ? 0 : minimum;
}

std::uint64_t Film::maxSamples() const {
    std::uint64_t maximum = 0;
    for (std::uint32_t tile = 0; tile < tileCount(); ++tile) maximum = std::max(maximum, samples(tile));
    return maximum;
}

std::uint32_t Film::minReplicateSamples() const {
    return samples_.empty() ? 0 : *std::min_element(samples_.begin(), samples_.end());
}

std::uint64_t Film::totalSamples() const {
    std::uint64_t total = 0;
    for (std::uint32_t tile = 0; tile < tileCount(); ++tile) total += image::totalSamples(*this, {&tile, 1});
    return total;
}

std::uint64_t Film::samplesPerPixel() const {
    if (!hasPlan()) return minSamples();
    return totalSamples() / (std::uint64_t{desc_.width} * desc_.height);
}

std::uint64_t Film::nextSample(std::uint32_t tile, std::uint64_t spp) const {
    std::uint64_t minimum = kNoSample;
    for (std::uint32_t r = 0; r < desc_.replicates; ++r) {
        if (hasPlan() && samples(tile, r) >= planEnd(tile, r)) continue;
        const std::uint64_t next = std::uint64_t{samples(tile, r)} * desc_.replicates + r;
        if (next < spp) minimum = std::min(minimum, next);
    }
    return minimum;
}

std::uint64_t Film::nextSample(std::uint64_t spp) const {
    std::uint64_t minimum = kNoSample;
    for (std::uint32_t tile = 0; tile < tileCount(); ++tile) minimum = std::min(minimum, nextSample(tile, spp));
    return minimum;
}

void Film::setPlan(std::vector<std::uint32_t> plan) {
    if (!isPilot() || plan.size() != slotCount() * kTilePixels)
        throw std::logic_error("the plan is not one of this film");
    plan_ = std::move(plan);
    setEnds();
    squares_ = {};
}

void Film::assignPlan(std::uint32_t tile, std::uint32_t replicate, std::span<const std::uint32_t> plan) {
    if (!desc_.adaptive || plan.size() != kTilePixels) throw std::logic_error("the plan is not one of this film");
    if (!hasPlan()) {
        allocateFor(plan_, slotCount() * kTilePixels, desc_);
        allocateFor(ends_, slotCount(), desc_);
        squares_ = {};
    }
    const std::size_t at = slot(tile, replicate);
    std::copy(plan.begin(), plan.end(), plan_.begin() + static_cast<std::ptrdiff_t>(at * kTilePixels));
    ends_[at] = *std::max_element(plan.begin(), plan.end());
}

void Film::setEnds() {
    ends_.resize(slotCount());
    for (std::size_t at = 0; at < slotCount(); ++at) {
        const auto first = plan_.begin() + static_cast<std::ptrdiff_t>(at * kTilePixels);
        ends_[at] = *std::max_element(first, first + kTilePixels);
    }
}

std::span<const std::uint32_t> Film::plan(std::uint32_t tile, std::uint32_t replicate) const {
    if (!hasPlan()) return {};
    return {&plan_[slot(tile, replicate) * kTilePixels], kTilePixels};
}

void Film::reserveOpenBlocks() {
    if (open_.empty()) allocateFor(open_, slotCount() * kTileValues, desc_);
}

std::span<const float> Film::openBlock(std::size_t slot) const {
    if (samples_[slot] % kBlock == 0) return {};
    return {&open_[slot * kTileValues], kTileValues};
}

void Film::begin(std::uint32_t tile, std::uint32_t replicate, TileBlock& block) const {
    const std::size_t at = slot(tile, replicate);
    block.count = samples_[at] % kBlock;
    block.firstSample = samples_[at] - block.count;
    if (const auto open = openBlock(at); !open.empty())
        std::copy(open.begin(), open.end(), block.sum);
    else
        std::fill_n(block.sum, kTileValues, 0.0f);
    if (isPilot()) std::fill_n(block.squares, kTileValues, 0.0f);
}

void Film::commit(std::uint32_t tile, std::uint32_t replicate, const TileBlock& block) {
    const std::size_t at = slot(tile, replicate);
    const std::uint32_t closed = samples_[at] - samples_[at] % kBlock;
    if (block.firstSample != closed || block.count > kBlock || closed + block.count < samples_[at])
        throw std::logic_error("the block does not continue the tile's samples");
    if (block.count < kBlock) {
        if (open_.empty()) throw std::logic_error("an unfilled block needs Film::reserveOpenBlocks()");
        std::copy_n(block.sum, kTileValues, &open_[at * kTileValues]);
    } else {
        double* const sums = &sums_[at * kTileValues];
        for (std::size_t i = 0; i < kTileValues; ++i) sums[i] += double{block.sum[i]};
        if (desc_.secondMoments) {
            double* const squares = &squares_[at * kTileValues];
            for (std::size_t i = 0; i < kTileValues; ++i)
                squares[i] += double{block.sum[i]} * double{block.sum[i]} / kBlock;
        }
    }
    if (isPilot())
        for (std::size_t i = 0; i < kTileValues; ++i) squares_[at * kTileValues + i] += double{block.squares[i]};
    samples_[at] = closed + block.count;
}

Film::TileState Film::state(std::uint32_t tile, std::uint32_t replicate) const {
    const std::size_t at = slot(tile, replicate);
    TileState state{samples_[at], {&sums_[at * kTileValues], kTileValues}, {}, openBlock(at), plan(tile, replicate)};
    if (!squares_.empty()) state.squares = {&squares_[at * kTileValues], kTileValues};
    return state;
}

void Film::assign(std::uint32_t tile, std::uint32_t replicate, const TileState& state) {
    const std::size_t at = slot(tile, replicate);
    if (!state.open.empty() && open_.empty())
        throw std::logic_error("an unfilled block needs Film::reserveOpenBlocks()");
    samples_[at] = state.samples;
    std::copy(state.sums.begin(), state.sums.end(), &sums_[at * kTileValues]);
    if (!squares_.empty()) std::copy(state.squares.begin(), state.squares.end(), &squares_[at * kTileValues]);
    if (!state.open.empty()) std::copy(state.open.begin(), state.open.end(), &open_[at * kTileValues]);
}

Image Film::resolve() const {
    return allRows(meanRows(*this));
}

Image Film::varianceOfMean() const {
    return allRows(varianceRows(*this));
}

Image Film::sampleCounts() const {
    return allRows(sampleCountRows(*this));
}

std::uint64_t Film::bytes() const {
    return (places_.capacity() + samples_.capacity()) * sizeof(samples_[0]) + sums_.capacity() * sizeof(sums_[0]) +
           squares_.capacity() * sizeof(squares_[0]) + open_.capacity() * sizeof(open_[0]) +
           (plan_.capacity() + ends_.capacity()) * sizeof(plan_[0]);
}

} // namespace rt::image
