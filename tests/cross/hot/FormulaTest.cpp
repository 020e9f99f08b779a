// The shared formulas on the device against the C++ build of the same headers.
#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "FormulaProbe.comp.h"
#include "tests/cross/Probe.h"
#include "tests/cross/probes/FormulaProbe.h"

namespace rt::test {
namespace {

constexpr std::uint32_t kInputs = 100'000;

// Bound on the difference of a formula's results, absolute or relative, whichever is smaller. Devices may round
// divisions and roots otherwise than the host, so where a formula decides something, or is ill-conditioned,
// `exceptions` of the kInputs may be off by more.
struct Bound {
    std::uint32_t formula;
    const char* name;
    double difference;
    std::uint32_t exceptions;
};

constexpr Bound kBounds[] = {
    {shared::kProbeSinCos, "sine and cosine", 5e-7, 0},
    {shared::kProbeArcTan, "arc tangent", 1e-6, 0},
    {shared::kProbeExponential, "exponential", 4e-6,
     0}, // Vulkan allows 3 + 2 |x| units in the last place, and x goes to 20
    {shared::kProbeLogarithm, "logarithm", 1e-6, 0},
    {shared::kProbeSrgb, "sRGB", 2e-6, 0},
    {shared::kProbeFrame, "frame", 1e-6, 0},
    {shared::kProbeHemisphere, "cosine hemisphere", 1e-6, 0},
    {shared::kProbeSphere, "sphere", 1e-6, 0},
    {shared::kProbeOffset, "offset", 1e-6, 0},
    {shared::kProbeFresnel, "Fresnel", 1e-4, 20},        // its slope is infinite at the critical angle
    {shared::kProbeMetal, "metal, sampled", 1e-3, 1000}, // its density is unbounded at the edge of the lobe
    {shared::kProbeMetalPdf, "metal, evaluated", 1e-4, 50},
    {shared::kProbeDielectric, "dielectric", 1e-5, 20},
    {shared::kProbeSphereLight, "sphere light", 1e-5, 50},
    {shared::kProbeQuadLight, "quad light", 1e-4, 10},
    {shared::kProbeTriangleLight, "triangle light", 1e-4, 10},
    {shared::kProbeContribution, "contribution of a light", 1e-5, 0},
    {shared::kProbeSphereHit, "ray and sphere", 1e-4, 10},
    {shared::kProbeQuadHit, "ray and quad", 1e-4, 20},
    {shared::kProbeTriangleHit, "ray and triangle", 1e-4, 20},
    {shared::kProbeSphereMedium, "ray in a sphere", 1e-4, 10},
    {shared::kProbeBoxMedium, "ray in a box", 1e-4, 20},
    {shared::kProbeFreeFlight, "free flight", 2e-6, 0},
    {shared::kProbeCamera, "camera", 1e-6, 0},
    // Near the ends of a sector rounding decides between slices.
    {shared::kProbeSphereProjected, "sphere light by projected solid angle", 1e-4, 100},
    {shared::kProbeQuadProjected, "quad light by projected solid angle", 1e-4, 200},
    {shared::kProbeTriangleProjected, "triangle light by projected solid angle", 1e-4, 200},
    {shared::kProbeCluster, "contribution of a cluster", 1e-4, 50},
    {shared::kProbeSpherePoint, "point on a sphere", 1e-4, 100}, // grazing rays, and misses
    {shared::kProbeTonemap, "tone curves", 1e-5, 0},
    {shared::kProbeEllipsoidLight, "ellipsoid light", 1e-4, 50},
    {shared::kProbeAxisQuadHit, "ray and quad along axes", 1e-4, 20},
    {shared::kProbeCuboidHit, "ray and cuboid", 1e-4, 50},
};
static_assert(std::size(kBounds) == shared::kProbeCount - shared::kProbeFloats);

// Largest of the four differences, each absolute or relative.
double difference(const Words& a, const Words& b) {
    double worst = 0;
    for (std::size_t c = 0; c < a.size(); ++c) {
        if (a[c] == b[c]) continue;
        const double x = static_cast<double>(std::bit_cast<float>(a[c]));
        const double y = static_cast<double>(std::bit_cast<float>(b[c]));
        const double off = std::abs(x - y);
        if (!std::isfinite(off)) return std::numeric_limits<double>::infinity();
        worst = std::max(worst, off / std::max(1.0, std::abs(y)));
    }
    return worst;
}

Words onHost(std::uint32_t formula, std::uint32_t input) {
    const shared::uvec4 words = shared::probe(shared::familyOf(formula), formula, input);
    return {words.x, words.y, words.z, words.w};
}

std::vector<Words> runOnDevice() {
    Probe probe{FormulaProbe_comp, {}, shared::kProbeCount, kInputs};
    for (std::uint32_t family = 0; family < shared::kFamilyCount; ++family) probe.families.push_back(family);
    return answersOf(probe);
}

const Words& onDevice(std::uint32_t formula, std::uint32_t input) {
    static const std::vector<Words> results = runOnDevice();
    return results[std::size_t{formula} * kInputs + input];
}

TEST(FormulaTest, IntegersAreEqual) {
    for (std::uint32_t formula = 0; formula < shared::kProbeFloats; ++formula) {
        for (std::uint32_t i = 0; i < kInputs; ++i) {
            ASSERT_EQ(onDevice(formula, i), onHost(formula, i)) << "formula " << formula << ", input " << i;
        }
    }
}

// By floats, on either side.
TEST(FormulaTest, QuotientsAreThoseOfIntegers) {
    for (std::uint32_t i = 0; i < kInputs; ++i) {
        const Words& words = onDevice(shared::kProbeQuotient, i);
        ASSERT_EQ(words[0], words[2]) << i;
        ASSERT_EQ(words[1], words[3]) << i;
    }
}

TEST(FormulaTest, FloatsAreWithinBounds) {
    for (const Bound& bound : kBounds) {
        std::uint32_t beyond = 0;
        double worst = 0;
        for (std::uint32_t i = 0; i < kInputs; ++i) {
            const double off = difference(onDevice(bound.formula, i), onHost(bound.formula, i));
            worst = std::max(worst, off);
            if (off > bound.difference) ++beyond;
        }
        EXPECT_LE(beyond, bound.exceptions)
            << bound.name << ": of " << kInputs << " inputs so many are off by more than " << bound.difference
            << ", the worst by " << worst;
    }
}

// The comparison would see a formula that is wrong in the sixth digit.
TEST(FormulaTest, ComparisonSeesAWrongDigit) {
    const Words words = onHost(shared::kProbeSphere, 1);
    Words wrong = words;
    wrong[0] = std::bit_cast<std::uint32_t>(std::bit_cast<float>(words[0]) * 1.00001f + 1e-6f);
    EXPECT_GT(difference(words, wrong), 1e-6);
}

} // namespace
} // namespace rt::test
