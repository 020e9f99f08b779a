#include "Common/Scene/Placing.h"

#include <cmath>
#include <cstddef>

#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

bool isWithinLimits(const Affine& map) {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) largest += std::abs(map.linear[i][k]);
    for (int k = 0; k < 3; ++k) largest += std::abs(map.offset[k]);
    return largest <= kLargest;
}

bool isIdentity(const Affine& map) {
    return map.linear == glm::dmat3(1) && map.offset == glm::dvec3(0);
}

Matrix toMatrix(const Affine& map) {
    Matrix matrix;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            matrix.rows[static_cast<std::size_t>(4 * row + column)] = map.linear[column][row];
        matrix.rows[static_cast<std::size_t>(4 * row + 3)] = map.offset[row];
    }
    return matrix;
}

Transform toTransform(const Affine& map) {
    return {toMatrix(map)};
}

} // namespace rt::scene
