#include "Common/Image/Film.h"

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>

#include "Common/Core/Error.h"

namespace rt::image {

namespace {

[[noreturn]] void throwOutOfMemory(const FilmDesc& desc) {
    throw RenderError("not enough memory for an image of " + std::to_string(desc.width) + "x" +
                      std::to_string(desc.height) + " pixels with " + std::to_string(desc.replicates) +
                      " replicate(s)");
}

template <class T>
void allocate(std::vector<T>& values, std::size_t count, const FilmDesc& desc) {
    try {
        values.resize(count);
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

// Calls visit(tile, index of the pixel in the tile, pixel of the image) for every pixel that is inside of the image.
template <class Visit>
void forEachPixel(const Film& film, Image& image, Visit visit) {
    for (std::uint32_t y = 0; y < image.height; ++y) {
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const std::uint32_t tile = y / Film::kTile * film.tilesX() + x / Film::kTile;
            visit(tile, y % Film::kTile * Film::kTile + x % Film::kTile, image.pixel(x, y));
        }
    }
}

// A sum of samples and how many they are.
struct Sum {
    double value = 0;
    double count = 0;
};

// Groups g of n_g samples with sum s_g, N samples in all; the groups' means m_g are independent, of variance sigma^2 /
// n_g. Returns the estimate of the variance of the overall mean m, sum n_g (m_g - m)^2 / (groups - 1) / N, given
// sumOfSquares = sum s_g^2 / n_g = sum n_g m_g^2.
double varianceAcross(double groups, double sumOfSquares, const Sum& total) {
    if (groups < 2) return 0;
    const double spread = sumOfSquares - total.value * total.value / total.count;
    return std::max(spread, 0.0) / (groups - 1) / total.count;
}

} // namespace

Film::Film(const FilmDesc& desc) : desc_(desc) {
    checkSide("width", desc.width);
    checkSide("height", desc.height);
    if (desc.replicates < 1) throw UsageError("replicates 0 is less than 1");
    allocate(sums_, slotCount() * kTileValues, desc); // the largest first: what cannot be had is refused untouched
    allocate(samples_, slotCount(), desc);
    if (desc.secondMoments) allocate(squares_, slotCount() * kTileValues, desc);
}

std::uint64_t Film::samples(std::uint32_t tile) const {
    std::uint64_t total = 0;
    for (std::uint32_t r = 0; r < desc_.replicates; ++r) total += samples(tile, r);
    return total;
}

std::uint64_t Film::minSamples() const {
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (std::uint32_t tile = 0; tile < tileCount(); ++tile) least = std::min(least, samples(tile));
    return tileCount() == 0 ? 0 : least;
}

std::uint64_t Film::totalSamples() const {
    std::uint64_t total = 0;
    for (std::uint32_t tile = 0; tile < tileCount(); ++tile) {
        const std::uint64_t columns = std::min(kTile, desc_.width - tile % tilesX() * kTile);
        const std::uint64_t rows = std::min(kTile, desc_.height - tile / tilesX() * kTile);
        total += samples(tile) * columns * rows;
    }
    return total;
}

void Film::reserveOpenBlocks() {
    if (open_.empty()) allocate(open_, slotCount() * kTileValues, desc_);
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
    samples_[at] = closed + block.count;
}

Film::TileState Film::state(std::uint32_t tile, std::uint32_t replicate) const {
    const std::size_t at = slot(tile, replicate);
    TileState state{samples_[at], {&sums_[at * kTileValues], kTileValues}, {}, openBlock(at)};
    if (desc_.secondMoments) state.squares = {&squares_[at * kTileValues], kTileValues};
    return state;
}

void Film::assign(std::uint32_t tile, std::uint32_t replicate, const TileState& state) {
    const std::size_t at = slot(tile, replicate);
    if (!state.open.empty() && open_.empty())
        throw std::logic_error("an unfilled block needs Film::reserveOpenBlocks()");
    samples_[at] = state.samples;
    std::copy(state.sums.begin(), state.sums.end(), &sums_[at * kTileValues]);
    if (desc_.secondMoments) std::copy(state.squares.begin(), state.squares.end(), &squares_[at * kTileValues]);
    if (!state.open.empty()) std::copy(state.open.begin(), state.open.end(), &open_[at * kTileValues]);
}

Image Film::resolve() const {
    Image image(desc_.width, desc_.height);
    forEachPixel(*this, image, [&](std::uint32_t tile, std::size_t index, float* pixel) {
        const double count = static_cast<double>(samples(tile));
        for (std::size_t c = 0; c < 3 && count > 0; ++c) {
            double sum = 0;
            for (std::uint32_t r = 0; r < desc_.replicates; ++r) {
                const std::size_t at = slot(tile, r);
                const auto open = openBlock(at);
                sum += sums_[at * kTileValues + index * 3 + c] + (open.empty() ? 0.0 : double{open[index * 3 + c]});
            }
            pixel[c] = static_cast<float>(sum / count);
        }
    });
    return image;
}

Image Film::varianceOfMean() const {
    if (desc_.replicates < 2 && !desc_.secondMoments)
        throw std::logic_error("the variance needs second moments or two replicates");
    const auto variance = [this](std::uint32_t tile, std::size_t value) {
        Sum total;
        double groups = 0;
        double sumOfSquares = 0;
        for (std::uint32_t r = 0; r < desc_.replicates; ++r) {
            const std::size_t at = slot(tile, r);
            const double count = samples_[at];
            const double openCount = samples_[at] % kBlock;
            const double openSum = openCount > 0 ? double{openBlock(at)[value]} : 0.0;
            const double sum = sums_[at * kTileValues + value] + openSum;
            if (count == 0) continue;
            if (desc_.replicates > 1) {
                groups += 1;
                sumOfSquares += sum * sum / count;
            } else {
                groups = (count - openCount) / kBlock + (openCount > 0 ? 1 : 0);
                sumOfSquares = squares_[at * kTileValues + value] + (openCount > 0 ? openSum * openSum / openCount : 0);
            }
            total.value += sum;
            total.count += count;
        }
        return varianceAcross(groups, sumOfSquares, total);
    };
    Image image(desc_.width, desc_.height);
    forEachPixel(*this, image, [&](std::uint32_t tile, std::size_t index, float* pixel) {
        for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<float>(variance(tile, index * 3 + c));
    });
    return image;
}

Image Film::sampleCounts() const {
    Image image(desc_.width, desc_.height, 1);
    forEachPixel(*this, image,
                 [&](std::uint32_t tile, std::size_t, float* pixel) { *pixel = static_cast<float>(samples(tile)); });
    return image;
}

std::uint64_t Film::bytes() const {
    return samples_.capacity() * sizeof(samples_[0]) + sums_.capacity() * sizeof(sums_[0]) +
           squares_.capacity() * sizeof(squares_[0]) + open_.capacity() * sizeof(open_[0]);
}

} // namespace rt::image
