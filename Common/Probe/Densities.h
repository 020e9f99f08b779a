// Densities of light sampling and scattering at one place of a scene, as the renderers have them.
#pragma once
#include "Common/Probe/SceneFormulas.h"
#include "Common/Shared/Light/LightSelection.h"
#include "Common/Shared/Path/Mixture.h"
#include "Common/Shared/Path/Vertex.h"

namespace rt::probe {

// Where lights are to be chosen from; `normal` 0: in a medium.
shared::LightContext contextAt(const shared::vec3& position, const shared::vec3& normal);

// The light that is chosen by u, by the scene's flag; leaves in the context the sum that probabilities refer to.
shared::LightChoice chooseLightAt(const SceneFormulas& scene, const shared::vec2& u, shared::LightContext& context);

// With which probability that happens, for a context that chooseLightAt() has seen.
float probabilityOf(const SceneFormulas& scene, shared::uint light, const shared::LightContext& context);

// Per steradian, given this light; 0 of lights without extent.
float lightDensity(const SceneFormulas& scene, const shared::Light& light, const shared::vec3& position,
                   const shared::vec3& normal, float time, const shared::vec3& direction);

// Whether the light's own near side hides the point that was sampled on it, as by area the far wall of a cylinder: the
// density in that direction is that of the near side.
bool isHiddenByItself(const shared::Light& light, const shared::vec3& position, float time,
                      const shared::LightSample& sampled);

// Per steradian, of choosing a light and sampling it: the sum over all lights. For a context as probabilityOf().
float lightsDensity(const SceneFormulas& scene, const shared::LightContext& context, float time,
                    const shared::vec3& direction);

// Where a ray from wo scatters on a surface.
shared::Vertex vertexOn(const SceneFormulas& scene, const shared::Surface& surface, const shared::vec3& wo);

} // namespace rt::probe
