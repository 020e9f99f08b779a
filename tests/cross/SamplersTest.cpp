// Every sampler proved on the host and on the device by the same tests, in single precision, against answers in double
// precision that use no shared formula.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <SamplerProbe.comp.h>
#include "Shaders/SamplerProbe.h"
#include "tests/cross/Probe.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/Statistics.h"

namespace rt::test {
namespace {

constexpr std::uint32_t kDraws = 1u << 15;
constexpr std::uint32_t kParts = shared::kProbeCases * shared::kProbeModes;

enum class Where { Host, Device };

struct Case {
    Where where;
    std::uint32_t family, which;
};

// What a case draws. The functions of these classes are the proofs.
class Sampler {
  public:
    Sampler(const Case& c, const std::vector<Words>& onDevice)
        : family_(c.family), which_(c.which), where_(c.where), onDevice_(onDevice) {}

    // Twelve decades of size and distance, slivers, edge-on, touching, far from the origin, grazing directions, tiny lobes.
    void leavesNothingUnderStressThatIsNotFinite() const {
        for (std::uint32_t i = 0; i < kDraws; ++i) ASSERT_EQ(drawn(shared::kProbeStress, i)[0], 0u) << "draw " << i;
    }

  protected:
    const std::uint32_t family_, which_;

    Words drawn(std::uint32_t mode, std::uint32_t i) const {
        if (where_ == Where::Device) return onDevice_[(std::size_t{which_} * shared::kProbeModes + mode) * kDraws + i];
        const shared::uvec4 w = shared::probeSampler(family_, which_, mode, i);
        return {w.x, w.y, w.z, w.w};
    }
    static double number(const Words& words, std::size_t c) {
        return static_cast<double>(std::bit_cast<float>(words[c]));
    }

  private:
    const Where where_;
    const std::vector<Words>& onDevice_;
};

// ---- directions -----------------------------------------------------------------------------------------------------

// A sampler's domain in cells, and the measure of each: of lights what they contribute to the irradiance, of scattering the
// cosine for diffuse and the solid angle for others.
class Directions : public Sampler {
    static constexpr int kCells = 8;

    const bool isLight_ = family_ < shared::kProbeScattering;
    const shared::Light light_ = shared::probeCaseLight(family_, which_);
    const bool isRound_ = !isLight_ || light_.kind == shared::kLightSphere;
    const bool isTriangle_ = isLight_ && light_.kind == shared::kLightTriangle;
    const bool hasCosine_ = isLight_ || which_ == 0;
    const dvec3 up_{0, 1, 0};
    const dvec3 corner_{light_.position}, u_{light_.edgeU}, v_{light_.edgeV};
    dvec3 axis_, side_, top_; // of the cone of a round domain
    double coneCosine_ = 0;

  public:
    Directions(const Case& c, const std::vector<Words>& onDevice) : Sampler(c, onDevice) {
        if (!isRound_) return;
        const bool isInside = isLight_ && glm::length(corner_) < double(light_.radius);
        const shared::vec4 cone = shared::probeCone(which_);
        axis_ = isLight_ ? (isInside ? up_ : glm::normalize(corner_)) : glm::normalize(dvec3(cone));
        const double sine = double(light_.radius) / glm::length(corner_);
        coneCosine_ = isLight_ ? (isInside ? 0 : std::sqrt((1 - sine) * (1 + sine))) : double(cone.w);
        side_ = glm::normalize(glm::cross(axis_, dvec3(0.3, 0.2, 1)));
        top_ = glm::cross(side_, axis_);
    }

    void haveTheDistributionThatTheirDensitiesState() const;
    void giveTheAnalyticMean() const;
    void haveTheDensityOfTheirMethod() const;
    void haveADensityThatIntegratesToOneAndIsTheirs() const;
    void keepStrata() const;

  private:
    double measure(const dvec3& w) const { return hasCosine_ ? std::max(w.y, 0.0) : 1.0; }

    std::size_t cellOf(const dvec3& w) const {
        double a = 0, b = 0;
        if (isRound_) {
            a = (1 - glm::dot(w, axis_)) / (1 - coneCosine_);
            b = std::atan2(glm::dot(w, side_), glm::dot(w, top_)) / (2 * kPi) + 0.5;
        } else {
            const dvec3 n = glm::cross(u_, v_);
            const dvec3 p = w * (glm::dot(corner_, n) / glm::dot(w, n)) - corner_;
            a = glm::dot(glm::cross(p, v_), n) / glm::dot(n, n);
            b = glm::dot(glm::cross(u_, p), n) / glm::dot(n, n);
        }
        const auto cell = [](double x) { return std::clamp(static_cast<int>(x * kCells), 0, kCells - 1); };
        const int i = cell(a), k = cell(b);
        const int row = isTriangle_ && i + k >= kCells ? kCells - 1 - i : k;
        return static_cast<std::size_t>(i * kCells + row);
    }

    std::vector<double> measures() const {
        std::vector<double> result;
        for (int i = 0; i < kCells; ++i)
            for (int k = 0; k < kCells; ++k) result.push_back(isRound_ ? roundCell(i, k) : flatCell(i, k));
        return result;
    }

    double roundCell(int i, int k) const {
        constexpr int kSteps = 100;
        double sum = 0;
        for (int x = 0; x < kSteps; ++x)
            for (int y = 0; y < kSteps; ++y) {
                const double c = 1 - (1 - coneCosine_) * (i + (x + 0.5) / kSteps) / kCells;
                const double phi = 2 * kPi * ((k + (y + 0.5) / kSteps) / kCells - 0.5), s = std::sqrt(1 - c * c);
                sum += measure(c * axis_ + s * (std::sin(phi) * side_ + std::cos(phi) * top_));
            }
        return sum * 2 * kPi * (1 - coneCosine_) / (kCells * kCells * kSteps * kSteps);
    }

    double flatCell(int i, int k) const {
        if (isTriangle_ && i + k >= kCells) return 0;
        const auto at = [&](int a, int b) { return corner_ + u_ * (double(a) / kCells) + v_ * (double(b) / kCells); };
        std::vector<dvec3> corners{at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)};
        if (isTriangle_ && i + k == kCells - 1) corners.erase(corners.begin() + 2);
        return polygonIrradiance(corners, up_);
    }

    // What a sample stands for: its part of the measure, if densities are right. `bug`: relative, in half of the domain.
    double weight(const Words& words, double bug = 0) const {
        const dvec3 w(number(words, 0), number(words, 1), number(words, 2));
        const double density = number(words, 3);
        if (!(density > 0)) return 0;
        return measure(w) / density * (cellOf(w) % 2 == 0 ? 1 + bug : 1);
    }

    // Probability of sums of weights in the cells that deviate as much as these from the measures.
    double probability(double bug = 0) const {
        const std::vector<double> exact = measures();
        const double whole = std::accumulate(exact.begin(), exact.end(), 0.0);
        std::vector<double> sums(exact.size() + 1), squares(exact.size() + 1), expected(exact.size() + 1);
        const auto isSmall = [&](std::size_t c) { return exact[c] < 1e-3 * whole; }; // the last cell pools those
        for (std::size_t c = 0; c < exact.size(); ++c) expected[isSmall(c) ? exact.size() : c] += exact[c];
        for (std::uint32_t i = 0; i < kDraws; ++i) {
            const Words words = drawn(shared::kProbeDraws, i);
            const double x = weight(words, bug);
            if (!(x > 0)) continue;
            std::size_t c = cellOf({number(words, 0), number(words, 1), number(words, 2)});
            if (isSmall(c)) c = exact.size();
            sums[c] += x / kDraws;
            squares[c] += x * x / kDraws;
        }
        double statistic = 0;
        int cells = 0;
        for (std::size_t c = 0; c < sums.size(); ++c) {
            if (c == exact.size() && expected[c] < 5e-3 * whole) continue; // too few for a normal law
            if (!(expected[c] > 0)) continue;
            const double variance = std::max(squares[c] - expected[c] * expected[c], 1e-30) / kDraws;
            statistic += (sums[c] - expected[c]) * (sums[c] - expected[c]) / variance;
            ++cells;
        }
        return upperGamma(0.5 * cells, 0.5 * statistic);
    }

    double exactWhole() const {
        if (!isLight_) return hasCosine_ ? kPi : 2 * kPi * (1 - coneCosine_);
        if (isRound_) return coneCosine_ == 0 ? kPi : sphereIrradiance(corner_, double(light_.radius), up_);
        return polygonIrradiance(isTriangle_ ? std::vector{corner_, corner_ + u_, corner_ + v_}
                                             : std::vector{corner_, corner_ + u_, corner_ + u_ + v_, corner_ + v_},
                                 up_);
    }

    bool isFuzzy() const { return !isLight_ && which_ >= 2; }
};

void Directions::haveTheDistributionThatTheirDensitiesState() const {
    EXPECT_GT(probability(), kSignificance);
    EXPECT_LT(probability(0.25), kSignificance) << "a density wrong by a quarter in half of the domain is not seen";
}

void Directions::giveTheAnalyticMean() const {
    Mean mean;
    for (std::uint32_t i = 0; i < kDraws; ++i) mean.add(weight(drawn(shared::kProbeDraws, i)));
    EXPECT_TRUE(agrees(mean, exactWhole()));
    double variance = 1e9; // what a method uniform in the measure leaves
    if (isLight_ && family_ >= shared::kProbeProjected) variance = 1e-3;
    if (!isLight_ && which_ < 2) variance = 1e-9;
    EXPECT_LE(mean.relativeVariance(), variance);
}

// Methods that are uniform in something have densities that can be told.
void Directions::haveTheDensityOfTheirMethod() const {
    const std::uint32_t shape = shared::probeShape(family_, which_);
    const bool isInside = isRound_ && coneCosine_ == 0;
    if (!isLight_ || shape == shared::kShapeAuto || shape == shared::kShapeProjected || isInside) return; // by variance
    double solidAngle = 2 * kPi * (1 - coneCosine_);
    if (!isRound_) {
        solidAngle = triangleSolidAngle(corner_, corner_ + u_, isTriangle_ ? corner_ + v_ : corner_ + u_ + v_);
        if (!isTriangle_) solidAngle += triangleSolidAngle(corner_, corner_ + u_ + v_, corner_ + v_);
    }
    for (std::uint32_t i = 0; i < kDraws; ++i) {
        const Words words = drawn(shared::kProbeDraws, i);
        const double density = number(words, 3);
        if (!(density > 0)) continue;
        double exact = 1 / solidAngle;
        if (shape == shared::kShapeArea) {
            const dvec3 w(number(words, 0), number(words, 1), number(words, 2));
            const double r = double(light_.radius), along = glm::dot(corner_, w);
            const double reach2 = std::max(along * along - glm::dot(corner_, corner_) + r * r, 0.0);
            const double distance = isRound_
                                        ? along - std::sqrt(reach2)
                                        : glm::dot(corner_, dvec3(light_.normal)) / glm::dot(w, dvec3(light_.normal));
            const double cosine = isRound_ ? std::sqrt(reach2) / r : std::abs(glm::dot(w, dvec3(light_.normal)));
            if (cosine < 0.02) continue; // a density without bound
            exact = distance * distance / (double(light_.area) * cosine);
        }
        ASSERT_NEAR(density / exact, 1, 2e-3) << i;
    }
}

void Directions::haveADensityThatIntegratesToOneAndIsTheirs() const {
    Mean mean;
    std::uint32_t off = 0;
    for (std::uint32_t i = 0; i < kDraws; ++i) {
        const Words words = drawn(shared::kProbeDensity, i);
        off += std::abs(number(words, 0) - 1) > 2e-3 ? 1 : 0;
        mean.add(number(words, 1));
    }
    // Rounding decides between pieces of a fit, and near the edge of a lobe its density is without bound.
    EXPECT_LE(off, isFuzzy() ? kDraws / 50 : family_ >= shared::kProbeProjected ? kDraws / 500 : kDraws / 5000);
    // A method that draws below the horizon too has a density there, which the probe leaves out.
    const bool isCut = isLight_ && family_ < shared::kProbeProjected && which_ == 2;
    if (isCut) {
        EXPECT_LT(mean.mean(), 1);
        return;
    }
    // By area also the far half of a sphere is drawn from, to no avail.
    const bool isHalf = family_ == shared::kLightSphere && which_ == 0;
    const double seen = isHalf ? 0.5 * (1 - double(light_.radius) / glm::length(corner_)) : 1;
    EXPECT_TRUE(agrees(mean, seen, 1e-4));
}

// The mean of a smooth function over 256 jittered numbers varies far less than over independent ones.
void Directions::keepStrata() const {
    constexpr std::uint32_t kBlock = shared::kProbeSide * shared::kProbeSide;
    const auto variance = [&](std::uint32_t mode) {
        Mean means;
        for (std::uint32_t block = 0; block < kDraws / kBlock; ++block) {
            double sum = 0;
            for (std::uint32_t i = 0; i < kBlock; ++i) {
                const Words words = drawn(mode, block * kBlock + i);
                const dvec3 w(number(words, 0), number(words, 1), number(words, 2));
                sum += weight(words) * (1 + 0.5 * glm::dot(w, dvec3(0.6, 0.48, 0.64)));
            }
            means.add(sum);
        }
        return means.variance();
    };
    EXPECT_LT(4 * variance(shared::kProbeStrata), variance(shared::kProbeDraws));
}

// ---- choice among lights --------------------------------------------------------------------------------------------

class Choice : public Sampler {
  public:
    using Sampler::Sampler;
    void hasTheDistributionThatItStates() const;
    void keepsStrata() const;

  private:
    std::vector<double> exact() const {
        std::vector<double> p;
        const shared::LightContext c = shared::probeContext(which_);
        for (std::uint32_t i = 0; i < shared::kProbeLights; ++i)
            p.push_back(which_ == 1 ? i + 1.0
                        : which_ == 2
                            ? 1.0
                            : double(shared::lightContribution(shared::loadLightBound(1, i), c.position, c.normal)));
        const double whole = std::accumulate(p.begin(), p.end(), 0.0);
        for (double& x : p) x /= whole;
        return p;
    }
};

void Choice::hasTheDistributionThatItStates() const {
    const std::vector<double> p = exact();
    std::vector<std::uint64_t> counts(p.size());
    for (std::uint32_t i = 0; i < kDraws; ++i) {
        const Words words = drawn(shared::kProbeDraws, i);
        ASSERT_LT(words[0], shared::kProbeLights);
        ++counts[words[0]];
        ASSERT_GT(number(words, 1), 0);
        ASSERT_NEAR(number(words, 1) / p[words[0]], 1, 1e-4);
        ASSERT_NEAR(number(words, 2) / p[words[0]], 1, 1e-4);
    }
    EXPECT_GT(chiSquareP(counts, p), kSignificance);
    Mean sums;
    for (std::uint32_t i = 0; i < kDraws; ++i) sums.add(number(drawn(shared::kProbeDensity, i), 1));
    EXPECT_NEAR(sums.mean(), 1, 1e-5);
}

// Of 256 strata each light gets its part but for one at either end.
void Choice::keepsStrata() const {
    const std::vector<double> p = exact();
    constexpr std::uint32_t kBlock = shared::kProbeSide * shared::kProbeSide;
    for (std::uint32_t first = 0; first < kDraws; first += kBlock) {
        std::vector<double> counts(p.size());
        for (std::uint32_t i = 0; i < kBlock; ++i) ++counts.at(drawn(shared::kProbeStrata, first + i)[0]);
        for (std::size_t c = 0; c < p.size(); ++c) ASSERT_NEAR(counts[c], p[c] * kBlock, 2.01) << c;
    }
}

// ---- all ------------------------------------------------------------------------------------------------------------

// Families by the kind of device: a process compiles what it draws from.
class Samplers : public testing::TestWithParam<std::tuple<std::uint32_t, Where>> {};

TEST_P(Samplers, AreProved) {
    const auto [family, where] = GetParam();
    const std::vector<Words> onDevice =
        where == Where::Device ? answersOf({SamplerProbe_comp, {family}, kParts, kDraws}) : std::vector<Words>();
    for (std::uint32_t which = 0; which < shared::kProbeCases; ++which) {
        SCOPED_TRACE("case " + std::to_string(which));
        const Case c{where, family, which};
        if (family == shared::kProbeChoice) {
            const Choice choice(c, onDevice);
            choice.hasTheDistributionThatItStates();
            choice.keepsStrata();
            choice.leavesNothingUnderStressThatIsNotFinite();
        } else {
            const Directions directions(c, onDevice);
            directions.haveTheDistributionThatTheirDensitiesState();
            directions.giveTheAnalyticMean();
            directions.haveTheDensityOfTheirMethod();
            directions.haveADensityThatIntegratesToOneAndIsTheirs();
            directions.keepStrata();
            directions.leavesNothingUnderStressThatIsNotFinite();
        }
    }
}

std::string nameOf(const testing::TestParamInfo<std::tuple<std::uint32_t, Where>>& info) {
    constexpr std::array kFamilies = {"Spheres",          "Quads",          "Triangles",
                                      "ProjectedSpheres", "ProjectedQuads", "ProjectedTriangles",
                                      "Scattering",       "Choice"};
    static_assert(kFamilies.size() == shared::kProbeFamilies);
    const bool isHost = std::get<1>(info.param) == Where::Host;
    return kFamilies.at(std::get<0>(info.param)) + std::string(isHost ? "OnTheHost" : "OnTheDevice");
}

INSTANTIATE_TEST_SUITE_P(Families, Samplers,
                         testing::Combine(testing::Range(0u, shared::kProbeFamilies),
                                          testing::Values(Where::Host, Where::Device)),
                         nameOf);

} // namespace
} // namespace rt::test
