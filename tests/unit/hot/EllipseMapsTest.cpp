// The other map of Guillen et al. 2017 from the square to a spherical ellipse, the parallel one, as an independent
// computation: what production's radial map draws is uniform in its square, too.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Shared/Light/DiskLight.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;

// An arc around the ellipse's y axis at each y = sin b sin t: dy times an angle around an axis is a solid angle
// (Archimedes), and the arc reaches as far as the outline does. In double, y by a table.
class ParallelMap {
  public:
    explicit ParallelMap(const SphericalEllipse& e) : e_(e), cdf_(kRows + 1) {
        for (int i = 0; i < kRows; ++i) {
            const double t = pi * ((i + 0.5) / kRows - 0.5);
            cdf_[i + 1] = cdf_[i] + 2 * reach(t) * double(e.sines.y) * std::cos(t) * (pi / kRows);
        }
    }
    double solidAngle() const { return cdf_.back(); }

    dvec3 direction(const dvec2& u) const {
        const double sought = u.x * solidAngle();
        const auto above = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, sought);
        const auto row = static_cast<double>(above - cdf_.begin() - 1);
        const double t = pi * ((row + (sought - above[-1]) / (above[0] - above[-1])) / kRows - 0.5);
        const double y = double(e_.sines.y) * std::sin(t), angle = reach(t) * (2 * u.y - 1), r = std::sqrt(1 - y * y);
        return dvec3(e_.x) * (r * std::sin(angle)) + dvec3(e_.y) * y + dvec3(e_.z) * (r * std::cos(angle));
    }
    dvec2 square(const dvec3& w) const {
        const double t = std::asin(std::clamp(glm::dot(w, dvec3(e_.y)) / double(e_.sines.y), -1.0, 1.0));
        const double row = std::clamp((t / pi + 0.5) * kRows, 0.0, kRows - 1e-9), below = std::floor(row);
        const auto i = static_cast<std::size_t>(below);
        const double angle = std::atan2(glm::dot(w, dvec3(e_.x)), glm::dot(w, dvec3(e_.z)));
        return {(cdf_[i] + (row - below) * (cdf_[i + 1] - cdf_[i])) / solidAngle(), 0.5 * (angle / reach(t) + 1)};
    }

  private:
    static constexpr int kRows = 1024;

    double reach(double t) const {
        const double y = double(e_.sines.y) * std::sin(t);
        return std::asin(std::min(double(e_.sines.x) * std::cos(t) / std::sqrt(1 - y * y), 1.0));
    }

    SphericalEllipse e_;
    std::vector<double> cdf_;
};

struct EllipseView {
    double distance, angle; // of the centre of a disk of radius 1; between its normal and the way there
};
constexpr EllipseView kViews[] = {{0.2, 0}, {0.5, 60}, {1, 0}, {1, 60}, {1, 85}, {3, 60}, {10, 30}};

vec3 toCenterOf(const EllipseView& view) {
    const double angle = view.angle * pi / 180;
    return vec3(dvec3(view.distance * std::sin(angle), 0, view.distance * std::cos(angle)));
}

SphericalEllipse ellipseOf(const EllipseView& view) {
    return makeSphericalEllipse(toCenterOf(view), vec3(0, 0, 1), 1, 0);
}

dvec3 directionOf(const SphericalEllipse& e, const EllipseView& view, const EllipseSample& s) {
    return glm::normalize(dvec3(toCenterOf(view)) + dvec3(e.aside) * double(s.place.x) +
                          dvec3(e.y) * double(s.place.y));
}

TEST(EllipseMaps, RadialDrawsAreUniformInTheParallelSquare) {
    constexpr int kDraws = 20000;
    constexpr std::size_t kCells = 8; // a side
    for (const EllipseView& view : kViews) {
        const SphericalEllipse e = ellipseOf(view);
        const ParallelMap parallel(e);
        const vec3 none(0);
        test::Uniforms uniform(1);
        std::vector<std::uint64_t> counts(kCells * kCells);
        test::Mean solidAngle;
        for (int i = 0; i < kDraws; ++i) {
            const EllipseSample s = sampleSphericalEllipse(e, none, uniform.pair());
            const dvec2 u = glm::clamp(parallel.square(directionOf(e, view, s)) * double(kCells), 0.0, kCells - 1.0);
            ++counts[static_cast<std::size_t>(u.y) * kCells + static_cast<std::size_t>(u.x)];
            solidAngle.add(1 / double(s.pdf));
        }
        EXPECT_GT(test::chiSquareP(counts), test::kSignificance) << view.distance << ' ' << view.angle;
        EXPECT_TRUE(test::agrees(solidAngle, parallel.solidAngle(), 1e-4)) << view.distance << ' ' << view.angle;
    }
}

TEST(EllipseMaps, TheParallelMapInvertsAndHasProductionsDensity) {
    for (const EllipseView& view : kViews) {
        const SphericalEllipse e = ellipseOf(view);
        const ParallelMap parallel(e);
        const vec3 none(0);
        test::Uniforms uniform(2);
        test::Mean ratio; // of both densities over draws of one is 1 on average
        for (int i = 0; i < 4000; ++i) {
            const dvec2 u(uniform.pair());
            const dvec3 w = parallel.direction(u);
            EXPECT_LT(glm::length(parallel.square(w) - u), 1e-3) << view.distance << ' ' << view.angle;
            ratio.add(double(sphericalEllipsePdf(e, none, vec3(w))) * parallel.solidAngle());
        }
        EXPECT_TRUE(test::agrees(ratio, 1, 1e-3)) << view.distance << ' ' << view.angle;
        EXPECT_LT(ratio.relativeVariance(), 1e-3);
    }
}

// Why production has the radial map: it takes the receiver's cosine along, which leaves a tenth of the variance and
// less where that varies.
TEST(EllipseMaps, TheRadialMapTakesTheReceiversCosineAlong) {
    for (const EllipseView& view : {EllipseView{0.5, 60}, EllipseView{1, 0}, EllipseView{3, 0}}) {
        const SphericalEllipse e = ellipseOf(view);
        const ParallelMap parallel(e);
        const dvec3 way = glm::normalize(dvec3(toCenterOf(view)));
        const dvec3 normal = 0.5 * way + std::sqrt(0.75) * dvec3(0, 1, 0);
        const vec3 receiver = toEllipse(e, vec3(normal));
        test::Uniforms uniform(3);
        test::Mean radial, other;
        for (int i = 0; i < 20000; ++i) {
            const vec2 u = uniform.pair();
            const EllipseSample s = sampleSphericalEllipse(e, receiver, u);
            radial.add(std::max(glm::dot(normal, directionOf(e, view, s)), 0.0) / double(s.pdf));
            other.add(std::max(glm::dot(normal, parallel.direction(u)), 0.0) * parallel.solidAngle());
        }
        EXPECT_TRUE(test::agrees(radial, other.mean(), 4 * other.standardError() / other.mean()));
        EXPECT_LT(10 * radial.relativeVariance(), other.relativeVariance()) << view.distance << ' ' << view.angle;
    }
}

// Irradiance at the origin from a disk of radius 1 and radiance 1, by `auto` or uniformly in solid angle, with `side`
// times `side` jittered cells: variance of the mean times the number of cells, over the squared mean.
double strataVariance(const EllipseView& view, uint method, double receiver, double around, int side) {
    RenderParams params{};
    params.quadLight = method;
    const dvec3 center(toCenterOf(view)), way = glm::normalize(center);
    const double turn = receiver * pi / 180, about = around * pi / 180;
    const dvec3 aside = std::cos(about) * dvec3(way.z, 0, -way.x) + std::sin(about) * dvec3(0, 1, 0);
    const vec3 normal(std::cos(turn) * way + std::sin(turn) * aside);
    const Light light = scene::diskLight({vec3(center), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), 0, 0, kNone});
    test::Uniforms uniform(4);
    test::Mean estimates;
    for (int i = 0; i < 400; ++i) {
        double sum = 0;
        for (int cell = 0; cell < side * side; ++cell) {
            const vec2 u = (vec2(cell % side, cell / side) + uniform.pair()) * (1 / float(side));
            const LightSample s = sampleDiskLight(params, light, vec3(0), normal, u);
            if (s.pdf > 0) sum += std::max(double(glm::dot(normal, s.wi)), 0.0) / double(s.pdf);
        }
        estimates.add(sum / (side * side));
    }
    return estimates.relativeVariance() * side * side;
}

// Weights for the receiver must not cost what strata gain: from any place, with one sample as with 64, they are less
// noisy than none, by far where the cosine varies. Weights of the azimuth alone have up to 7 times the noise of none
// here.
TEST(EllipseMaps, TheReceiversCosineLeavesStrataTheirGain) {
    for (const EllipseView& view : kViews) {
        for (const double receiver : {30, 60, 90}) {
            for (const double around : {20, 45, 90, -45}) {
                for (const int side : {1, 4, 8}) {
                    const double uniform = strataVariance(view, kShapeSolidAngle, receiver, around, side);
                    const double weighted = strataVariance(view, kShapeAuto, receiver, around, side);
                    EXPECT_LT(weighted, side == 8 ? uniform : uniform / 4)
                        << view.distance << ' ' << view.angle << ' ' << receiver << ' ' << around << ' ' << side;
                }
            }
        }
    }
}

} // namespace
} // namespace rt::shared
