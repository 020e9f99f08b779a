#include "Common/Scene/LightsInMirrors.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "Common/Shared/Material/Metal.h"

namespace rt::scene {
namespace {

using shared::Light;

constexpr std::size_t kMaxMirrors = 64;
constexpr std::uint32_t kMaxLightsInMirrors = 64;
constexpr double kLargestSpot = 16; // its radius, in pixels: larger ones differ less within a pixel
// Radiance in the middle of a spot, over that of the brightest light, that is worth edge rays.
constexpr double kWorthwhileSpot = 0.005;

double greatest(const glm::dvec3& color) {
    return std::max({color.x, color.y, color.z});
}

// A quad of metal that blurs what it reflects.
struct Mirror {
    glm::dvec3 corner;
    glm::dmat3 toSides; // from a vector to its parts along the sides, in units of these, and the normal
    glm::dvec3 normal;  // unit
    double fuzz;        // sine of half the angle of the lobe
    double albedo;

    // Of a place, from its plane to the side of the normal.
    double heightOf(const glm::dvec3& place) const { return glm::dot(place - corner, normal); }

    bool isMet(const glm::dvec3& origin, const glm::dvec3& direction) const {
        const double t = -heightOf(origin) / glm::dot(direction, normal);
        const glm::dvec3 place = toSides * (origin + t * direction - corner);
        return t > 0 && place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1;
    }
};

std::vector<Mirror> blurredMirrors(const CompiledScene& scene) {
    std::vector<Mirror> mirrors;
    for (const shared::Quad& quad : scene.quads) {
        const shared::Material& material = scene.materials[quad.material];
        const float fuzz = material.parameter[shared::kMetalFuzz];
        const bool isBlurred = fuzz > shared::kMirrorFuzz && fuzz <= shared::kBlurredFuzz;
        if (material.kind != shared::kMaterialMetal || !isBlurred) continue;
        const glm::dvec3 normal(quad.normal);
        const glm::dmat3 sides(glm::dvec3(quad.edgeU), glm::dvec3(quad.edgeV), normal);
        mirrors.push_back({quad.corner, glm::inverse(sides), normal, fuzz, greatest(material.albedo)});
    }
    return mirrors;
}

struct Ball {
    glm::dvec3 center;
    double radius;
};

// That holds the light.
Ball ballAround(const Light& light) {
    const glm::dvec3 position(light.position), u(light.edgeU), v(light.edgeV), w(light.normal);
    switch (light.kind) {
        case shared::kLightSphere:
            return {position + 0.5 * u, static_cast<double>(light.radius) + 0.5 * glm::length(u)};
        case shared::kLightEllipsoid:
            return {position, std::max({glm::length(u), glm::length(v), glm::length(w)})};
        case shared::kLightDisk:
            return {position, std::hypot(glm::length(u), glm::length(v))};
        case shared::kLightCylinder:
            return {position + 0.5 * w, std::hypot(glm::length(u), glm::length(v), 0.5 * glm::length(w))};
        default:
            return {position + 0.5 * (u + v), 0.5 * std::max(glm::length(u + v), glm::length(u - v))};
    }
}

// Which lights are seen as spots, and where. All lengths are the world's unless they are said to be pixels.
class SpotImage {
  public:
    SpotImage(const ImagePlane& plane, Silhouettes& edges) : plane_(plane), edges_(edges) {}

    // What the mirror makes of a light of this radiance, its greatest component, if it is more than `least`.
    void add(const Mirror& mirror, const Ball& light, double radiance, double minimum) {
        const double towardsEye = mirror.heightOf(plane_.eye()), height = mirror.heightOf(light.center);
        if (!(towardsEye * height > 0)) return;
        // The spot is a ball behind the mirror: the light's image, as far away as the light, and around it as much as
        // the lobe's width there.
        const glm::dvec3 center = light.center - 2.0 * height * mirror.normal;
        const double distance = glm::length(center - plane_.eye());
        const double blur = mirror.fuzz * distance * height / (height + towardsEye);
        const double share = std::min(1.0, std::pow(light.radius / blur, 2)); // of the lobe that the light fills
        const double reach = (light.radius + blur) / distance * plane_.pixelsPerLength();
        const glm::dvec3 view = plane_.toView(center - plane_.eye());
        if (mirror.albedo * radiance * share < minimum || reach > kLargestSpot || !(view.z > 0)) return;
        draw(mirror, plane_.placeOf(view), reach);
    }

  private:
    // Sets the pixels of a square that show some of the mirror. All lengths are pixels.
    void draw(const Mirror& mirror, const glm::dvec2& middle, double reach) {
        const glm::dvec2 first = glm::max(glm::floor(middle - reach), 0.0);
        const glm::dvec2 end = glm::min(glm::ceil(middle + reach), plane_.size());
        for (double y = first.y; y < end.y; ++y) {
            for (double x = first.x; x < end.x; ++x) {
                const glm::dvec2 corner(x, y);
                if (!shows(corner, mirror)) continue;
                edges_.add(plane_.pixelAt(x, y), middle - reach - corner, middle + reach - corner);
            }
        }
    }

    // In the middle of the pixel or at its corners.
    bool shows(const glm::dvec2& corner, const Mirror& mirror) const {
        constexpr glm::dvec2 kPlaces[] = {{0.5, 0.5}, {0, 0}, {1, 0}, {0, 1}, {1, 1}};
        return std::ranges::any_of(kPlaces, [&](const glm::dvec2& place) {
            return mirror.isMet(plane_.eye(), plane_.directionTo(corner + place));
        });
    }

    const ImagePlane& plane_;
    Silhouettes& edges_;
};

} // namespace

void addLightsInMirrors(const CompiledScene& scene, const ImagePlane& plane, Silhouettes& edges) {
    const std::uint32_t lights = scene.globals.lightCount;
    if (lights > kMaxLightsInMirrors) return;
    const std::vector<Mirror> mirrors = blurredMirrors(scene);
    if (mirrors.empty() || mirrors.size() > kMaxMirrors) return;
    // Radiance; of the sky and punctual lights none that a mirror shows as a spot.
    const auto radianceOf = [](const Light& light) {
        return light.material == shared::kNone ? 0.0 : greatest(light.emission);
    };
    double brightest = 0;
    for (std::uint32_t i = 0; i < lights; ++i) brightest = std::max(brightest, radianceOf(scene.lights[i]));
    SpotImage image(plane, edges);
    for (std::uint32_t i = 0; i < lights; ++i) {
        const Light& light = scene.lights[i];
        const double radiance = radianceOf(light);
        if (radiance == 0.0) continue;
        const Ball ball = ballAround(light);
        for (const Mirror& mirror : mirrors) image.add(mirror, ball, radiance, kWorthwhileSpot * brightest);
    }
}

} // namespace rt::scene
