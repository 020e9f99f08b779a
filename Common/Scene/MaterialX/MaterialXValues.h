// The texts of values in MaterialX documents.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec4.hpp>

#include "Common/Scene/MaterialX/XmlText.h"

namespace rt::scene {

// As many finite numbers as the type has, between commas; one stands for all components, and else those that are not
// there are 1. Nothing for another text.
std::optional<glm::dvec4> materialXValue(std::string_view text, std::string_view type);
std::string materialXExpectation(std::string_view type); // "3 numbers between commas"

std::string materialXPlace(const XmlElement& element); // `<image "wood">`

// Names of colour spaces: of images in sRGB's encoding, and of what is linear already.
bool isSrgb(std::string_view space);
bool isLinear(std::string_view space); // where nothing is said, too
glm::dvec4 decodedSrgb(const glm::dvec4& color);

} // namespace rt::scene
