#include "Common/Scene/LightsInSpheres.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "Common/Scene/Compiler/SpecularCasters.h"
#include "Common/Scene/ImagePlane.h"
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Material/Dielectric.h"
#include "Common/Shared/Shape/Shapes.h"

namespace rt::scene {
namespace {

using shared::Light;
using shared::Ray;
using shared::vec3;

constexpr std::size_t kMaxSpheres = 1024;
constexpr std::size_t kSpheresSeen = 16; // those that the camera sees best
constexpr std::uint32_t kMaxLights = 64;
constexpr double kMaxCells = 32768; // of all spheres: their sides and middles take milliseconds
// Variance of a sample, over the square of the brightest light's radiance, that is worth edge rays.
constexpr double kWorthwhile = 0.01;
constexpr float kFar = std::numeric_limits<float>::max();

double squareOf(const vec3& radiance) {
    return static_cast<double>(glm::dot(radiance, radiance));
}

// A light that a ray may meet.
class Lamp {
  public:
    explicit Lamp(const Light& light) : light_(light) {
        if (light.kind == shared::kLightQuad) frame_ = shared::quadFrame(light.edgeU, light.edgeV);
        if (light.kind == shared::kLightEllipsoid)
            toUnit_ = glm::inverse(glm::mat3(light.edgeU, light.edgeV, light.normal));
    }

    // The distance, less than `most`, at which the ray meets it; otherwise one that is not positive.
    float meet(const Ray& ray, float maximum) const {
        const vec3 u = light_.edgeU, v = light_.edgeV;
        switch (light_.kind) {
            case shared::kLightSphere:
                return shared::intersectSphere(ray, light_.position + 0.5f * u, light_.radius, maximum);
            case shared::kLightQuad:
                return shared::intersectQuad(ray, light_.position, frame_, maximum).t;
            case shared::kLightTriangle:
                return shared::intersectTriangle(ray, light_.position, light_.position + u, light_.position + v,
                                                 maximum)
                    .t;
            case shared::kLightEllipsoid: {
                Ray unit = ray;
                unit.origin = toUnit_ * (ray.origin - light_.position);
                unit.direction = toUnit_ * ray.direction;
                return shared::intersectSphere(unit, vec3(0.0f), 1.0f, maximum);
            }
            default:
                return -1;
        }
    }

    vec3 radianceTowards(const vec3& direction) const {
        const bool isFlat = light_.kind == shared::kLightQuad || light_.kind == shared::kLightTriangle;
        const bool isSeen = !isFlat || light_.sides == shared::kSidesBoth || glm::dot(direction, light_.normal) > 0.0f;
        return isSeen ? light_.emission : vec3(0.0f);
    }

  private:
    const Light& light_;
    shared::QuadFrame frame_{};
    glm::mat3 toUnit_{1.0f};
};

// What a ray from the camera sees of lights by way of a sphere, reflected or refracted by chance.
struct View {
    double second = 0; // moment of the radiance: mean over the chances, sum over the channels
    vec3 mean{0.0f};

    View& operator+=(const View& other) {
        second += other.second;
        mean += other.mean;
        return *this;
    }
};

// A rectangle of the image, in pixels.
struct Window {
    double left = 0, top = 0, right = 0, bottom = 0;
};

class LampSearch {
  public:
    LampSearch(const CompiledScene& scene, const shared::Camera& camera, std::uint32_t width, std::uint32_t height,
               Silhouettes& edges)
        : camera_(camera), plane_(camera, width, height), width_(width), height_(height), edges_(edges) {
        for (std::uint32_t i = 0; i < scene.globals.lightCount; ++i) {
            lamps_.emplace_back(scene.lights[i]);
            brightest_ = std::max(brightest_, squareOf(scene.lights[i].emission));
        }
    }

    // In so many cells of the image at most.
    void lookAt(const shared::SpecularCaster& sphere, double maxCells) {
        sphere_ = sphere;
        center_ = sphere.center + 0.5f * sphere.motion;
        const Window window = windowOf();
        const double area = (window.right - window.left) * (window.bottom - window.top);
        if (!(area > 0)) return;
        const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(std::max(1.0, area / maxCells))));
        const auto left = static_cast<std::uint32_t>(window.left), top = static_cast<std::uint32_t>(window.top);
        const auto columns = static_cast<std::uint32_t>(std::ceil((window.right - left) / side));
        std::array<std::vector<View>, 3> rows; // of a row of cells: above, across and below them
        rows[0] = viewsAlong(left, top, columns, side);
        for (std::uint32_t y = top; y < window.bottom; y += side) {
            rows[1] = viewsAlong(left, y + 0.5 * side, columns, side);
            rows[2] = viewsAlong(left, y + side, columns, side);
            for (std::uint32_t i = 0; i < columns; ++i)
                if (varianceIn(rows, 2 * std::size_t{i}) > kWorthwhile * brightest_) add(left + i * side, y, side);
            rows[0] = std::move(rows[2]);
        }
    }

  private:
    // That which holds the sphere's outline, seen from the camera; all of the image where a part of it is behind.
    Window windowOf() const {
        constexpr int kCorners = 64;
        constexpr double kMargin = 1.5; // pixels, and chords are shorter than arcs
        const glm::dvec2 size = plane_.size();
        const glm::dvec3 towards = glm::dvec3(center_) - plane_.eye();
        const double distance = glm::length(towards), sine = static_cast<double>(sphere_.radius) / distance;
        if (!(sine < 1.0)) return {}; // the camera is inside
        const glm::dvec3 along = towards / distance;
        const shared::Frame around = shared::makeFrame(vec3(along));
        const glm::dvec3 x(around.tangent), y(around.bitangent);
        const double reach = sine / std::sqrt(1 - sine * sine) / std::cos(std::numbers::pi / kCorners);
        glm::dvec2 low = size, high(0.0);
        int behind = 0;
        for (int i = 0; i < kCorners; ++i) {
            const double angle = 2 * std::numbers::pi * i / kCorners;
            const glm::dvec3 p = plane_.toView(along + reach * (std::cos(angle) * x + std::sin(angle) * y));
            if (!(p.z > 0)) {
                ++behind;
                continue;
            }
            low = glm::min(low, plane_.placeOf(p));
            high = glm::max(high, plane_.placeOf(p));
        }
        if (behind == kCorners) return {};
        if (behind > 0) return {0, 0, size.x, size.y};
        low = glm::clamp(low - kMargin, glm::dvec2(0.0), size);
        high = glm::clamp(high + kMargin, glm::dvec2(0.0), size);
        return {std::floor(low.x), std::floor(low.y), high.x, high.y};
    }

    static double varianceIn(const std::array<std::vector<View>, 3>& rows, std::size_t first) {
        View sum;
        for (const std::vector<View>& row : rows)
            for (std::size_t i = first; i <= first + 2; ++i) sum += row[i];
        return sum.second / 9 - squareOf(sum.mean / 9.0f);
    }

    // At the sides and the middles of a row of cells.
    std::vector<View> viewsAlong(std::uint32_t left, double y, std::uint32_t columns, std::uint32_t side) const {
        std::vector<View> views(2 * std::size_t{columns} + 1);
        const vec3 begin = camera_.corner + camera_.down * static_cast<float>(y / height_);
        for (std::size_t i = 0; i < views.size(); ++i) {
            const double x = left + 0.5 * side * static_cast<double>(i);
            views[i] = viewAlong(begin + camera_.across * static_cast<float>(x / width_));
        }
        return views;
    }

    void add(std::uint32_t left, std::uint32_t top, std::uint32_t side) {
        const std::uint64_t right = std::min(left + side, width_) - 1;
        for (std::uint64_t y = top; y < std::min(top + side, height_); ++y)
            for (std::uint64_t x = left; x <= right; ++x) edges_.addWhole(y * width_ + x);
    }

    View viewAlong(const vec3& direction) const {
        Ray ray{};
        ray.origin = camera_.origin;
        ray.direction = glm::normalize(direction);
        const float t = shared::intersectSphere(ray, center_, sphere_.radius, kFar);
        View view;
        if (!(t > 0.0f)) return view;
        const vec3 point = ray.origin + ray.direction * t;
        const vec3 normal = (point - center_) / sphere_.radius;
        const float cosine = std::clamp(-glm::dot(ray.direction, normal), 0.0f, 1.0f);
        if (sphere_.crossings == shared::kReflectedOutside) {
            look(point, normal, glm::reflect(ray.direction, normal), 1.0f, sphere_.tint, view);
            return view;
        }
        const float eta = sphere_.inverseEta;
        const shared::vec2 f = shared::fresnel(std::max(cosine, 1e-6f), eta);
        const float reflected = f.x, inside = f.y; // the cosine of the refracted ray
        look(point, normal, glm::reflect(ray.direction, normal), reflected, vec3(1.0f), view);
        // In, across the ball, and out by the same angles.
        const vec3 across = eta * ray.direction + (eta * cosine - inside) * normal;
        const vec3 end = point + across * (2.0f * inside * sphere_.radius);
        const vec3 outwards = (end - center_) / sphere_.radius;
        const vec3 out = (across - inside * outwards) / eta + cosine * outwards;
        look(end, outwards, out, (1.0f - reflected) * (1.0f - reflected), sphere_.tint, view);
        return view;
    }

    void look(const vec3& point, const vec3& normal, const vec3& direction, float probability, const vec3& tint,
              View& view) const {
        constexpr float kClear = 1e-4f; // of the radius, from the sphere
        Ray ray{};
        ray.origin = point + normal * (kClear * sphere_.radius);
        ray.direction = direction;
        float nearest = kFar;
        const Lamp* met = nullptr;
        for (const Lamp& lamp : lamps_) {
            const float t = lamp.meet(ray, nearest);
            if (!(t > 0.0f && t < nearest)) continue;
            nearest = t;
            met = &lamp;
        }
        if (met == nullptr) return;
        const vec3 radiance = tint * met->radianceTowards(-direction);
        view.second += static_cast<double>(probability) * squareOf(radiance);
        view.mean += probability * radiance;
    }

    const shared::Camera& camera_;
    ImagePlane plane_;
    std::uint32_t width_, height_;
    Silhouettes& edges_;
    std::vector<Lamp> lamps_;
    double brightest_ = 0; // sum of the squares of its radiance
    shared::SpecularCaster sphere_{};
    vec3 center_{0.0f};
};

} // namespace

void addLightsInSpheres(const CompiledScene& scene, const shared::Camera& camera, std::uint32_t width,
                        std::uint32_t height, Silhouettes& edges) {
    if (scene.globals.lightCount > kMaxLights) return;
    std::vector<shared::SpecularCaster> spheres = allSpecularCasters(scene, kMaxSpheres);
    if (spheres.empty()) return;
    const auto distance = [&](const shared::SpecularCaster& sphere) {
        return glm::length(sphere.center - camera.origin) / sphere.radius;
    };
    std::ranges::stable_sort(spheres, {}, distance);
    spheres.resize(std::min(spheres.size(), kSpheresSeen));
    LampSearch search(scene, camera, width, height, edges);
    const double cells = kMaxCells / static_cast<double>(spheres.size());
    for (const shared::SpecularCaster& sphere : spheres) search.lookAt(sphere, cells);
}

} // namespace rt::scene
