// Functions of the wavelength.
#pragma once
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace rt::scene {

// Linear between samples, 0 beyond them.
struct PbrtSpectrum {
    std::vector<std::pair<double, double>> samples; // nm, growing; value
    double at(double nm) const;
};

// Measured indices of refraction, n and k, of "metal-Cu-eta", "metal-Cu-k" and the like; unset: there is none of the
// name.
std::optional<PbrtSpectrum> pbrtMetal(std::string_view name);
extern const char* const kPbrtMetals; // all that can stand between "metal-" and "-eta", for messages

// The index of refraction of "glass-BK7" and the like for the yellow light of helium, 587.6 nm.
std::optional<double> pbrtGlass(std::string_view name);
extern const char* const kPbrtGlasses;

// The reflectance at normal incidence of a surface in air.
inline double reflectanceOfMetal(double n, double k) {
    return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

} // namespace rt::scene
