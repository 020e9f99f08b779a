#include "Common/Scene/Pbrt/PbrtColor.h"

#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace rt::scene {

namespace {

constexpr PbrtColorSpace kSpaces[] = {
    {"srgb", kRec709},
    {"rec2020", {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}},
    {"dci-p3", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}}},
    {"aces2065-1", {{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}}}};

constexpr double kFirstNm = 360, kLastNm = 830;

template <class Spectrum>
glm::dvec3 xyzOfSpectrum(const Spectrum& spectrum) {
    glm::dvec3 sum(0);
    for (double nm = kFirstNm; nm <= kLastNm; nm += 1) sum += spectrum(nm) * colorMatching(nm);
    return sum;
}

// CIE's relative spectrum of D65, from 380 nm in steps of 10 nm (ISO/CIE 11664-2).
double daylight(double nm) {
    constexpr std::array<double, 41> kD65 = {
        49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923,
        108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
        90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091,
        74.3490, 61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};
    const double place = (nm - 380) / 10;
    if (!(place >= 0 && place < kD65.size() - 1)) return 0;
    const auto index = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(index);
    return kD65[index] + share * (kD65[index + 1] - kD65[index]);
}

const glm::dmat3& xyzToRgb() {
    static const glm::dmat3 matrix = xyzToRec709();
    return matrix;
}

// Colours beyond the primaries are cut off.
glm::dvec3 fromXyz(const glm::dvec3& xyz) {
    return glm::max(xyzToRgb() * xyz, glm::dvec3(0));
}

// Chromaticities of the illuminants of CIE 15, for the observer of 1931.
struct Illuminant {
    std::string_view name;
    double x, y;
};
constexpr Illuminant kNamedIlluminants[] = {
    {"stdillum-A", 0.44757, 0.40745},   {"stdillum-D50", 0.34567, 0.35850}, {"stdillum-D65", 0.3127, 0.3290},
    {"stdillum-F1", 0.3131, 0.3371},    {"stdillum-F2", 0.3721, 0.3751},    {"stdillum-F3", 0.4091, 0.3941},
    {"stdillum-F4", 0.4402, 0.4031},    {"stdillum-F5", 0.3138, 0.3452},    {"stdillum-F6", 0.3779, 0.3882},
    {"stdillum-F7", 0.3129, 0.3292},    {"stdillum-F8", 0.3458, 0.3586},    {"stdillum-F9", 0.3741, 0.3727},
    {"stdillum-F10", 0.3458, 0.3588},   {"stdillum-F11", 0.3805, 0.3769},   {"stdillum-F12", 0.4370, 0.4042},
    {"illum-acesD60", 0.32168, 0.33767}};

} // namespace

const char* const kPbrtColorSpaces = "srgb, rec2020, dci-p3, aces2065-1";
const char* const kPbrtIlluminants = "stdillum-A, -D50, -D65, -F1 to -F12, illum-acesD60";

const PbrtColorSpace* pbrtColorSpace(std::string_view name) {
    for (const PbrtColorSpace& space : kSpaces)
        if (space.name == name) return &space;
    return nullptr;
}

glm::dvec3 pbrtLightOf(const PbrtColorSpace* space, const glm::dvec3& rgb) {
    if (!space || space == &kSpaces[0]) return rgb;
    return fromXyz(*toXyz(space->primaries) * rgb);
}

glm::dvec3 pbrtReflectanceOf(const PbrtColorSpace* space, const glm::dvec3& rgb) {
    if (!space || space == &kSpaces[0]) return rgb;
    return pbrtLightOf(space, rgb) / pbrtLightOf(space, glm::dvec3(1));
}

glm::dvec3 pbrtLightOf(const PbrtSpectrum& spectrum) {
    const glm::dvec3 xyz = xyzOfSpectrum([&](double nm) { return spectrum.at(nm); });
    return xyz.y > 0 ? fromXyz(xyz / xyz.y) : glm::dvec3(0);
}

glm::dvec3 pbrtLightOf(double x, double y) {
    return fromXyz(xyzOf({x, y}));
}

glm::dvec3 pbrtBlackbody(double kelvin) {
    constexpr double kC2 = 1.438776877e7; // nm K, h c / k
    // Relative to the value at 560 nm, so that nothing overflows or vanishes.
    const auto planck = [&](double nm) {
        const double x = kC2 / (nm * kelvin), middle = kC2 / (560 * kelvin);
        return std::pow(560 / nm, 5) * std::exp(middle - x) * std::expm1(-middle) / std::expm1(-x);
    };
    const glm::dvec3 xyz = xyzOfSpectrum(planck);
    return xyz.y > 0 && std::isfinite(xyz.x + xyz.y + xyz.z) ? fromXyz(xyz / xyz.y) : glm::dvec3(0);
}

std::optional<glm::dvec3> pbrtIlluminant(std::string_view name) {
    for (const Illuminant& illuminant : kNamedIlluminants)
        if (illuminant.name == name) return pbrtLightOf(illuminant.x, illuminant.y);
    return std::nullopt;
}

// White is divided by, so that what the fit and the steps are off by does not tint it.
glm::dvec3 pbrtReflectanceOf(const PbrtSpectrum& spectrum) {
    static const glm::dvec3 white = xyzToRgb() * xyzOfSpectrum(daylight);
    const glm::dvec3 rgb = xyzToRgb() * xyzOfSpectrum([&](double nm) { return spectrum.at(nm) * daylight(nm); });
    return glm::clamp(rgb / white, 0.0, 1.0);
}

} // namespace rt::scene
