#include "Common/Image/Denoise/DenoiseFilter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "Common/Core/Interruption.h"
#include "Common/Core/KernelSets.h"
#include "Common/Core/Parallel.h"
#include "Common/Image/Denoise/DenoiseKernel.h"
#include "Common/Image/Denoise/FeatureSpace.h"

namespace rt::image {
namespace {

using shared::kDenoiseBandwidths;

// The best that this processor runs, of those that the program was built with.
DenoiseKernels bestKernels() {
    const InstructionSet best = bestInstructionSet();
#define RT_TAKE(set, suffix) \
    if (best >= InstructionSet::set) return denoiseKernels_##suffix();
    RT_KERNEL_SETS(RT_TAKE)
#undef RT_TAKE
    failWithoutKernels(best);
}

// ---- features ------------------------------------------------------------------------------------------------------

// Of the surfaces in sight of an input, scaled.
class Surfaces {
  public:
    explicit Surfaces(const DenoiseInput& input) : input_(input), depthUnit_(usualDepth(input.depth)) {}

    SurfaceFeatures at(std::uint32_t x, std::uint32_t y) const {
        SurfaceFeatures features{};
        for (std::size_t c = 0; c < 3; ++c) {
            if (!input_.albedo.data.empty()) features[c] = shared::denoiseAlbedo(input_.albedo.pixel(x, y)[c]);
            if (!input_.normal.data.empty()) features[3 + c] = shared::denoiseNormal(input_.normal.pixel(x, y)[c]);
        }
        if (!input_.depth.data.empty()) features[6] = shared::denoiseDepth(*input_.depth.pixel(x, y), depthUnit_);
        return features;
    }

  private:
    const DenoiseInput& input_;
    float depthUnit_;
};

// The features of a row of pixels that say which are of one surface, one after the other: normal and depth.
struct ShapeRow {
    static constexpr std::size_t kFirst = 3, kCount = shared::kDenoiseSurfaceValues - kFirst;
    std::array<std::vector<float>, kCount> values;

    void load(const Surfaces& surfaces, std::size_t width, std::size_t y) {
        for (std::vector<float>& value : values) value.resize(width);
        for (std::size_t x = 0; x < width; ++x) {
            const SurfaceFeatures features = surfaces.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
            for (std::size_t i = 0; i < kCount; ++i) values[i][x] = features[kFirst + i];
        }
    }
};

// Of `count` pixels from `first` on in one row, and as many from `second` on in another.
void compareShapes(const ShapeRow& a, std::size_t first, const ShapeRow& b, std::size_t second, std::size_t count,
                   float* __restrict likeness) {
    std::fill_n(likeness, count, 0.0f);
    for (std::size_t i = 0; i < ShapeRow::kCount; ++i) {
        const float *here = a.values[i].data() + first, *there = b.values[i].data() + second;
        for (std::size_t x = 0; x < count; ++x) likeness[x] += (here[x] - there[x]) * (here[x] - there[x]);
    }
    for (std::size_t x = 0; x < count; ++x) likeness[x] = shared::denoiseLikeness(likeness[x]);
}

void compareShapes(Halves& halves, const Surfaces& surfaces, std::size_t threads) {
    const std::size_t width = halves.variance.width(), height = halves.variance.height();
    constexpr std::size_t kReach = shared::kDenoiseChoiceReach;
    for (Plane& plane : halves.likeAcross) plane = halves.variance.alike();
    for (Plane& plane : halves.likeDown) plane = halves.variance.alike();
    parallelChunks(threads, height, 16, [&](std::size_t first, std::size_t end) {
        std::array<ShapeRow, kReach + 1> rows; // of the row at hand and those below, in a ring
        for (std::size_t y = first; y < std::min(first + kReach, height); ++y)
            rows[y % rows.size()].load(surfaces, width, y);
        for (std::size_t y = first; y < end; ++y) {
            if (y + kReach < height) rows[(y + kReach) % rows.size()].load(surfaces, width, y + kReach);
            const ShapeRow& row = rows[y % rows.size()];
            for (std::size_t step = 1; step <= kReach; ++step) {
                if (step < width) compareShapes(row, 0, row, step, width - step, halves.likeAcross[step - 1].row(y));
                if (y + step < height)
                    compareShapes(row, 0, rows[(y + step) % rows.size()], 0, width, halves.likeDown[step - 1].row(y));
            }
        }
    });
}

// ---- guides --------------------------------------------------------------------------------------------------------

// A plane with a border of zeros, and its first pixel inside of that.
class BorderedPlane {
  public:
    BorderedPlane(std::size_t width, std::size_t height)
        : pitch_(width + 2 * kBorder), data_((height + 2 * kBorder) * pitch_ + kDenoiseGuideOverrun) {}
    explicit BorderedPlane(const Plane& plane) : BorderedPlane(plane.width(), plane.height()) {
        for (std::size_t y = 0; y < plane.height(); ++y) std::copy_n(plane.row(y), plane.width(), row(y));
    }
    std::size_t pitch() const { return pitch_; }
    float* row(std::size_t y) { return data_.data() + (y + kBorder) * pitch_ + kBorder; }

  private:
    static constexpr std::size_t kBorder = shared::kDenoiseGuideBorder;
    std::size_t pitch_;
    std::vector<float> data_;
};

void makeGuide(Half& half, BorderedPlane& variance, BorderedPlane& inside, const DenoiseKernels& kernels,
               std::size_t threads) {
    const std::size_t width = half.tones[0].width(), height = half.tones[0].height();
    std::array<BorderedPlane, 3> tones{BorderedPlane(half.tones[0]), BorderedPlane(half.tones[1]),
                                       BorderedPlane(half.tones[2])};
    half.guideVariance = half.tones[0].alike();
    for (Plane& plane : half.guide) plane = half.tones[0].alike();
    parallelFor(threads, height, [&](std::size_t y) {
        interruptionPoint();
        DenoiseGuideRow row;
        row.width = static_cast<int>(width);
        row.pitch = static_cast<int>(variance.pitch());
        row.variance = variance.row(y);
        row.inside = inside.row(y);
        row.guideVariance = half.guideVariance.row(y);
        for (std::size_t c = 0; c < 3; ++c) {
            row.tones[c] = tones[c].row(y);
            row.guide[c] = half.guide[c].row(y);
        }
        kernels.smoothGuideRow(row);
    });
}

void makeGuides(Halves& halves, const DenoiseKernels& kernels, std::size_t threads) {
    const std::size_t width = halves.variance.width(), height = halves.variance.height();
    BorderedPlane variance(halves.variance), inside(width, height);
    for (std::size_t y = 0; y < height; ++y) std::fill_n(inside.row(y), width, 1.0f);
    for (Half& half : halves.half) makeGuide(half, variance, inside, kernels, threads);
}

// ---- filtering -----------------------------------------------------------------------------------------------------

// One thread's tile: the planes that the kernel reads, with their margins, and what it writes.
class TileFilter {
  public:
    TileFilter(Halves& halves, const Surfaces& surfaces, const DenoiseKernels& kernels)
        : halves_(halves),
          surfaces_(surfaces),
          kernels_(kernels),
          width_(static_cast<int>(halves.variance.width())),
          height_(static_cast<int>(halves.variance.height())) {}

    void filter(int left, int top) {
        left_ = left;
        top_ = top;
        DenoiseTile tile;
        tile.rows = std::min(kDenoiseTile, height_ - top);
        tile.columns = std::min(kDenoiseTile, width_ - left);
        tile.dependentSide = halves_.dependentSide;
        tile.scratch = scratch_.data();
        loadFeatures(tile);
        for (std::size_t half = 0; half < 2; ++half) {
            const Half& other = halves_.half[1 - half];
            const bool isRaw = halves_.hasRawGuides();
            tile.variance = load(kVariance, isRaw ? halves_.variance : other.guideVariance);
            for (int c = 0; c < 3; ++c) {
                tile.guide[c] = load(kGuide + c, isRaw ? other.tones[c] : other.guide[c]);
                tile.radiance[c] = load(kRadiance + c, halves_.half[half].radiance[c]);
            }
            for (std::size_t i = 0; i < kDenoiseBandwidths; ++i)
                for (std::size_t c = 0; c < 3; ++c) tile.filtered[i][c] = written(i * 3 + c);
            for (std::size_t i = 0; i < kDenoiseBandwidths; ++i) {
                tile.ownFactor[i] = written(3 * kDenoiseBandwidths + i);
                tile.partnerFactor[i] = written(4 * kDenoiseBandwidths + i);
            }
            kernels_.filterTile(tile);
            keep(tile, half);
        }
    }

  private:
    enum {
        kVariance,
        kGuide,
        kRadiance = kGuide + 3,
        kInside = kRadiance + 3,
        kFeatures,
        kPlanes = kFeatures + kDenoiseSurfaceFeatures
    };

    bool isInside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
    float* written(std::size_t index) { return &filtered_[index * kDenoiseTile * kDenoiseTile]; }
    float* plane(int index) { return &planes_[static_cast<std::size_t>(index) * kDenoisePlane]; }

    // visit(place in a plane, x, y) for all pixels of the tile and its margin; those outside of the image too.
    template <class Visit>
    void forEachPixel(const Visit& visit) const {
        for (int row = 0; row < kDenoiseRows; ++row)
            for (int column = 0; column < kDenoiseRows; ++column)
                visit(row * kDenoisePitch + column, left_ + column - kDenoiseMargin, top_ + row - kDenoiseMargin);
    }

    const float* load(int index, const Plane& from) {
        const int x0 = std::max(left_ - kDenoiseMargin, 0),
                  x1 = std::min(left_ + kDenoiseTile + kDenoiseMargin, width_);
        float* to = plane(index);
        std::fill_n(to, kDenoisePlane, 0.0f);
        for (int row = 0; row < kDenoiseRows; ++row) {
            const int y = top_ + row - kDenoiseMargin;
            if (y < 0 || y >= height_) continue;
            std::copy_n(from.row(static_cast<std::size_t>(y)) + x0, x1 - x0,
                        to + row * kDenoisePitch + x0 - left_ + kDenoiseMargin);
        }
        return to;
    }

    void loadFeatures(DenoiseTile& tile) {
        inReach_.clear();
        forEachPixel([&](int, int x, int y) {
            if (isInside(x, y))
                inReach_.push_back(surfaces_.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
        });
        const FeatureSpace space = principalFeatures(inReach_);
        tile.featureCount = static_cast<int>(space.axes.size());
        for (int i = 0; i < tile.featureCount; ++i) tile.features[i] = plane(kFeatures + i);
        tile.inside = plane(kInside);
        auto features = inReach_.begin();
        forEachPixel([&](int place, int x, int y) {
            const bool inside = isInside(x, y);
            plane(kInside)[place] = inside ? 1.0f : 0.0f;
            for (std::size_t axis = 0; axis < space.axes.size(); ++axis)
                plane(kFeatures + static_cast<int>(axis))[place] = inside ? space.coordinate(*features, axis) : 0.0f;
            if (inside) ++features;
        });
    }

    void keep(const DenoiseTile& tile, std::size_t half) const {
        for (std::size_t i = 0; i < kDenoiseBandwidths; ++i) {
            copyTo(halves_.ownFactors[i][half], tile, tile.ownFactor[i]);
            copyTo(halves_.partnerFactors[i][half], tile, tile.partnerFactor[i]);
            for (std::size_t c = 0; c < 3; ++c) copyTo(halves_.filtered[i][half][c], tile, tile.filtered[i][c]);
        }
    }
    void copyTo(Plane& plane, const DenoiseTile& tile, const float* values) const {
        for (int row = 0; row < tile.rows; ++row)
            std::copy_n(values + row * kDenoiseTile, tile.columns,
                        plane.row(static_cast<std::size_t>(top_ + row)) + left_);
    }

    Halves& halves_;
    const Surfaces& surfaces_;
    DenoiseKernels kernels_;
    int width_, height_;
    int left_ = 0, top_ = 0;
    std::vector<float> planes_ = std::vector<float>(std::size_t{kPlanes} * kDenoisePlane + 8);
    std::vector<float> scratch_ = std::vector<float>(kDenoiseScratch);
    std::vector<float> filtered_ =
        std::vector<float>(std::size_t{kDenoiseBandwidths} * 5 * kDenoiseTile * kDenoiseTile);
    std::vector<SurfaceFeatures> inReach_;
};

} // namespace

std::size_t usualRank(std::size_t seen) {
    return static_cast<std::size_t>(0.95 * static_cast<double>(seen - 1));
}

float usualDepth(const Image& depth) {
    std::vector<float> seen;
    for (const float d : depth.data)
        if (std::isfinite(d) && d > 0) seen.push_back(d);
    if (seen.empty()) return 1;
    const auto at = seen.begin() + static_cast<std::ptrdiff_t>(usualRank(seen.size()));
    std::nth_element(seen.begin(), at, seen.end());
    return *at;
}

void filterHalves(Halves& halves, const DenoiseInput& input, std::size_t threads) {
    const std::size_t width = halves.variance.width(), height = halves.variance.height();
    const Surfaces surfaces(input);
    for (std::size_t i = 0; i < kDenoiseBandwidths; ++i)
        for (std::size_t half = 0; half < 2; ++half) {
            halves.ownFactors[i][half] = halves.variance.alike();
            halves.partnerFactors[i][half] = halves.variance.alike();
            for (Plane& plane : halves.filtered[i][half]) plane = halves.variance.alike();
        }
    const std::size_t columns = (width + kDenoiseTile - 1) / kDenoiseTile,
                      rows = (height + kDenoiseTile - 1) / kDenoiseTile;
    const DenoiseKernels kernels = bestKernels();
    if (!halves.hasRawGuides()) makeGuides(halves, kernels, threads);
    // Some tiles at a time: fewer than a row has, which one thread would still filter when others are done.
    parallelChunks(threads, columns * rows, 8, [&](std::size_t first, std::size_t end) {
        TileFilter filter(halves, surfaces, kernels);
        for (std::size_t tile = first; tile < end; ++tile) {
            interruptionPoint();
            filter.filter(static_cast<int>(tile % columns) * kDenoiseTile,
                          static_cast<int>(tile / columns) * kDenoiseTile);
        }
    });
    compareShapes(halves, surfaces, threads);
    for (Half& half : halves.half) { // what is made next takes their memory
        half.guide = {};
        half.guideVariance = {};
    }
}

} // namespace rt::image
