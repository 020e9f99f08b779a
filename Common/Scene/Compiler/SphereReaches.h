// How the smooth spheres that lights are connected to see those lights, and how far what they focus or reflect reaches.
#pragma once
#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// What a light irradiates the sphere's centre by.
float irradianceAt(const shared::SmoothSphere& sphere, const shared::Light& light, const shared::LightBound& bound);

// Fraction of parallel light, falling on a sphere, that its outside reflects.
double meanReflectance(double inverseEta);

// Adds the sphere to those of the scene, with its reaches. Some light falls on it.
void addSmoothSphere(shared::SmoothSphere sphere, CompiledScene& out);

} // namespace rt::scene
