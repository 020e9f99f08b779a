// Constants of pbrt parameters: numbers, and colours from RGB, black bodies, named and sampled spectra.
#pragma once
#include <glm/vec3.hpp>

#include "Common/Scene/Pbrt/PbrtFiles.h"
#include "Common/Scene/Pbrt/PbrtParameters.h"
#include "Common/Scene/Pbrt/PbrtSpectrum.h"

namespace rt::scene {

// All throw InputError where the parameter is of another type, or its values are none of it.
double pbrtNumber(const PbrtParameter& parameter);
// Of light: see pbrtLightOf(). Not negative, at most kLargest.
glm::dvec3 pbrtLight(const PbrtParameter& parameter, PbrtFiles& files);
// Within [0,1].
glm::dvec3 pbrtReflectance(const PbrtParameter& parameter, PbrtFiles& files);
// Of lists of wavelengths and values, of files of them and of named metals.
PbrtSpectrum pbrtSpectrum(const PbrtParameter& parameter, PbrtFiles& files);
// An index of refraction: a number, that of a glass, or the mean of others.
double pbrtIndex(const PbrtParameter& parameter, PbrtFiles& files);

} // namespace rt::scene
