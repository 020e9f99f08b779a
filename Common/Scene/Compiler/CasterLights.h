// How the smooth spheres that lights are connected to see those lights, and how far what they focus or reflect reaches.
#pragma once
#include <cstdint>
#include <vector>

#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Compiler/SkyPatches.h"

namespace rt::scene {

// A light, or a patch of the sky, that shines on a sphere.
struct LightOnSphere {
    std::uint32_t light;    // into the scene's lights
    std::uint32_t skyPatch; // into BrightSky::patches; kNone: any other light
    double irradiance;      // luminance, of the sphere's centre
    double radiance;        // luminance, mean by irradiance
    // Its part of the second moment with which scattering finds all lights.
    double noise() const { return irradiance * radiance; }
};

struct LightsOnSphere {
    // The lights with the most noise, kCasterLights at most, in the scene's order; none where these have less than
    // half of the light of all that could be connected to.
    std::vector<LightOnSphere> connected;
    double irradiance = 0; // of all, and of the whole sky
};

LightsOnSphere lightsOn(const shared::SpecularCaster& sphere, const CompiledScene& scene, const BrightSky& sky);

// Fraction of parallel light, falling on a sphere, that goes on from it after so many crossings.
double meanFraction(double inverseEta, std::uint32_t crossings);

// Adds the sphere to those of the scene, with its reaches. Some light that is connected to falls on it.
void addSpecularCaster(shared::SpecularCaster sphere, const BrightSky& sky, CompiledScene& out);

// The sphere, by refraction, as one to aim at. Some light that could be connected to falls on it.
shared::AimedSphere aimedSphere(shared::SpecularCaster sphere, const BrightSky& sky, const CompiledScene& scene);

} // namespace rt::scene
