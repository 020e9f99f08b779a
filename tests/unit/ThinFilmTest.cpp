// Thin films: their colours against interference computed wavelength by wavelength, their limits, and what smooth
// surfaces make of them.
#include <algorithm>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "Common/Shared/Material/PrincipledSurface.h"
#include "tests/unit/DirectionCells.h"
#include "tests/unit/PrincipledSurfaces.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::bsdfOf;
using test::PrincipledCase;
using test::principledOf;

struct FilmCase {
    double cosine;
    double ior;
    double thickness; // nm
    double base;
};

double schlickOf(double f0, double cosine) {
    return f0 + (1 - f0) * std::pow(1 - cosine, 5);
}

// Of one wavenumber, in 1/nm: the sum of all reflections in the film (Airy), amplitudes from Schlick's reflectances.
// `wave` false: without interference.
double airy(const FilmCase& f, double wavenumber, bool wave) {
    const double inside = std::sqrt(1 - (1 - f.cosine * f.cosine) / (f.ior * f.ior));
    const double root = std::sqrt(f.base + 0.0001);
    const double below = (1 + root) / (1 - root);
    const double first = schlickOf(std::pow((f.ior - 1) / (f.ior + 1), 2), f.cosine);
    const double second = schlickOf(std::pow((below - f.ior) / (below + f.ior), 2), inside);
    if (!wave) return first + (1 - first) * (1 - first) * second / (1 - first * second);
    const double r12 = -std::sqrt(first), r23 = below > f.ior ? -std::sqrt(second) : std::sqrt(second);
    const std::complex<double> turn = std::polar(1.0, 2 * test::kPi * 2 * f.ior * f.thickness * inside * wavenumber);
    return std::norm((r12 + r23 * turn) / (1.0 + r12 * r23 * turn));
}

// As observers see it: the Gaussians in wavenumbers that Belcour and Barla fit to the CIE's functions, whose widths
// follow from how fast their transforms decay; their integrals are 1 as those of the transforms at 0 nearly are.
dvec3 filmByWavelengths(const FilmCase& f) {
    const auto mean = [&](double position, double decay) {
        const double width = std::sqrt(2 * decay);
        double sum = 0, weights = 0;
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i) {
            const double x = 5 * (2 * (i + 0.5) / kSteps - 1);
            const double weight = std::exp(-0.5 * x * x);
            sum += weight * (airy(f, (position + x * width) * 1e-9, true) - airy(f, 0, false));
            weights += weight;
        }
        return sum / weights;
    };
    const double x = 0.846590 * mean(1.6810e6, 4.3278e9) + 0.153868 * mean(2.2399e6, 4.5282e9);
    const double y = 1.000222 * mean(1.7953e6, 9.3046e9), z = 1.001122 * mean(2.2084e6, 6.6121e9);
    const dvec3 wave(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                     0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
    return glm::clamp(dvec3(airy(f, 0, false)) + wave, 0.0, 1.0);
}

// Two orders of interference are all that counts where reflectances are moderate.
TEST(ThinFilm, ColoursAreThoseOfInterference) {
    for (const double cosine : {1.0, 0.7, 0.4})
        for (const double ior : {1.3, 1.8})
            for (const double thickness : {50.0, 120.0, 260.0, 400.0, 800.0})
                for (const double base : {0.04, 0.3, 0.8}) {
                    const FilmCase f{cosine, ior, thickness, base};
                    const vec3 made = filmReflectance(float(cosine), float(ior), float(thickness), vec3(float(base)));
                    const dvec3 expected = filmByWavelengths(f);
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(made[c], expected[c], 0.025)
                            << cosine << ' ' << ior << ' ' << thickness << ' ' << base << ' ' << c;
                }
}

// Far beyond the wavelengths nothing interferes any more, and every colour is the same.
TEST(ThinFilm, ThickOnesHaveNoColour) {
    for (const double base : {0.04, 0.5}) {
        const vec3 made = filmReflectance(0.8f, 1.5f, 1e6f, vec3(float(base)));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(made[c], airy({0.8, 1.5, 1e6, base}, 0, false), 1e-4);
    }
}

TEST(ThinFilm, ReflectancesAreBounded) {
    test::Uniforms uniform(43);
    for (int i = 0; i < 100'000; ++i) {
        const float cosine = i % 5 == 0 ? 0.0f : uniform();
        const vec3 base(uniform(), i % 3 == 0 ? 1.0f : 0.0f, uniform());
        const vec3 made = filmReflectance(cosine, 1 + 4 * uniform(), std::pow(10.0f, 10 * uniform() - 1), base);
        for (int c = 0; c < 3; ++c) ASSERT_TRUE(made[c] >= 0 && made[c] <= 1) << made[c];
    }
}

// A smooth surface reflects what its film does, a metal and a dielectric; glass transmits the rest.
TEST(ThinFilm, SmoothSurfacesReflectAsTheFilmDoes) {
    const dvec3 gold(0.9, 0.7, 0.4);
    for (const double cosine : {1.0, 0.6, 0.2})
        for (const float share : {0.5f, 1.0f}) {
            const vec3 wo = test::outgoingAt(cosine);
            PrincipledCase which{};
            which.film = share;
            which.metallic = 1;
            Bsdf b = bsdfOf(principledOf(which, 0), vec3(gold), wo);
            vec3 film = filmReflectance(wo.z, 1.3f, 400, vec3(gold));
            vec3 bare = mix(vec3(gold), vec3(1), schlick(wo.z));
            vec3 seen = mix(b.lobes.f0, b.lobes.f90, schlick(wo.z));
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], bare[c] + (film[c] - bare[c]) * share, 2e-4);

            which.metallic = 0;
            which.transmission = 1;
            b = bsdfOf(principledOf(which, 0), vec3(1), wo);
            film = filmReflectance(wo.z, 1.3f, 400, vec3(0.04f));
            bare = vec3(fresnel(wo.z, 1 / test::kPrincipledIor).x);
            seen = filmedReflectance(b.lobes, bare.x);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], bare[c] + (film[c] - bare[c]) * share, 2e-4);
        }
}

} // namespace
} // namespace rt::shared
