#pragma once
#include <cstddef>
#include <vector>

#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// Least variance of a sample, relative to its mean, with which scattering finds the lights from a sphere's centre,
// times the fraction of light that the sphere refracts or reflects, so that connections by way of it are worth their
// time. Below, the noise that they leave out costs less than they do, on a GPU much less: of the four built-in scenes
// with spheres of glass and up to kCasterLights lights two have 48 and 54, and gain by refraction; two at most 11.
// What glass reflects, outside and inside, is connected to wherever refraction is: it has a tenth of the light and half
// of the noise that is left. A mirror takes the noise to everything around it: a quarter is enough.
constexpr double kWorthConnecting = 25;

// Least such variance for the sphere of glass that paths aim at where no sphere is worth connections: aiming takes less
// time.
constexpr double kWorthAiming = 5;

// The smooth spheres by way of which lights are connected to, those that most light goes on from first, and how they
// see the lights, which are complete: those with the most noise, and bright patches of the sky image; or the sphere
// that paths aim at. Replaces what the scene has of them.
void findSpecularCasters(CompiledScene& out, double minVariance = kWorthConnecting);

// All smooth spheres, worth connections or not: mirrors as they reflect, balls of glass as they refract, without how
// they see lights. None of the world, or of instances, if those are more than `most`.
std::vector<shared::SpecularCaster> allSpecularCasters(const CompiledScene& scene, std::size_t maximum);

} // namespace rt::scene
