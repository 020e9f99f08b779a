// Colours of an image in other primaries.
#pragma once
#include <glm/mat3x3.hpp>

#include "Common/Image/Image.h"

namespace rt::image {

// Multiplies every pixel of three channels.
void multiplyColors(Image& image, const glm::dmat3& matrix);

} // namespace rt::image
