#include "Common/Scene/Daylight.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Core/Primaries.h"

namespace rt::scene {

namespace {

constexpr double kUnitLuminance = 1e5 / std::numbers::pi; // cd/m2 of radiance 1

// Of Rec. 709 with the luminance Y of `xyz`: colours beyond what its primaries can mix lose saturation.
glm::dvec3 rec709Of(const glm::dvec3& xyz) {
    static const glm::dmat3 fromXyz = xyzToRec709(), toXyzAgain = toXyz(kRec709).value();
    const glm::dvec3 mixed = glm::max(fromXyz * xyz, 0.0);
    const double luminance = (toXyzAgain * mixed).y;
    return luminance > 0 ? xyz.y / luminance * mixed : glm::dvec3(0);
}

// ---- the sun -------------------------------------------------------------------------------------------------------

// R. Bird, C. Riordan, Simple Solar Spectral Model for Direct and Diffuse Irradiance on Horizontal and Tilted Planes at
// the Earth's Surface for Cloudless Atmospheres, SERI/TR-215-2436, 1984: of their table what is visible.
struct SolarLine {
    double wavelength; // nm
    double irradiance; // W/(m2 nm) above the atmosphere
    double ozone;      // absorption per atm-cm
};
constexpr SolarLine kSolarLines[] = {
    {380, 1.1038, 0},       {390, 1.0338, 0},       {400, 1.4791, 0},       {410, 1.7013, 0},
    {420, 1.7404, 0},       {430, 1.5872, 0},       {440, 1.8370, 0},       {450, 2.0050, 0.003},
    {460, 2.0430, 0.006},   {470, 1.9870, 0.009},   {480, 2.0270, 0.014},   {490, 1.8960, 0.021},
    {500, 1.9090, 0.030},   {510, 1.9270, 0.040},   {520, 1.8310, 0.048},   {530, 1.8910, 0.063},
    {540, 1.8980, 0.075},   {550, 1.8920, 0.085},   {570, 1.8400, 0.120},   {593, 1.7680, 0.119},
    {610, 1.7280, 0.120},   {630, 1.6580, 0.090},   {656, 1.5240, 0.065},   {667.6, 1.5310, 0.051},
    {690, 1.4200, 0.028},   {710, 1.3990, 0.018},   {718, 1.3740, 0.015},   {724.4, 1.3730, 0.012},
    {740, 1.2980, 0.010},   {752.5, 1.2690, 0.008}, {757.5, 1.2450, 0.007}, {762.5, 1.2230, 0.006},
    {767.5, 1.2050, 0.005}, {780, 1.1830, 0}};

// Between lines.
SolarLine solarLine(double wavelength) {
    const auto after = std::lower_bound(std::begin(kSolarLines) + 1, std::end(kSolarLines) - 1, wavelength,
                                        [](const SolarLine& line, double value) { return line.wavelength < value; });
    const SolarLine &a = *(after - 1), &b = *after;
    const double part = (wavelength - a.wavelength) / (b.wavelength - a.wavelength);
    return {wavelength, a.irradiance + part * (b.irradiance - a.irradiance), a.ozone + part * (b.ozone - a.ozone)};
}

// Tristimulus values of sunlight on the ground; Y in lx. Bird and Riordan's transmittances by Rayleigh scattering
// (2-4), aerosols (2-6, 2-7) and ozone (2-9, 2-10), with the air mass of Kasten (2-5); the aerosols' amount by
// turbidity, their exponent and the 0.35 cm of ozone are those of Preetham et al. (appendix A.1). Water vapour and
// oxygen absorb next to nothing of what is visible, and are left out.
glm::dvec3 sunlight(double zenithDegrees, double turbidity) {
    constexpr double kLumens = 683, kOzone = 0.35, kOzoneHeight = 22.0 / 6370, kAerosolExponent = 1.3;
    const double cosine = std::max(std::cos(glm::radians(zenithDegrees)), 0.0);
    const double air = 1 / (cosine + 0.15 * std::pow(93.885 - zenithDegrees, -1.253));
    const double ozone = kOzone * (1 + kOzoneHeight) / std::sqrt(cosine * cosine + 2 * kOzoneHeight);
    const double aerosols = 0.04608 * turbidity - 0.04586;
    constexpr int kFirst = 380, kLast = 780;
    glm::dvec3 sum(0);
    for (int wavelength = kFirst; wavelength <= kLast; ++wavelength) {
        const SolarLine line = solarLine(wavelength);
        const double um = 1e-3 * wavelength, squared = um * um;
        const double rayleigh = 1 / (squared * squared * (115.6406 - 1.335 / squared));
        const double depth = air * (rayleigh + aerosols * std::pow(um, -kAerosolExponent)) + ozone * line.ozone;
        const double width = wavelength == kFirst || wavelength == kLast ? 0.5 : 1;
        sum += width * line.irradiance * std::exp(-depth) * colorMatching(wavelength);
    }
    return kLumens * sum;
}

// ---- the sky -------------------------------------------------------------------------------------------------------

// A. Preetham, P. Shirley, B. Smits, A Practical Analytic Model for Daylight, 1999, appendix A.2, for the angle between
// zenith and sun.
double zenithLuminance(double sun, double turbidity) {
    const double chi = (4.0 / 9.0 - turbidity / 120) * (std::numbers::pi - 2 * sun);
    return (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
}
double cubic(double a, double b, double c, double d, double x) {
    return ((a * x + b) * x + c) * x + d;
}
double zenithX(double sun, double t) {
    return t * t * cubic(0.00166, -0.00375, 0.00209, 0, sun) + t * cubic(-0.02903, 0.06377, -0.03202, 0.00394, sun) +
           cubic(0.11693, -0.21196, 0.06052, 0.25886, sun);
}
double zenithY(double sun, double t) {
    return t * t * cubic(0.00275, -0.00610, 0.00317, 0, sun) + t * cubic(-0.04214, 0.08970, -0.04153, 0.00516, sun) +
           cubic(0.15346, -0.26756, 0.06670, 0.26688, sun);
}

} // namespace

// The formula of the appendix, F(theta, gamma).
double Daylight::Perez::at(double cosine, double angle) const {
    const double toSun = std::cos(angle);
    return scale * (1 + a * std::exp(b / cosine)) * (1 + c * std::exp(d * angle) + e * toSun * toSun);
}

glm::dvec3 sunDirection(const SunSkyBackground& sky) {
    const double up = glm::radians(sky.sunElevation), around = glm::radians(sky.sunAzimuth);
    return {std::cos(up) * std::sin(around), std::sin(up), -std::cos(up) * std::cos(around)};
}

Daylight::Daylight(const SunSkyBackground& sky) {
    const double t = sky.turbidity, zenithDegrees = 90 - sky.sunElevation, sun = glm::radians(zenithDegrees);
    luminance_ = {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251,
                  0.1206 * t - 2.5771, -0.0670 * t + 0.3703, 1};
    x_ = {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125,
          -0.0641 * t - 0.8989, -0.0033 * t + 0.0452, 1};
    y_ = {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102,
          -0.0441 * t - 1.6537, -0.0109 * t + 0.0529, 1};
    const auto scaleTo = [sun](Perez& perez, double zenith) { perez.scale = zenith / perez.at(1, sun); };
    scaleTo(luminance_, zenithLuminance(sun, t));
    scaleTo(x_, zenithX(sun, t));
    scaleTo(y_, zenithY(sun, t));
    sun_ = rec709Of(sunlight(zenithDegrees, t) / kUnitLuminance);
}

glm::dvec3 Daylight::sky(double cosine, double angle) const {
    constexpr double kCandelas = 1e3;
    const double luminance = kCandelas / kUnitLuminance * luminance_.at(cosine, angle);
    return rec709Of(luminance * xyzOf({x_.at(cosine, angle), y_.at(cosine, angle)}));
}

} // namespace rt::scene
