#include "Common/Image/FilmRows.h"

#include <algorithm>
#include <stdexcept>

namespace rt::image {

namespace {

using Pixels = std::span<float>;

// Calls visit(tile, index in the tile of the first of these pixels, their values) for every tile that the row crosses.
template <class Visit>
void forEachTile(const Film& film, std::uint32_t y, Pixels row, Visit visit) {
    const std::uint32_t width = film.desc().width;
    const std::size_t channels = row.size() / width;
    const std::uint32_t firstTile = y / Film::kTile * film.tilesX();
    const std::size_t firstPixel = std::size_t{y % Film::kTile} * Film::kTile;
    for (std::uint32_t x = 0; x < width; x += Film::kTile) {
        const std::size_t count = std::min(Film::kTile, width - x);
        visit(firstTile + x / Film::kTile, firstPixel, row.subspan(x * channels, count * channels));
    }
}

// Rows of which each tile's pixels are found by visit() of forEachTile().
template <class Visit>
ImageRows rowsOf(const Film& film, std::uint32_t channels, const Visit& visit) {
    return {film.desc().width, film.desc().height, channels,
            [&film, visit](std::uint32_t y, Pixels row) { forEachTile(film, y, row, visit); }};
}

// A value's sum over the samples of the open block; 0 when there is none.
double openSum(const Film::TileState& state, std::size_t value) {
    return state.open.empty() ? 0.0 : double{state.open[value]};
}

// Groups g of n_g samples with sum s_g, N samples in all; the groups' means m_g are independent, of variance sigma^2 /
// n_g. The estimate of the variance of the overall mean m is sum n_g (m_g - m)^2 / (groups - 1) / N.
struct Groups {
    double count = 0;        // of groups
    double sumOfSquares = 0; // sum s_g^2 / n_g = sum n_g m_g^2
    double sum = 0;          // of all samples
    double samples = 0;      // N

    double varianceOfMean() const {
        if (count < 2) return 0;
        const double spread = sumOfSquares - sum * sum / samples;
        return std::max(spread, 0.0) / (count - 1) / samples;
    }
};

// Each replicate is a group.
void addReplicate(Groups& groups, const Film::TileState& state, std::size_t value) {
    const double samples = state.samplesOf(value / 3);
    if (samples == 0) return;
    const double sum = state.sums[value] + openSum(state, value);
    groups.count += 1;
    groups.sumOfSquares += sum * sum / samples;
    groups.sum += sum;
    groups.samples += samples;
}

// Of the mean of two halves' means. The numbers of samples in a half depend on the other half alone, so that within it
// they are weights like any; where each half is one group, the two means have to do.
double varianceOfHalves(const Groups& a, const Groups& b) {
    if (a.count >= 2 && b.count >= 2) return (a.varianceOfMean() + b.varianceOfMean()) / 4;
    if (a.count < 1 || b.count < 1) return 0;
    const double difference = a.sum / a.samples - b.sum / b.samples;
    return difference * difference / 4;
}

// Of one replicate, each block is a group, the open one included.
Groups blocksOf(const Film::TileState& state, std::size_t value) {
    const double samples = state.samples;
    const double inOpen = state.samples % Film::kBlock;
    const double open = openSum(state, value);
    return {(samples - inOpen) / Film::kBlock + (inOpen > 0 ? 1 : 0),
            state.squares[value] + (inOpen > 0 ? open * open / inOpen : 0), state.sums[value] + open, samples};
}

} // namespace

ImageRows meanRows(const Film& film) {
    return rowsOf(film, 3, [&film](std::uint32_t tile, std::size_t firstPixel, Pixels pixels) {
        const std::uint32_t parts = film.hasPlan() ? 2 : 1;
        double sums[2][Film::kTile * 3] = {}, counts[2][Film::kTile * 3] = {};
        for (std::uint32_t r = 0; r < film.desc().replicates; ++r) {
            const Film::TileState state = film.state(tile, r);
            const std::uint32_t part = Film::halfOf(r) % parts;
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const std::size_t value = firstPixel * 3 + i;
                sums[part][i] += state.sums[value] + openSum(state, value);
                counts[part][i] += state.samplesOf(value / 3);
            }
        }
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            double mean = 0;
            for (std::uint32_t part = 0; part < parts; ++part)
                if (counts[part][i] > 0) mean += sums[part][i] / counts[part][i];
            pixels[i] = static_cast<float>(mean / parts);
        }
    });
}

ImageRows halfRows(const Film& film, std::uint32_t half) {
    return rowsOf(film, 3, [&film, half](std::uint32_t tile, std::size_t firstPixel, Pixels pixels) {
        double sums[Film::kTile * 3] = {}, counts[Film::kTile * 3] = {};
        for (std::uint32_t r = half; r < film.desc().replicates; r += 2) {
            const Film::TileState state = film.state(tile, r);
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const std::size_t value = firstPixel * 3 + i;
                sums[i] += state.sums[value] + openSum(state, value);
                counts[i] += state.samplesOf(value / 3);
            }
        }
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = counts[i] > 0 ? static_cast<float>(sums[i] / counts[i]) : 0.0f;
    });
}

ImageRows varianceRows(const Film& film) {
    const std::uint32_t replicates = film.desc().replicates;
    if (replicates < 2 && !film.desc().secondMoments)
        throw std::logic_error("the variance needs second moments or two replicates");
    return rowsOf(film, 3, [&film, replicates](std::uint32_t tile, std::size_t firstPixel, Pixels pixels) {
        Groups groups[2][Film::kTile * 3]; // of each half; of all in the first without a plan
        for (std::uint32_t r = 0; r < replicates; ++r) {
            const Film::TileState state = film.state(tile, r);
            const std::uint32_t part = film.hasPlan() ? Film::halfOf(r) : 0;
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const std::size_t value = firstPixel * 3 + i;
                if (replicates > 1)
                    addReplicate(groups[part][i], state, value);
                else
                    groups[0][i] = blocksOf(state, value);
            }
        }
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = static_cast<float>(film.hasPlan() ? varianceOfHalves(groups[0][i], groups[1][i])
                                                          : groups[0][i].varianceOfMean());
    });
}

ImageRows sampleCountRows(const Film& film) {
    return rowsOf(film, 1, [&film](std::uint32_t tile, std::size_t firstPixel, Pixels pixels) {
        std::uint64_t counts[Film::kTile] = {};
        for (std::uint32_t r = 0; r < film.desc().replicates; ++r) {
            const Film::TileState state = film.state(tile, r);
            for (std::size_t i = 0; i < pixels.size(); ++i) counts[i] += state.samplesOf(firstPixel + i);
        }
        std::transform(counts, counts + pixels.size(), pixels.begin(),
                       [](std::uint64_t count) { return static_cast<float>(count); });
    });
}

} // namespace rt::image
