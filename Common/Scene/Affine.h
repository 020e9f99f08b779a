// Affine maps in double precision, and the steps of a Transform as one.
#pragma once
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// x' = linear x + offset.
struct Affine {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};

    glm::dvec3 point(const glm::dvec3& p) const { return linear * p + offset; }
    glm::dvec3 vector(const glm::dvec3& v) const { return linear * v; }
    bool mirrors() const { return glm::determinant(linear) < 0; }
};

inline Affine operator*(const Affine& outer, const Affine& inner) {
    return {outer.linear * inner.linear, outer.point(inner.offset)};
}

inline Affine translation(const glm::dvec3& offset) {
    return {glm::dmat3(1.0), offset};
}

inline Affine scaling(const glm::dvec3& factors) {
    return {glm::dmat3(factors.x, 0, 0, 0, factors.y, 0, 0, 0, factors.z), glm::dvec3(0)};
}

// Nothing when the map is singular or not finite.
std::optional<Affine> inverse(const Affine& map);

// Columns: two directions across a third, of unit length, and that; the first two as shared::makeFrame() has them.
glm::dmat3 frameAround(const glm::dvec3& n);

// A Q with a rotation Q that puts the columns at right angles: the half axes of the ellipsoid that A makes of the unit
// sphere.
glm::dmat3 orthogonalColumns(const glm::dmat3& a);

// The factor s when the map scales all lengths by s (rotations and reflections included, to a relative 1e-6).
std::optional<double> uniformScale(const Affine& map);

// Of the steps one after the other. A rotation about a zero axis is the identity.
Affine toAffine(const Transform& transform);

} // namespace rt::scene
