// What lights a model that brings no light: soft boxes and a floor before a grey sky, all in proportion to the model.
#pragma once
#include <cstddef>
#include <optional>

#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Whether anything in the scene gives light that shows the rest of it: a sky that is not black, a light without extent,
// a surface that emits white or more. Weaker emission is a small part that glows, as assets have it, and so is what a
// texture gives a pattern unless it is stronger than white; unlit surfaces are pictures of themselves.
bool bringsLight(const SceneDesc& scene);

// Of all meshes whose data the scene has: all that there is of a model.
Bounds boundsOfMeshes(const SceneDesc& scene);

// Puts a model of these bounds into a studio, unless it brings light. The studio is the prototype "studio" and an
// instance of it, for editors to find, and the sky. It follows from the bounds alone, but that there is no floor
// between the model and a camera of the scene that looks up from below. With a notice.
void addStudioIfUnlit(SceneDesc& scene, const Bounds& bounds);
void addStudio(SceneDesc& scene, const Bounds& bounds); // in any case

// Which of the objects is such a studio, of materials that nobody has changed, where nothing else brings light: a
// reader of the model puts it there again.
std::optional<std::size_t> studioOf(const SceneDesc& scene);

} // namespace rt::scene
