#include "Common/Scene/Compiler/LightTable.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Scene/Compiler/GridCdf.h"
#include "Common/Scene/Compiler/LightTree.h"
#include "Common/Scene/Compiler/TextureTable.h"
#include "Common/Shared/Light/PunctualLight.h"

namespace rt::scene {

namespace {

shared::Light emptyLight(std::uint32_t kind) {
    shared::Light light{};
    light.kind = kind;
    light.material = shared::kNone;
    light.sides = shared::kSidesBoth;
    return light;
}

bool isFlat(const shared::Light& light) {
    return light.kind == shared::kLightQuad || light.kind == shared::kLightTriangle || light.kind == shared::kLightDisk;
}

// Flux in the surrounding space.
double power(const shared::Light& light) {
    return luminance(light.emission) * std::numbers::pi * emittingArea(light);
}

// Centre of the least circle around the triangle (0, u, v): in its plane, so that a point is before the triangle if and
// only if it is before the centre.
glm::dvec3 enclosingCenter(const glm::dvec3& u, const glm::dvec3& v) {
    const double uu = glm::dot(u, u), vv = glm::dot(v, v), uv = glm::dot(u, v);
    if (uv <= 0) return 0.5 * (u + v); // the angle at 0 is obtuse
    if (uv >= uu) return 0.5 * v;      // at u
    if (uv >= vv) return 0.5 * u;      // at v
    const double scale = 0.5 / (uu * vv - uv * uv);
    return scale * (vv * (uu - uv) * u + uu * (vv - uv) * v);
}

double longestHalfAxis(const shared::Light& ellipsoid) {
    const glm::dmat3 axes = orthogonalColumns({ellipsoid.edgeU, ellipsoid.edgeV, ellipsoid.normal});
    return std::max({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
}

constexpr double kSteepestEdge = 1e12; // of a spot: keeps it finite where the angles are as good as the same
// Directional lights are bounded as points so many radii of the scene away from its middle.
constexpr float kDistantRadii = 1000;
constexpr float kPointRadius = 1e-12f; // protects what a point contributes at its very place from a division by zero

// Spots are taken for flat lights, whose cosine is positive wherever a cone of at most half the directions reaches.
shared::LightBound punctualBound(const shared::Light& light) {
    const auto luminous = static_cast<float>(luminance(light.emission));
    shared::LightBound bound{};
    bound.center = light.position;
    bound.radius = kPointRadius;
    bound.intensity = luminous;
    bound.omnidirectional = 1;
    if (light.kind == shared::kLightSpot) {
        bound.axis = light.normal;
        bound.omnidirectional = 0;
    }
    if (light.kind == shared::kLightDirectional) {
        // Seen from anywhere in the scene the true direction is one to a point in the sphere around the distant one:
        // where the light contributes a part of the sphere is above the horizon. The margin is for rounding.
        const float distance = kDistantRadii * light.radius;
        bound.center -= distance * light.normal;
        bound.radius = light.radius * 1.001f;
        bound.intensity = luminous * distance * distance;
    }
    return bound;
}

// Of a disk or cylinder. A cylinder's intensity is greatest across its axis: emission times diameter times height,
// which is its area over pi.
shared::LightBound roundBound(const shared::Light& light, shared::LightBound bound) {
    const glm::dvec3 u(light.edgeU), v(light.edgeV);
    const double uu = glm::dot(u, u), vv = glm::dot(v, v);
    const double radius = std::sqrt(0.5 * (uu + vv) + std::hypot(0.5 * (uu - vv), glm::dot(u, v)));
    const double luminous = luminance(light.emission);
    bound.center = light.position;
    if (light.kind == shared::kLightDisk) {
        bound.radius = static_cast<float>(radius);
        bound.axis = light.normal;
        bound.twoSided = light.sides == shared::kSidesBoth ? 1.0f : 0.0f;
        bound.intensity = static_cast<float>(luminous * light.area);
    } else {
        bound.center += 0.5f * light.normal;
        bound.radius = static_cast<float>(radius + 0.5 * glm::length(light.normal));
        const double walls = light.sides == shared::kSidesBoth ? 2 : 1;
        bound.intensity = static_cast<float>(luminous * walls * light.area / std::numbers::pi);
    }
    bound.radius *= 1 + 4 * shared::kEpsilon;
    return bound;
}

shared::LightBound boundOf(const shared::Light& light) {
    if (shared::isPunctual(shared::kFeatureAll, light)) return punctualBound(light);
    shared::LightBound bound{};
    const double luminous = luminance(light.emission);
    bound.omnidirectional = isFlat(light) ? 0.0f : 1.0f;
    if (light.kind == shared::kLightEllipsoid) {
        bound.center = light.position;
        bound.radius = static_cast<float>(longestHalfAxis(light)) * (1 + 4 * shared::kEpsilon);
        // By Cauchy's formula the mean of the areas under which a convex body is seen is a quarter of its surface.
        bound.intensity = static_cast<float>(luminous * 0.25 * light.area);
        return bound;
    }
    if (light.kind == shared::kLightCylinder || light.kind == shared::kLightDisk) return roundBound(light, bound);
    if (!isFlat(light)) {
        bound.center = light.position + 0.5f * light.edgeU; // the middle of a moving sphere's way
        bound.radius = light.radius + 0.5f * glm::length(light.edgeU);
        bound.intensity = static_cast<float>(luminous * std::numbers::pi * light.radius * light.radius);
        return bound;
    }
    const glm::dvec3 u(light.edgeU), v(light.edgeV);
    const glm::dvec3 middle = light.kind == shared::kLightQuad ? 0.5 * (u + v) : enclosingCenter(u, v);
    double radius = 0;
    for (const glm::dvec3& vertex : {glm::dvec3(0), u, v}) radius = std::max(radius, glm::length(vertex - middle));
    bound.center = light.position + shared::vec3(middle);
    bound.radius = static_cast<float>(radius);
    bound.radius *= 1 + 4 * shared::kEpsilon;
    bound.axis = light.normal;
    bound.twoSided = light.sides == shared::kSidesBoth ? 1.0f : 0.0f;
    bound.intensity = static_cast<float>(luminous * light.area);
    return bound;
}

} // namespace

double luminance(const glm::dvec3& color) {
    return 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z;
}

double emittingArea(const shared::Light& light) {
    const double sides = isFlat(light) && light.sides == shared::kSidesBoth ? 2 : 1;
    return light.area * sides;
}

shared::Light sphereLight(const shared::Sphere& sphere, const shared::vec3& motion) {
    shared::Light light = emptyLight(shared::kLightSphere);
    light.position = sphere.center;
    light.edgeU = motion;
    if (sphere.power < shared::kInfinity) light.edgeV = shared::vec3(sphere.power, 1.0f, 0.0f);
    light.radius = sphere.radius;
    light.area = static_cast<float>(4 * std::numbers::pi * sphere.radius * sphere.radius);
    return light;
}

shared::Light ellipsoidLight(const Affine& toWorld) {
    shared::Light light = emptyLight(shared::kLightEllipsoid);
    light.position = shared::vec3(toWorld.offset);
    light.edgeU = shared::vec3(toWorld.linear[0]);
    light.edgeV = shared::vec3(toWorld.linear[1]);
    light.normal = shared::vec3(toWorld.linear[2]);
    // Thomsen's approximation of the area, off by at most 1.061 %.
    constexpr double p = 1.6075;
    const glm::dmat3 axes = orthogonalColumns(toWorld.linear);
    const double a = glm::length(axes[0]), b = glm::length(axes[1]), c = glm::length(axes[2]);
    const double meanPower = (std::pow(a * b, p) + std::pow(a * c, p) + std::pow(b * c, p)) / 3;
    const double squaredRadius = std::pow(meanPower, 1 / p);
    light.radius = static_cast<float>(std::sqrt(squaredRadius));
    light.area = static_cast<float>(4 * std::numbers::pi * squaredRadius);
    return light;
}

shared::Light quadLight(const shared::Quad& quad) {
    shared::Light light = emptyLight(shared::kLightQuad);
    light.position = quad.corner;
    light.edgeU = quad.edgeU;
    light.edgeV = quad.edgeV;
    light.normal = quad.normal;
    light.area = static_cast<float>(glm::length(glm::cross(glm::dvec3(quad.edgeU), glm::dvec3(quad.edgeV))));
    return light;
}

shared::Light diskLight(const shared::Round& disk) {
    shared::Light light = emptyLight(shared::kLightDisk);
    light.position = disk.origin;
    light.edgeU = disk.edgeU;
    light.edgeV = disk.edgeV;
    light.normal = disk.axis;
    light.radius = disk.hole;
    const glm::dvec3 u(disk.edgeU), v(disk.edgeV);
    const double hole = disk.hole;
    light.area = static_cast<float>(std::numbers::pi * glm::length(glm::cross(u, v)) * (1 - hole) * (1 + hole));
    return light;
}

shared::Light cylinderLight(const shared::Round& cylinder) {
    constexpr int kSteps = 256; // of its circumference: the sum over a period converges fast
    shared::Light light = emptyLight(shared::kLightCylinder);
    light.position = cylinder.origin;
    light.edgeU = cylinder.edgeU;
    light.edgeV = cylinder.edgeV;
    light.normal = cylinder.axis;
    const glm::dvec3 u(cylinder.edgeU), v(cylinder.edgeV), w(cylinder.axis);
    double area = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double turn = 2 * std::numbers::pi * i / kSteps;
        area += glm::length(glm::cross(std::cos(turn) * v - std::sin(turn) * u, w)) * 2 * std::numbers::pi / kSteps;
    }
    light.area = static_cast<float>(area);
    light.radius = static_cast<float>(std::sqrt(area / (4 * std::numbers::pi)));
    return light;
}

shared::Light triangleLight(const shared::vec3& a, const shared::vec3& b, const shared::vec3& c) {
    shared::Light light = emptyLight(shared::kLightTriangle);
    light.position = a;
    light.edgeU = b - a;
    light.edgeV = c - a;
    const glm::dvec3 normal = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    light.normal = shared::vec3(glm::normalize(normal));
    light.area = static_cast<float>(0.5 * glm::length(normal));
    return light;
}

shared::Light pointLight(const glm::dvec3& position, const glm::dvec3& intensity) {
    shared::Light light = emptyLight(shared::kLightPoint);
    light.position = shared::vec3(position);
    light.emission = shared::vec3(intensity);
    light.area = 4;
    return light;
}

shared::Light spotLight(const glm::dvec3& position, const glm::dvec3& direction, const glm::dvec3& intensity,
                        double innerAngle, double outerAngle) {
    // 1 - cos, without its cancellation.
    const auto versine = [](double angle) { return 2 * std::sin(0.5 * angle) * std::sin(0.5 * angle); };
    const double inner = versine(innerAngle), outer = versine(outerAngle);
    shared::Light light = emptyLight(shared::kLightSpot);
    light.position = shared::vec3(position);
    light.normal = shared::vec3(direction);
    light.emission = shared::vec3(intensity);
    light.edgeU = shared::vec3(outer, std::min(1 / (outer - inner), kSteepestEdge), 0);
    // Between the angles the intensity is a square, whose mean is a third.
    light.area = static_cast<float>(2 * (inner + (outer - inner) / 3));
    return light;
}

shared::Light directionalLight(const glm::dvec3& direction, const glm::dvec3& irradiance) {
    shared::Light light = emptyLight(shared::kLightDirectional);
    light.normal = shared::vec3(direction);
    light.emission = shared::vec3(irradiance);
    return light;
}

void placeDirectionalLights(const Bounds& bounds, CompiledScene& out) {
    for (shared::Light& light : out.lights) {
        if (light.kind != shared::kLightDirectional) continue;
        light.position = shared::vec3(bounds.center());
        light.radius = std::max(static_cast<float>(bounds.radius()), kPointRadius);
        light.area = light.radius * light.radius;
    }
}

bool appendSkyLight(const Bounds& bounds, CompiledScene& out) {
    const shared::Image& image = out.images[out.globals.skyImage];
    std::vector<double> rows(image.height), columns(image.width);
    std::vector<float> columnCdfs;
    glm::dvec3 sum(0);
    double weight = 0;
    for (std::uint32_t y = 0; y < image.height; ++y) {
        // The solid angle of a texel is in proportion to the difference of cosines, that is to sin(theta) of its
        // middle.
        const double sine = std::sin(std::numbers::pi * (y + 0.5) / image.height);
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const glm::dvec3 color = texelColor(out, image, x, y) * glm::dvec3(out.globals.skyTop);
            columns[x] = std::max(0.0, luminance(color));
            rows[y] += columns[x] * sine;
            sum += color * sine;
        }
        weight += sine * image.width;
        const std::vector<float> cdf = gridCdf(columns);
        columnCdfs.insert(columnCdfs.end(), cdf.begin(), cdf.end());
    }
    if (!(luminance(sum) > 0)) return false;
    out.skyCdf = gridCdf(rows);
    out.skyCdf.insert(out.skyCdf.end(), columnCdfs.begin(), columnCdfs.end());

    shared::Light light = emptyLight(shared::kLightSky);
    light.position = shared::vec3(bounds.center());
    light.radius = static_cast<float>(bounds.radius());
    light.area = static_cast<float>(4 * std::numbers::pi * bounds.radius() * bounds.radius());
    light.emission = shared::vec3(sum / weight);
    out.globals.skyLight = static_cast<std::uint32_t>(out.lights.size());
    out.lights.push_back(light);
    return true;
}

void finishLights(CompiledScene& out) {
    if (out.lights.size() > kCdfCells)
        throw InputError(out.id + ": " + std::to_string(out.lights.size()) +
                         " lights, at most 2^24 can be told apart: " + "give the small ones \"light\": false");
    std::vector<double> powers;
    powers.reserve(out.lights.size());
    out.lightBounds.reserve(out.lights.size());
    for (const shared::Light& light : out.lights) {
        powers.push_back(power(light));
        out.lightBounds.push_back(boundOf(light));
    }
    const std::vector<float> cdf = gridCdf(powers);
    for (std::size_t i = 0; i < out.lights.size(); ++i) {
        out.lights[i].cdf = cdf[i + 1];
        out.lights[i].selection = cdf[i + 1] - cdf[i];
    }
    out.globals.lightCount = static_cast<std::uint32_t>(out.lights.size());
    buildLightTree(out);
}

void appendTarget(const shared::Light& target, CompiledScene& out) {
    out.lights.push_back(target);
    out.lights.back().cdf = 1.0f;
    out.lightBounds.push_back(boundOf(target));
    ++out.globals.targetCount;
}

} // namespace rt::scene
