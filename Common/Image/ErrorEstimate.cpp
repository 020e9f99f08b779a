#include "Common/Image/ErrorEstimate.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "Common/Core/Parallel.h"
#include "Common/Image/Metrics.h"

namespace rt::image {
namespace {

constexpr std::size_t kReach = 2;      // pixels to each side of the one in the middle of a window
constexpr std::size_t kChunkRows = 16; // that a thread takes at a time
constexpr double kNormal95 = 1.959964;
constexpr double kSystematic = 0.05; // of the value

// Sums over the pixels of a window, of one channel.
struct Window {
    double means = 0;
    double squares = 0; // of the means
    double variances = 0;
    double pixels = 0;
    double dependentMeans = 0; // of the pixel in the middle, and those of the window that depend on it
    double dependentPixels = 0;
};

// What a value adds to relMSE, by the formulas of the header.
double relativeError(double mean, double variance, const Window& window) {
    if (!(variance > 0)) return 0;
    const double n = window.pixels, others = n - window.dependentPixels;
    const double spread = (window.squares - window.means * window.means / n) / std::max(n - 1, 1.0);
    const double signal = std::max(spread - window.variances / n, 0.0);
    const double trust = others > 0 ? signal / (signal + variance) : 1;
    const double around = (window.means - window.dependentMeans) / std::max(others, 1.0);
    const double ownSquare = std::max(mean * mean - variance, variance);
    const double aroundSquare = around * around + variance / (n * n);
    const double expectedSquare = trust * trust * ownSquare + (1 - trust) * (1 - trust) * aroundSquare +
                                  2 * trust * (1 - trust) * std::sqrt(ownSquare * aroundSquare);
    return variance / (expectedSquare + kRelativeFloor);
}

// The pixels from 0 to size - 1 that a window around `at` covers.
struct Span {
    std::size_t first, last;
    Span(std::size_t at, std::size_t size)
        : first(at < kReach ? 0 : at - kReach), last(std::min(at + kReach, size - 1)) {}
    double count() const { return static_cast<double>(last - first + 1); }
};

// The pixels from 0 to size - 1 of the square that `at` is in.
struct Square {
    std::size_t begin, end;
    Square(std::size_t at, std::size_t side, std::size_t size)
        : begin(at / side * side), end(std::min(begin + side, size)) {}
};

// The rows of an image that the windows of one row cover, each read once.
class SlidingRows {
  public:
    SlidingRows(const ImageRows& image, std::size_t first)
        : image_(image), values_(kRows * image.rowValues()), next_(first) {}

    void readUpTo(std::size_t last) {
        for (; next_ <= last; ++next_) image_.read(static_cast<std::uint32_t>(next_), row(next_));
    }
    std::span<float> row(std::size_t y) {
        return std::span(values_).subspan(y % kRows * image_.rowValues(), image_.rowValues());
    }

  private:
    static constexpr std::size_t kRows = 2 * kReach + 1;

    const ImageRows& image_;
    std::vector<float> values_;
    std::size_t next_; // that has not been read
};

// The windows around the values of one row of pixels. Every row is summed anew: what is added and subtracted again
// would leave the rounding error of a firefly in all rows below it.
class RowOfWindows {
  public:
    // `row`: the first that it is moved to.
    RowOfWindows(const ImageRows& mean, const ImageRows& variance, std::size_t dependentSide, std::size_t row)
        : dependentSide_(dependentSide),
          width_(mean.width),
          height_(mean.height),
          channels_(mean.channels),
          mean_(mean, Span(row, mean.height).first),
          variance_(variance, Span(row, mean.height).first),
          margin_(kReach * mean.channels),
          means_(mean.rowValues() + 2 * margin_),
          squares_(means_.size()),
          variances_(means_.size()) {}

    // From each row to the one below.
    void moveTo(std::size_t row) {
        for (std::vector<double>* sums : {&means_, &squares_, &variances_}) std::fill(sums->begin(), sums->end(), 0.0);
        row_ = row;
        rows_ = Span(row, height_);
        mean_.readUpTo(rows_.last);
        variance_.readUpTo(rows_.last);
        for (std::size_t y = rows_.first; y <= rows_.last; ++y) {
            const std::span<const float> means = mean_.row(y), variances = variance_.row(y);
            for (std::size_t i = 0; i < means.size(); ++i) {
                const double mean = means[i];
                means_[margin_ + i] += mean;
                squares_[margin_ + i] += mean * mean;
                variances_[margin_ + i] += variances[i];
            }
        }
    }

    // What the value of the row's pixel x adds to relMSE.
    double error(std::size_t x, std::size_t channel) {
        const std::size_t value = x * channels_ + channel;
        return relativeError(mean_.row(row_)[value], variance_.row(row_)[value], window(x, channel));
    }

  private:
    Window window(std::size_t x, std::size_t channel) {
        const std::size_t left = x * channels_ + channel; // the margin shifts it from the middle
        const auto across = [&](const std::vector<double>& sums) {
            double sum = 0;
            for (std::size_t i = 0; i <= 2 * kReach; ++i) sum += sums[left + i * channels_];
            return sum;
        };
        Window window{across(means_), across(squares_), across(variances_), rows_.count() * Span(x, width_).count()};
        const Square rows(row_, dependentSide_, height_), columns(x, dependentSide_, width_);
        for (std::size_t y = rows.begin; y < rows.end; ++y)
            for (std::size_t i = columns.begin; i < columns.end; ++i)
                window.dependentMeans += mean_.row(y)[i * channels_ + channel];
        window.dependentPixels = static_cast<double>((rows.end - rows.begin) * (columns.end - columns.begin));
        return window;
    }

    std::size_t dependentSide_;
    std::size_t width_, height_, channels_;
    SlidingRows mean_, variance_;
    std::size_t margin_; // empty values at either end of the sums
    std::size_t row_ = 0;
    Span rows_{0, 1};
    std::vector<double> means_, squares_, variances_; // over the rows of the windows, as in Window
};

} // namespace

double RelMseEstimate::low() const {
    return std::max(value - kNormal95 * standardError, 0.0);
}

double RelMseEstimate::high() const {
    return value + kNormal95 * standardError;
}

// The rows are read one after the other within a chunk; in the same order for any number of threads.
RelMseEstimate estimateRelMse(const ImageRows& mean, const ImageRows& variance, std::uint32_t dependentSide) {
    struct Sums {
        double errors = 0, squares = 0; // of pixels
    };
    const Chunks chunks(mean.height, kChunkRows);
    std::vector<Sums> parts(chunks.count);
    parallelFor(0, chunks.count, [&](std::size_t chunk) {
        RowOfWindows row(mean, variance, dependentSide, chunks.begin(chunk));
        Sums sums;
        for (std::size_t y = chunks.begin(chunk); y < chunks.end(chunk); ++y) {
            row.moveTo(y);
            for (std::uint32_t x = 0; x < mean.width; ++x) {
                double pixel = 0;
                for (std::uint32_t c = 0; c < mean.channels; ++c) pixel += row.error(x, c);
                sums.errors += pixel;
                sums.squares += pixel * pixel;
            }
        }
        parts[chunk] = sums;
    });
    Sums sums;
    for (const Sums& part : parts) {
        sums.errors += part.errors;
        sums.squares += part.squares;
    }
    const double values = static_cast<double>(mean.rowValues()) * mean.height;
    const double ofEvents = dependentSide * std::sqrt(sums.squares);
    return {sums.errors / values, std::hypot(ofEvents, kSystematic * sums.errors) / values};
}

} // namespace rt::image
