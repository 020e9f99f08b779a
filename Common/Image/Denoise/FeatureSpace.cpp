#include "Common/Image/Denoise/FeatureSpace.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace rt::image {
namespace {

constexpr std::size_t kSide = std::tuple_size_v<SurfaceFeatures>;
constexpr int kSweeps = 12;

using Matrix = std::array<std::array<double, kSide>, kSide>;

// A rotation in the plane of axes p and q that makes a[p][q] zero, applied to both sides.
void rotate(Matrix& a, Matrix& vectors, std::size_t p, std::size_t q) {
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
    const double cosine = 1 / std::sqrt(t * t + 1), sine = t * cosine;
    const auto turn = [&](double& x, double& y) {
        const double old = x;
        x = cosine * old - sine * y;
        y = sine * old + cosine * y;
    };
    for (std::size_t k = 0; k < kSide; ++k) turn(a[k][p], a[k][q]);
    for (std::size_t k = 0; k < kSide; ++k) turn(a[p][k], a[q][k]);
    for (std::size_t k = 0; k < kSide; ++k) turn(vectors[k][p], vectors[k][q]);
}

// Jacobi's method: afterwards the eigenvalues of `a` are on its diagonal; the columns are the eigenvectors.
Matrix diagonalize(Matrix& a) {
    Matrix vectors{};
    for (std::size_t i = 0; i < kSide; ++i) vectors[i][i] = 1;
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (std::size_t p = 0; p < kSide; ++p)
            for (std::size_t q = p + 1; q < kSide; ++q)
                if (std::abs(a[p][q]) > 1.0e-15) rotate(a, vectors, p, q);
    return vectors;
}

// Sums in float, whole rows of eight at a time, are what vectors do; their rounding is far below kDenoiseFeatureNoise.
Matrix covariance(const std::vector<SurfaceFeatures>& pixels, const SurfaceFeatures& mean) {
    constexpr std::size_t kPadded = 8;
    static_assert(kSide <= kPadded);
    float sums[kSide][kPadded] = {};
    for (const SurfaceFeatures& pixel : pixels) {
        float from[kPadded] = {};
        for (std::size_t i = 0; i < kSide; ++i) from[i] = pixel[i] - mean[i];
        for (std::size_t i = 0; i < kSide; ++i)
            for (std::size_t j = 0; j < kPadded; ++j) sums[i][j] += from[i] * from[j];
    }
    Matrix result{};
    for (std::size_t i = 0; i < kSide; ++i)
        for (std::size_t j = 0; j < kSide; ++j) result[i][j] = double{sums[i][j]} / static_cast<double>(pixels.size());
    return result;
}

} // namespace

FeatureSpace principalFeatures(const std::vector<SurfaceFeatures>& pixels) {
    FeatureSpace space;
    for (std::size_t i = 0; i < kSide; ++i) {
        double sum = 0;
        for (const SurfaceFeatures& pixel : pixels) sum += pixel[i];
        space.mean[i] = static_cast<float>(sum / static_cast<double>(pixels.size()));
    }
    Matrix a = covariance(pixels, space.mean);
    const Matrix vectors = diagonalize(a);
    std::array<std::size_t, kSide> order;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&a](std::size_t i, std::size_t j) { return a[i][i] > a[j][j]; });
    for (const std::size_t axis : order) {
        if (space.axes.size() == shared::kDenoiseSurfaceFeatures ||
            !(a[axis][axis] > double{shared::kDenoiseFeatureNoise}))
            break;
        SurfaceFeatures& direction = space.axes.emplace_back();
        for (std::size_t i = 0; i < kSide; ++i) direction[i] = static_cast<float>(vectors[i][axis]);
    }
    return space;
}

} // namespace rt::image
