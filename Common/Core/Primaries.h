// Colours of other primaries as linear radiance with those of Rec. 709, which everything here has.
#pragma once
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace rt {

// CIE (x, y) chromaticities.
struct Primaries {
    glm::dvec2 red, green, blue, white;
};

inline constexpr Primaries kRec709{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

// Whether both are the same but for how files round them.
bool areSame(const Primaries& a, const Primaries& b);

glm::dvec3 xyzOf(const glm::dvec2& xy); // with Y = 1
// From RGB to XYZ, with Y = 1 for white; nothing where the primaries span no colours.
std::optional<glm::dmat3> toXyz(const Primaries& primaries);

// From RGB of these primaries: the same colours, whatever white is; or the white of the file as white (Bradford).
enum class White { Kept, Adapted };
std::optional<glm::dmat3> toRec709(const Primaries& primaries, White white);
glm::dmat3 xyzToRec709();

// CIE 1931's X, Y, Z of light at a wavelength in nm, fitted: C. Wyman, P.-P. Sloan, P. Shirley, Simple Analytic
// Approximations to the CIE XYZ Color Matching Functions, JCGT 2(2), 2013, equation 4.
glm::dvec3 colorMatching(double nm);

} // namespace rt
