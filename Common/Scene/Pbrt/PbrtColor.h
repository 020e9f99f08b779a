// Colours of pbrt files as linear RGB of Rec. 709, as all of a scene is.
#pragma once
#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

#include "Common/Core/Primaries.h"
#include "Common/Scene/Pbrt/PbrtSpectrum.h"

namespace rt::scene {

// What "rgb" values are in.
struct PbrtColorSpace {
    std::string_view name;
    Primaries primaries;
};

extern const char* const kPbrtColorSpaces;                                        // all names, for messages
const PbrtColorSpace* pbrtColorSpace(std::string_view name);                      // null: there is none
glm::dvec3 pbrtLightOf(const PbrtColorSpace* space, const glm::dvec3& rgb);       // of light; null: sRGB
glm::dvec3 pbrtReflectanceOf(const PbrtColorSpace* space, const glm::dvec3& rgb); // white stays white

// The colour of light of this spectrum, its luminance 1. As pbrt does with all lights: what they emit is divided by its
// own luminance (of "rgb", by that of the white of the colour space), so that "rgb L" [1 1 1] is a radiance of 1 and a
// black body of any temperature as bright. Black where nothing is visible.
glm::dvec3 pbrtLightOf(const PbrtSpectrum& spectrum);
glm::dvec3 pbrtLightOf(double x, double y); // likewise, of a chromaticity
glm::dvec3 pbrtBlackbody(double kelvin);    // likewise, by Planck's law
// Of standard illuminants, as "stdillum-D65": likewise; unset: there is none of the name.
std::optional<glm::dvec3> pbrtIlluminant(std::string_view name);
extern const char* const kPbrtIlluminants;

// Under daylight of D65, white being 1; from 0 to 1.
glm::dvec3 pbrtReflectanceOf(const PbrtSpectrum& spectrum);

} // namespace rt::scene
