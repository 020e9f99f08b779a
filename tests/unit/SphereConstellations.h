// A sphere of glass, or a mirror, at the origin, of radius 1, between a point and a quad that emits, or beside them:
// constellations of them, and the light that rays traced in double precision find.
#pragma once
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "tests/unit/Statistics.h"

namespace rt::test {

using glm::dvec3;

constexpr double kPiD = 3.14159265358979323846;
constexpr double kMirror = 0; // in place of an index of refraction

// A ray that has been refracted by the unit sphere at the origin or reflected on it, and the fraction of its light that
// is left.
struct Traced {
    dvec3 origin{};
    dvec3 direction{};
    double left = 0; // 0: it missed the sphere
};

inline double reflectance(double c, double t, double eta) {
    const double across = (c - eta * t) / (c + eta * t), along = (eta * c - t) / (eta * c + t);
    return 0.5 * (across * across + along * along);
}

// Where a ray meets the sphere. False: it misses.
inline bool meetSphere(const dvec3& x, const dvec3& direction, dvec3& entry) {
    const double b = -glm::dot(x, direction);
    const dvec3 foot = x + b * direction;
    const double squared = 1 - glm::dot(foot, foot);
    if (squared <= 0 || b <= 0) return false;
    entry = x + (b - std::sqrt(squared)) * direction;
    return true;
}

// Refracted where it enters and where it leaves, and reflected inside so many times in between.
inline Traced traceThrough(const dvec3& x, const dvec3& direction, double eta, int reflections = 0) {
    dvec3 entry;
    if (eta == kMirror || !meetSphere(x, direction, entry)) return {};
    const double c = -glm::dot(direction, entry);
    const double t = std::sqrt(1 - (1 - c * c) / (eta * eta));
    const auto across = [](const dvec3& from, const dvec3& along) { return from - 2 * glm::dot(along, from) * along; };
    dvec3 inside = direction / eta + entry * (c / eta - t);
    dvec3 leave = across(entry, inside);
    const double reflected = reflectance(c, t, eta);
    double left = (1 - reflected) * (1 - reflected);
    for (int i = 0; i < reflections; ++i) {
        inside -= 2 * glm::dot(inside, leave) * leave;
        leave = across(leave, inside);
        left *= reflected;
    }
    return {leave, glm::normalize(eta * inside - leave * (eta * t - c)), left};
}

inline Traced traceOff(const dvec3& x, const dvec3& direction, double eta) {
    dvec3 entry;
    if (!meetSphere(x, direction, entry)) return {};
    const double c = -glm::dot(direction, entry);
    const dvec3 reflected = glm::normalize(direction + 2 * c * entry);
    if (eta == kMirror) return {entry, reflected, 1};
    return {entry, reflected, reflectance(c, std::sqrt(1 - (1 - c * c) / (eta * eta)), eta)};
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

// In which light is reflected on the sphere.
inline const std::array kReflections = {
    Constellation{"behind", kMirror, {0, 0, -2}, {-0.5, -0.5, -6}, {1, 0, 0}, {0, 1, 0}},
    Constellation{"before", kMirror, {0, 0, -5}, {-0.2, -0.2, -3}, {0.4, 0, 0}, {0, 0.4, 0}},
    Constellation{"at a right angle", kMirror, {1, 0, -2}, {3, -0.5, -0.5}, {0, 1, 0}, {0, 0, 1}},
    Constellation{"grazing", kMirror, {3, 0.2, 0}, {-2.5, -0.5, 2}, {0, 1, 0}, {0, 0, 1}},
    Constellation{"partly hidden", kMirror, {3, 0, 0}, {-4, -1, 1.5}, {0, 2, 0}, {0, 0, 2.5}},
    Constellation{"touching it", kMirror, {1.001, 0, 0}, {2, 1, -1}, {0, 0, 2}, {1, 1, 0}},
    Constellation{"light touching it", kMirror, {2, 1, 0}, {-0.4, 1.002, -0.4}, {0.8, 0, 0}, {0, 0, 0.8}},
    Constellation{"both far", kMirror, {30, 0, 0}, {-1, 40, 0}, {2, 0, 0}, {0, 0, 2}},
    Constellation{"small light", kMirror, {1.2, 0.9, 0.1}, {1, 6, 1}, {0.05, 0, 0}, {0, 0, 0.05}},
    Constellation{"glass", 1.5, {1, 0, -2}, {3, -0.5, -0.5}, {0, 1, 0}, {0, 0, 1}},
    Constellation{"diamond, grazing", 2.4, {3, 0.2, 0}, {-2.5, -0.5, 2}, {0, 1, 0}, {0, 0, 1}},
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

    // Light that arrives at x through the sphere along a direction, and the point y that it comes from.
    double along(const dvec3& direction, dvec3& y, Traced& ray) const {
        ray = traceThrough(at.x, direction, at.eta);
        return along(ray, y);
    }

    // As much as is left of it.
    double along(const Traced& ray, dvec3& y) const {
        if (ray.left == 0) return 0;
        const double t = glm::dot(at.corner - ray.origin, normal) / glm::dot(ray.direction, normal);
        y = ray.origin + t * ray.direction;
        const dvec3 v = y - at.corner;
        const double a = glm::dot(glm::cross(v, at.edgeV), normal) / area;
        const double b = glm::dot(glm::cross(at.edgeU, v), normal) / area;
        return t > 0 && a >= 0 && a <= 1 && b >= 0 && b <= 1 ? ray.left : 0;
    }

    Constellation at;
    double area;
    dvec3 normal;
};

} // namespace rt::test
