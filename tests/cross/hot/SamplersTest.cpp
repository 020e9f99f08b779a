// Every sampler proved on the host and on the device by the same tests, in single precision, against answers in double
// precision that use no shared formula.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "SamplerProbe.comp.h"
#include "tests/cross/Probe.h"
#include "tests/cross/SamplerDomain.h"
#include "tests/cross/probes/SamplerProbe.h"
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

// The lights that the probe's choices are made among.
shared::SceneRef probeScene() {
    static const auto arrays = [] {
        shared::SceneArraysOf<std::vector> made;
        for (std::uint32_t i = 0; i < shared::kProbeLights; ++i) {
            made.lights.push_back(shared::probeTableLight(i));
            made.lightBounds.push_back(shared::probeTableBound(i));
        }
        return made;
    }();
    static const shared::SceneView scene = shared::viewOf(arrays, {});
    return scene;
}

// What a case draws. The functions of these classes are the proofs.
class Sampler {
  public:
    Sampler(const Case& c, const std::vector<Words>& onDevice)
        : family_(c.family), which_(c.which), where_(c.where), onDevice_(onDevice) {}

    // Twelve decades of size and distance, slivers, edge-on, touching, far from the origin, grazing directions, tiny
    // lobes.
    void leavesNothingUnderStressThatIsNotFinite() const {
        for (std::uint32_t i = 0; i < kDraws; ++i) ASSERT_EQ(drawn(shared::kProbeStress, i)[0], 0u) << "draw " << i;
    }

  protected:
    const std::uint32_t family_, which_;

    Words drawn(std::uint32_t mode, std::uint32_t i) const {
        if (where_ == Where::Device) return onDevice_[(std::size_t{which_} * shared::kProbeModes + mode) * kDraws + i];
        const shared::uvec4 w = shared::probeSampler(probeScene(), family_, which_, mode, i);
        return {w.x, w.y, w.z, w.w};
    }
    static double number(const Words& words, std::size_t c) {
        return static_cast<double>(std::bit_cast<float>(words[c]));
    }

  private:
    const Where where_;
    const std::vector<Words>& onDevice_;
};

// ---- directions ----------------------------------------------------------------------------------------------------

class Directions : public Sampler {
  public:
    Directions(const Case& c, const std::vector<Words>& onDevice) : Sampler(c, onDevice), domain_(c.family, c.which) {}

    void haveTheDistributionThatTheirDensitiesState() const;
    void giveTheAnalyticMean() const;
    void haveTheDensityOfTheirMethod() const;
    void haveADensityThatIntegratesToOneAndIsTheirs() const;
    void keepStrata() const;

  private:
    static dvec3 direction(const Words& words) { return {number(words, 0), number(words, 1), number(words, 2)}; }

    // What a sample stands for: its part of the measure, if densities are right. `bug`: relative, in half of the
    // domain.
    double weight(const Words& words, double bug = 0) const {
        const dvec3 w = direction(words);
        const double density = number(words, 3);
        if (!(density > 0)) return 0;
        return domain_.measure(w) / density * (domain_.cellOf(w) % 2 == 0 ? 1 + bug : 1);
    }

    // Probability of sums of weights in the cells that deviate as much as these from the measures.
    double probability(double bug = 0) const {
        const std::vector<double> exact = domain_.measures();
        const double whole = std::accumulate(exact.begin(), exact.end(), 0.0);
        std::vector<double> sums(exact.size() + 1), squares(exact.size() + 1), expected(exact.size() + 1);
        const auto isSmall = [&](std::size_t c) { return exact[c] < 1e-3 * whole; }; // the last cell pools those
        for (std::size_t c = 0; c < exact.size(); ++c) expected[isSmall(c) ? exact.size() : c] += exact[c];
        for (std::uint32_t i = 0; i < kDraws; ++i) {
            const Words words = drawn(shared::kProbeDraws, i);
            const double x = weight(words, bug);
            if (!(x > 0)) continue;
            std::size_t c = domain_.cellOf(direction(words));
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

    bool isProjected() const { return shared::isProbeProjected(family_); }
    bool isFuzzy() const { return !domain_.isLight() && which_ >= 2; }

    const SamplerDomain domain_;
};

void Directions::haveTheDistributionThatTheirDensitiesState() const {
    EXPECT_GT(probability(), kSignificance);
    EXPECT_LT(probability(0.25), kSignificance) << "a density wrong by a quarter in half of the domain is not seen";
}

void Directions::giveTheAnalyticMean() const {
    Mean mean;
    for (std::uint32_t i = 0; i < kDraws; ++i) mean.add(weight(drawn(shared::kProbeDraws, i)));
    EXPECT_TRUE(agrees(mean, domain_.whole()));
    double variance = 1e9; // what a method uniform in the measure leaves
    if (isProjected()) variance = shared::probeKind(family_) == shared::kLightSphere ? 1e-3 : 1e-10;
    if (!domain_.isLight() && which_ < 2) variance = 1e-9;
    EXPECT_LE(mean.relativeVariance(), variance);
}

// Methods that are uniform in something have densities that can be told.
void Directions::haveTheDensityOfTheirMethod() const {
    if (!domain_.hasKnownDensity()) return; // by variance
    for (std::uint32_t i = 0; i < kDraws; ++i) {
        const Words words = drawn(shared::kProbeDraws, i);
        const double density = number(words, 3);
        if (!(density > 0)) continue;
        const std::optional<double> exact = domain_.knownDensity(direction(words));
        if (!exact) continue;
        ASSERT_NEAR(density / *exact, 1, 2e-3) << i;
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
    EXPECT_LE(off, isFuzzy() ? kDraws / 50 : isProjected() ? kDraws / 500 : kDraws / 5000);
    // A method that draws below the horizon too has a density there, which the probe leaves out.
    const bool isCut = domain_.isLight() && !isProjected() && which_ == 2;
    if (isCut) {
        EXPECT_LT(mean.mean(), 1);
        return;
    }
    // By area also the far half of a round light is drawn from, to no avail.
    const bool isHalf = (family_ == shared::kLightSphere || family_ == shared::kProbeEllipsoids) && which_ == 0;
    const double seen = isHalf ? domain_.nearShare() : 1;
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
                sum += weight(words) * (1 + 0.5 * glm::dot(direction(words), dvec3(0.6, 0.48, 0.64)));
            }
            means.add(sum);
        }
        return means.variance();
    };
    EXPECT_LT(4 * variance(shared::kProbeStrata), variance(shared::kProbeDraws));
}

// ---- choice among lights -------------------------------------------------------------------------------------------

// The mean of max(x, 0) over x uniform in [middle - spread, middle + spread].
double clampedMean(double middle, double spread) {
    const double low = std::max(middle - spread, 0.0), high = std::max(middle + spread, 0.0);
    return (high * high - low * low) / (4 * spread);
}

// Irradiance that a flat light with this bound is estimated to cause on a surface with the normal `n`, or anywhere if
// that is 0.
double estimatedIrradiance(const shared::LightBound& bound, const dvec3& position, const dvec3& n) {
    const dvec3 toLight = dvec3(bound.center) - position;
    const double radius = static_cast<double>(bound.radius);
    const double distance = std::max(glm::length(toLight), radius / 2); // nearer, distances say nothing
    const double towards = -glm::dot(dvec3(bound.axis), toLight) / distance;
    const double emitted = bound.twoSided > 0 ? std::abs(towards) : std::max(towards, 0.0);
    const double received = n == dvec3(0) ? 1 : clampedMean(glm::dot(n, toLight), radius) / distance;
    return static_cast<double>(bound.intensity) * emitted * received / (distance * distance);
}

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
                            : estimatedIrradiance(shared::probeTableBound(i), dvec3(c.position), dvec3(c.normal)));
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

// ---- all -----------------------------------------------------------------------------------------------------------

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
                                      "Ellipsoids",       "Scattering",     "Choice"};
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
