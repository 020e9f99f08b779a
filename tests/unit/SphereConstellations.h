// A sphere of glass at the origin, of radius 1, between a point and a quad that emits: constellations of them, and the
// light that rays traced in double precision find.
#pragma once
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "tests/unit/Statistics.h"

namespace rt::test {

using glm::dvec3;

constexpr double kPiD = 3.14159265358979323846;

// A ray that has been refracted by the unit sphere at the origin, and the fraction of its light that is left.
struct Traced {
    dvec3 origin{};
    dvec3 direction{};
    double transmitted = 0; // 0: it missed the sphere
};

inline double reflectance(double c, double t, double eta) {
    const double across = (c - eta * t) / (c + eta * t), along = (eta * c - t) / (eta * c + t);
    return 0.5 * (across * across + along * along);
}

inline Traced traceThrough(const dvec3& x, const dvec3& direction, double eta) {
    const double b = -glm::dot(x, direction);
    const dvec3 foot = x + b * direction;
    const double squared = 1 - glm::dot(foot, foot);
    if (squared <= 0 || b <= 0) return {};
    const dvec3 entry = x + (b - std::sqrt(squared)) * direction;
    const double c = -glm::dot(direction, entry);
    const double t = std::sqrt(1 - (1 - c * c) / (eta * eta));
    const dvec3 inside = direction / eta + entry * (c / eta - t);
    const dvec3 leave = entry - 2 * glm::dot(inside, entry) * inside;
    const double kept = 1 - reflectance(c, t, eta);
    return {leave, glm::normalize(eta * inside - leave * (eta * t - c)), kept * kept};
}

struct Constellation {
    const char* name;
    double eta;
    dvec3 x;
    dvec3 corner, edgeU, edgeV; // of a quad that emits 1 to both sides
};

inline const std::array kConstellations = {
    Constellation{"on the axis", 1.5, {0, 0, -4}, {-0.5, -0.5, 6}, {1, 0, 0}, {0, 1, 0}},
    Constellation{"focus of the light", 1.5, {0, 0, -1.9}, {-0.5, -0.5, 7.125}, {1, 0, 0}, {0, 1, 0}},
    Constellation{"fold", 1.5, {0.32, 0, -1.4}, {-0.3, -0.3, 6}, {0.6, 0, 0}, {0, 0.6, 0}},
    Constellation{"touching the sphere", 1.5, {0, 0, -1.001}, {-1, -1, 4}, {2, 0, 0}, {0, 2, 0}},
    Constellation{"light touching the sphere", 1.5, {0.3, 0.1, -3}, {-0.3, -0.3, 1.01}, {0.6, 0, 0}, {0, 0.6, 0}},
    Constellation{"far", 1.5, {1, 2, -40}, {-1, -1, 8}, {2, 0, 0}, {0, 2, 0}},
    Constellation{"far light", 1.5, {0.2, 0.1, -2.5}, {-2, -2, 60}, {4, 0, 0}, {0, 4, 0}},
    Constellation{"beside", 1.5, {4, 0, -2}, {-1, -1, 3}, {2, 0, 0}, {0, 2, 0}},
    Constellation{"on the other side", 1.5, {2, 0, -3}, {1, -0.5, 5}, {1, 0, 0.5}, {0, 1, 0}},
    Constellation{"diamond", 2.4, {0.2, 0, -1.5}, {-0.6, -0.5, 5}, {1, 0, 0}, {0, 1, 0}},
    Constellation{"ice", 1.31, {0.4, 0.3, -2.2}, {-0.6, -0.5, 5}, {1, 0, 0.3}, {0, 1, 0}},
    Constellation{"small light", 1.5, {0.5, 0, -3}, {0, 0, 9}, {0.1, 0, 0}, {0, 0.1, 0}},
};

// A unit vector across another one.
inline dvec3 acrossOf(const dvec3& v) {
    return glm::normalize(glm::cross(v, std::abs(v.x) > 0.5 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
}

inline double coneSolidAngle(const Constellation& c) {
    return 2 * kPiD * (1 - std::sqrt(1 - 1 / glm::dot(c.x, c.x)));
}

// Uniform in the cone in which x sees the sphere.
inline dvec3 coneDirection(const Constellation& c, Uniforms& u) {
    const dvec3 axis = -glm::normalize(c.x), aside = acrossOf(axis);
    const double h = coneSolidAngle(c) / (2 * kPiD) * double(u()), sine = std::sqrt(h * (2 - h));
    const double phi = 2 * kPiD * double(u());
    return axis * (1 - h) + aside * (sine * std::cos(phi)) + glm::cross(axis, aside) * (sine * std::sin(phi));
}

struct LightQuad {
    explicit LightQuad(const Constellation& c)
        : at(c), area(glm::length(glm::cross(c.edgeU, c.edgeV))), normal(glm::cross(c.edgeU, c.edgeV) / area) {}

    // Light that arrives at x along a direction, and the point y that it comes from.
    double along(const dvec3& direction, dvec3& y, Traced& ray) const {
        ray = traceThrough(at.x, direction, at.eta);
        if (ray.transmitted == 0) return 0;
        const double t = glm::dot(at.corner - ray.origin, normal) / glm::dot(ray.direction, normal);
        y = ray.origin + t * ray.direction;
        const dvec3 v = y - at.corner;
        const double a = glm::dot(glm::cross(v, at.edgeV), normal) / area;
        const double b = glm::dot(glm::cross(at.edgeU, v), normal) / area;
        return t > 0 && a >= 0 && a <= 1 && b >= 0 && b <= 1 ? ray.transmitted : 0;
    }

    Constellation at;
    double area;
    dvec3 normal;
};

} // namespace rt::test
