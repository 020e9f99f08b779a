#include "Common/Image/ColorMatrix.h"

#include <cstddef>

#include <glm/vec3.hpp>

namespace rt::image {

void multiplyColors(Image& image, const glm::dmat3& matrix) {
    for (std::size_t i = 0; i + 2 < image.data.size(); i += 3) {
        const glm::dvec3 color = matrix * glm::dvec3(image.data[i], image.data[i + 1], image.data[i + 2]);
        for (int c = 0; c < 3; ++c) image.data[i + static_cast<std::size_t>(c)] = static_cast<float>(color[c]);
    }
}

} // namespace rt::image
