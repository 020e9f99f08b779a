// The light table, found from the geometry: every emitter with its true shape in world space.
#pragma once
#include <cstdint>

#include "Common/Scene/Affine.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Compiler/Bounds.h"

namespace rt::scene {

double luminance(const glm::dvec3& color); // Rec. 709

// Flux into the surrounding space over pi times the emission. World units squared, of all of a surface that emits; what
// a sphere emits inwards stays inside.
double emittingArea(const shared::Light& light);

// Lights of primitives as kernels see them; `emission` is the mean radiance, `material` an index into the scene's.
shared::Light sphereLight(const shared::Sphere& sphere, const shared::vec3& motion);
shared::Light ellipsoidLight(const Affine& toWorld); // of the unit sphere
shared::Light quadLight(const shared::Quad& quad);
shared::Light diskLight(const shared::Round& disk);
shared::Light cylinderLight(const shared::Round& cylinder);
shared::Light triangleLight(const shared::vec3& a, const shared::vec3& b, const shared::vec3& c);

// Punctual lights, but for where the scene is (placeDirectionalLights). Directions, of unit length, are those in which
// the light shines; emission as in shared::Light; angles from the axis in radians, 0 <= inner < outer <= pi / 2.
shared::Light pointLight(const glm::dvec3& position, const glm::dvec3& intensity);
shared::Light spotLight(const glm::dvec3& position, const glm::dvec3& direction, const glm::dvec3& intensity,
                        double innerAngle, double outerAngle);
shared::Light directionalLight(const glm::dvec3& direction, const glm::dvec3& irradiance);

// Tells the directional lights what they shine on.
void placeDirectionalLights(const Bounds& bounds, CompiledScene& out);

// The sky image as a light that surrounds `bounds`; fills skyCdf. False when the image is black.
bool appendSkyLight(const Bounds& bounds, CompiledScene& out);

// For the lights appended so far: probabilities of power-proportional selection, bounds and their tree. Importance
// targets are appended afterwards; they are never selected by power. Throws InputError beyond 2^24 lights.
void finishLights(CompiledScene& out);
void appendTarget(const shared::Light& target, CompiledScene& out);

} // namespace rt::scene
