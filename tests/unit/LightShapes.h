// Lights for tests, and what is known about them. The shading point is the origin.
#pragma once
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "Common/Shared/Base/Types.h"
#include "tests/unit/Oracles.h"

namespace rt::shared {

inline Light flatLight(uint kind, const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV) {
    Light light{};
    light.kind = kind;
    light.position = vec3(corner);
    light.edgeU = vec3(edgeU);
    light.edgeV = vec3(edgeV);
    const glm::dvec3 n = glm::cross(glm::dvec3(light.edgeU), glm::dvec3(light.edgeV));
    light.normal = vec3(glm::normalize(n));
    light.area = static_cast<float>(glm::length(n) * (kind == kLightQuad ? 1 : 0.5));
    light.emission = vec3(1);
    light.sides = kSidesBoth;
    return light;
}

inline Light quad(const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV) {
    return flatLight(kLightQuad, corner, edgeU, edgeV);
}

inline Light triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return flatLight(kLightTriangle, a, b - a, c - a);
}

inline Light sphere(const glm::dvec3& center, double radius) {
    Light light{};
    light.kind = kLightSphere;
    light.position = vec3(center);
    light.radius = static_cast<float>(radius);
    light.area = static_cast<float>(4 * test::kPi * radius * radius);
    light.emission = vec3(1);
    light.sides = kSidesFront;
    return light;
}

// The unit sphere's, moved and stretched.
inline Light ellipsoid(const glm::dvec3& center, const glm::dmat3& axes, uint sides = kSidesFront) {
    Light light = sphere(center, 1);
    light.kind = kLightEllipsoid;
    light.edgeU = vec3(axes[0]);
    light.edgeV = vec3(axes[1]);
    light.normal = vec3(axes[2]);
    light.sides = sides;
    return light;
}

inline glm::dmat3 axesOf(const Light& ellipsoid) {
    return {ellipsoid.edgeU, ellipsoid.edgeV, ellipsoid.normal};
}

inline std::vector<glm::dvec3> vertices(const Light& light) {
    const glm::dvec3 p(light.position), u(light.edgeU), v(light.edgeV);
    if (light.kind == kLightTriangle) return {p, p + u, p + v};
    return {p, p + u, p + u + v, p + v};
}

// Of a surface with this normal, under radiance 1.
inline double irradiance(const Light& light, const glm::dvec3& normal) {
    if (light.kind == kLightSphere) return test::sphereIrradiance(glm::dvec3(light.position), light.radius, normal);
    if (light.kind == kLightEllipsoid)
        return test::polygonIrradiance(test::ellipsoidOutline(glm::dvec3(light.position), axesOf(light)), normal);
    return test::polygonIrradiance(vertices(light), normal);
}

} // namespace rt::shared
