// Exact answers in double precision, written independently of the shared formulas, for tests of light sampling.
#pragma once
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace rt::test {

using glm::dvec3;
constexpr double kPi = std::numbers::pi;

// Solid angle of the triangle with these vertices relative to the point (Van Oosterom & Strackee 1983).
inline double triangleSolidAngle(const dvec3& a, const dvec3& b, const dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double det = std::abs(glm::dot(a, glm::cross(b - a, c - a)));
    return 2 * std::atan2(det, la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la);
}

// Solid angle of [x0, x1] x [y0, y1] at height h, from four corners' terms.
inline double rectangleSolidAngle(double x0, double x1, double y0, double y1, double h) {
    if (h == 0) return 0;
    const auto term = [h](double x, double y) { return std::atan2(x * y, h * std::sqrt(x * x + y * y + h * h)); };
    return std::abs(term(x1, y1) - term(x0, y1) - term(x1, y0) + term(x0, y0));
}

// The part of a polygon on the side of a plane through the origin on which `inside` is.
inline std::vector<dvec3> cutByPlane(const std::vector<dvec3>& polygon, dvec3 across, const dvec3& inside) {
    if (glm::dot(across, inside) < 0) across = -across;
    std::vector<dvec3> part;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double da = glm::dot(a, across), db = glm::dot(b, across);
        if (da >= 0) part.push_back(a);
        if ((da >= 0) != (db >= 0)) part.push_back(a + (b - a) * (da / (da - db)));
    }
    return part;
}

// Irradiance at the origin with normal n under a polygon of radiance 1, clipped to the horizon (Lambert 1760).
inline double polygonIrradiance(const std::vector<dvec3>& polygon, const dvec3& n) {
    const std::vector<dvec3> clipped = cutByPlane(polygon, n, n);
    double sum = 0;
    for (std::size_t i = 0; i < clipped.size(); ++i) {
        const dvec3 a = glm::normalize(clipped[i]), b = glm::normalize(clipped[(i + 1) % clipped.size()]);
        const dvec3 edge = glm::cross(a, b);
        const double sine = glm::length(edge);
        if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(edge, n) / sine;
    }
    return 0.5 * std::abs(sum);
}

// Irradiance under a sphere of radiance 1 whose centre is at `center` relative to the point: the projected solid angle
// of a spherical cap, clipped to the horizon.
inline double sphereIrradiance(const dvec3& center, double radius, const dvec3& n) {
    const double d = glm::length(center);
    const double s = radius / d, cz = glm::dot(n, center) / d;
    if (cz >= s) return kPi * s * s * cz;
    if (cz <= -s) return 0;
    const double c = std::sqrt((1 - s) * (1 + s)), g = std::sqrt((s - cz) * (s + cz));
    return std::atan2(g, c) - c * g + s * s * cz * std::atan2(g, -cz * c);
}

// Points on the outline, as seen from the origin outside, of the ellipsoid of points center + axes * (unit vector):
// where the unit sphere is touched by rays from the origin's preimage. As a polygon it takes 4e-7 off the solid angle.
inline std::vector<dvec3> ellipsoidOutline(const dvec3& center, const glm::dmat3& axes) {
    constexpr int kCorners = 4096;
    const dvec3 eye = -(glm::inverse(axes) * center);
    const double d2 = glm::dot(eye, eye);
    const dvec3 side = glm::normalize(glm::cross(eye, eye.x * eye.x < 0.5 * d2 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const dvec3 up = glm::cross(eye, side) / std::sqrt(d2);
    std::vector<dvec3> outline;
    for (int i = 0; i < kCorners; ++i) {
        const double phi = 2 * kPi * i / kCorners;
        const dvec3 n = eye / d2 + std::sqrt(1 - 1 / d2) * (side * std::cos(phi) + up * std::sin(phi));
        outline.push_back(center + axes * n);
    }
    return outline;
}

// Its solid angle.
inline double ellipsoidSolidAngle(const dvec3& center, const glm::dmat3& axes) {
    const std::vector<dvec3> outline = ellipsoidOutline(center, axes);
    double sum = 0;
    for (std::size_t i = 0; i < outline.size(); ++i)
        sum += triangleSolidAngle(center, outline[i], outline[(i + 1) % outline.size()]);
    return sum;
}

} // namespace rt::test
