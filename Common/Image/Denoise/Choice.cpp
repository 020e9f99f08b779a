#include "Common/Image/Denoise/Choice.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "Common/Core/Parallel.h"
#include "Common/Shared/Denoise/DenoiseChoice.h"
#include "Common/Shared/Denoise/DenoiseWeights.h"

namespace rt::image {
namespace {

using shared::kDenoiseChoiceReach;
using shared::kDenoiseOwnReach;

// ---- means over pixels that are alike ------------------------------------------------------------------------------

// Of a plane, at each pixel: weighted sums over those around it, and over these but the nearest.
struct LikeSums {
    Plane all, others;
    explicit LikeSums(const Plane& like) : all(like.alike()), others(like.alike()) {}
};

class LikeMeans {
  public:
    LikeMeans(const Halves& halves, std::size_t threads)
        : halves_(halves),
          threads_(threads),
          rows_(halves.variance),
          sums_(halves.variance),
          weights_(halves.variance) {
        Plane ones = halves.variance.alike();
        for (std::size_t y = 0; y < ones.height(); ++y) std::fill_n(ones.row(y), ones.width(), 1.0f);
        sum(ones, weights_);
    }

    // The errors of single pixels become those by which one chooses.
    void average(Plane& errors) {
        sum(errors, sums_);
        parallelFor(threads_, errors.height(), [&](std::size_t y) {
            const float *all = sums_.all.row(y), *others = sums_.others.row(y);
            const float *allWeights = weights_.all.row(y), *otherWeights = weights_.others.row(y);
            float* means = errors.row(y);
            for (std::size_t x = 0; x < errors.width(); ++x) {
                const float mean = all[x] / allWeights[x];
                means[x] = otherWeights[x] > 0 ? shared::denoiseChoiceError(mean, others[x] / otherWeights[x]) : mean;
            }
        });
    }

  private:
    // Sums of rows, then of these.
    void sum(const Plane& plane, LikeSums& sums) {
        const std::size_t width = plane.width(), height = plane.height();
        parallelFor(threads_, height, [&](std::size_t y) {
            float *all = rows_.all.row(y), *others = rows_.others.row(y);
            std::copy_n(plane.row(y), width, all);
            std::fill_n(others, width, 0.0f);
            for (int step = 1; step <= kDenoiseChoiceReach; ++step) {
                addAcross(plane, step, y, all);
                if (step > kDenoiseOwnReach) addAcross(plane, step, y, others);
            }
        });
        parallelFor(threads_, height, [&](std::size_t y) {
            float *all = sums.all.row(y), *others = sums.others.row(y);
            std::copy_n(rows_.all.row(y), width, all);
            std::copy_n(rows_.others.row(y), width, others);
            for (int step = 1; step <= kDenoiseChoiceReach; ++step) {
                addDown(rows_.all, step, y, all);
                addDown(step > kDenoiseOwnReach ? rows_.all : rows_.others, step, y, others);
            }
        });
    }

    // Adds to a row of sums what is so many steps to the right, and to the left.
    void addAcross(const Plane& plane, int step, std::size_t y, float* sums) const {
        const auto distance = static_cast<std::size_t>(step);
        if (distance >= plane.width()) return;
        const float *values = plane.row(y), *like = halves_.likeAcross[distance - 1].row(y);
        for (std::size_t x = 0; x < plane.width() - distance; ++x) sums[x] += like[x] * values[x + distance];
        for (std::size_t x = 0; x < plane.width() - distance; ++x) sums[x + distance] += like[x] * values[x];
    }

    // Below, and above.
    void addDown(const Plane& plane, int step, std::size_t y, float* sums) const {
        const auto distance = static_cast<std::size_t>(step);
        const Plane& like = halves_.likeDown[distance - 1];
        if (y + distance < plane.height()) addProducts(like.row(y), plane.row(y + distance), plane.width(), sums);
        if (y >= distance) addProducts(like.row(y - distance), plane.row(y - distance), plane.width(), sums);
    }
    static void addProducts(const float* a, const float* b, std::size_t count, float* sums) {
        for (std::size_t i = 0; i < count; ++i) sums[i] += a[i] * b[i];
    }

    const Halves& halves_;
    std::size_t threads_;
    LikeSums rows_, sums_, weights_; // weights_: of a plane of ones
};

// ---- choosing ------------------------------------------------------------------------------------------------------

// Adds a row of errors of one channel, in tones, of each pixel's own noise.
void addToneErrors(const std::array<const float*, 2>& filtered, const std::array<const float*, 2>& tones,
                   const std::array<const float*, 2>& ownFactors, std::size_t width, float* errors) {
    for (std::size_t x = 0; x < width; ++x) {
        const shared::DenoisedValue a{shared::denoiseTone(filtered[0][x]), tones[0][x], ownFactors[0][x], 0};
        const shared::DenoisedValue b{shared::denoiseTone(filtered[1][x]), tones[1][x], ownFactors[1][x], 0};
        errors[x] += shared::denoiseError(a, b, 0);
    }
}

// A row of the errors of a filter by which it is chosen.
void addFilterErrors(const Halves& halves, std::size_t filter, std::size_t y, float* errors) {
    const auto& own = halves.ownFactors[filter];
    for (std::size_t c = 0; c < 3; ++c)
        addToneErrors({halves.filtered[filter][0][c].row(y), halves.filtered[filter][1][c].row(y)},
                      {halves.half[0].tones[c].row(y), halves.half[1].tones[c].row(y)}, {own[0].row(y), own[1].row(y)},
                      halves.variance.width(), errors);
}

// A row of the errors of pixels as they are.
void addRawErrors(const Halves& halves, std::size_t y, float* errors) {
    for (std::size_t c = 0; c < 3; ++c) {
        const float *a = halves.half[0].tones[c].row(y), *b = halves.half[1].tones[c].row(y);
        for (std::size_t x = 0; x < halves.variance.width(); ++x)
            errors[x] += shared::denoiseError(rawValue(a[x]), rawValue(b[x]), 0);
    }
}

// The candidate of the least error, and that error.
struct Best {
    Plane candidate, error;
};

void compare(const Plane& errors, std::size_t candidate, float caution, Best& best, std::size_t threads) {
    parallelFor(threads, errors.height(), [&](std::size_t y) {
        for (std::size_t x = 0; x < errors.width(); ++x)
            if (const float error = caution * errors.row(y)[x]; candidate == 0 || error < best.error.row(y)[x]) {
                best.error.row(y)[x] = error;
                best.candidate.row(y)[x] = static_cast<float>(candidate);
            }
    });
}

// By what the pixels around chose, so that no seam is seen where the choice changes.
void blend(CandidateWeights& weights, std::size_t threads) {
    const std::size_t width = weights[kRawCandidate].width(), height = weights[kRawCandidate].height();
    Plane raw = weights[kRawCandidate].alike();
    for (std::size_t y = 0; y < height; ++y) std::copy_n(weights[kRawCandidate].row(y), width, raw.row(y));
    boxMeans({&raw, 1}, shared::kDenoiseRawBlendReach, threads);
    boxMeans(weights, shared::kDenoiseBlendReach, threads);
    parallelFor(threads, height, [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            const float newRaw = raw.row(y)[x];
            const float scale = shared::denoiseFilterScale(weights[kRawCandidate].row(y)[x], newRaw);
            for (std::size_t i = 0; i < kRawCandidate; ++i) weights[i].row(y)[x] *= scale;
            weights[kRawCandidate].row(y)[x] = newRaw;
        }
    });
}

} // namespace

CandidateWeights choose(const Halves& halves, std::size_t threads) {
    const Plane& like = halves.variance;
    const std::size_t width = like.width(), height = like.height();
    LikeMeans means(halves, threads);
    Best best{like.alike(), like.alike()};
    Plane errors = like.alike();
    const auto measure = [&](auto addErrors) {
        parallelFor(threads, height, [&](std::size_t y) {
            std::fill_n(errors.row(y), width, 0.0f);
            addErrors(y, errors.row(y));
        });
        means.average(errors);
    };
    for (std::size_t i = 0; i < kRawCandidate; ++i) {
        measure([&](std::size_t y, float* row) { addFilterErrors(halves, i, y, row); });
        compare(errors, i, 1, best, threads);
    }
    if (halves.mayStayRaw()) {
        measure([&](std::size_t y, float* row) { addRawErrors(halves, y, row); });
        compare(errors, kRawCandidate, shared::kDenoiseRawCaution, best, threads);
    }
    CandidateWeights weights;
    for (Plane& plane : weights) plane = like.alike();
    parallelFor(threads, height, [&](std::size_t y) {
        for (std::size_t i = 0; i < kDenoiseCandidates; ++i)
            for (std::size_t x = 0; x < width; ++x)
                weights[i].row(y)[x] = best.candidate.row(y)[x] == static_cast<float>(i) ? 1.0f : 0.0f;
    });
    blend(weights, threads);
    return weights;
}

} // namespace rt::image
