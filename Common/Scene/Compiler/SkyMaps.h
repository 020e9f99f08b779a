// Sky images of other projections and orientations as kernels have them.
#pragma once
#include <cstdint>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Whether the image must be made anew.
bool mustBeMapped(const ImageBackground& sky);

// Appends the latitude-longitude image that shows what `image`, as the background has it, does, and gives its index. It
// has twice as many texels, each the mean over 16 places in it.
std::uint32_t appendSkyMap(const ImageBackground& sky, std::uint32_t image, CompiledScene& out);

// Appends a black image of linear colours, and gives its index. `name`: of what it is of, for errors. Throws
// InputError.
std::uint32_t appendLinearImage(std::uint32_t width, std::uint32_t height, const std::string& name, CompiledScene& out);
// Sets one of its texels, of the scene's words.
void setTexel(std::uint32_t* words, const glm::dvec3& color);

// Where a square image of equal areas shows a unit direction, from (0,0) at its upper left.
glm::dvec2 equalAreaPlace(const glm::dvec3& direction);

} // namespace rt::scene
