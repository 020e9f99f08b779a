#include "Common/Scene/Silhouettes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "Common/Scene/ImagePlane.h"
#include "Common/Scene/LightsInMirrors.h"
#include "Common/Scene/LightsInSpheres.h"

namespace rt::scene {
namespace {

using shared::Light;

bool isRound(const Light& light) {
    return light.kind == shared::kLightSphere || light.kind == shared::kLightEllipsoid;
}

bool isPolygon(const Light& light) {
    return light.kind == shared::kLightQuad || light.kind == shared::kLightTriangle;
}

// The image, on which lines in space are drawn.
class EdgeImage {
  public:
    EdgeImage(const ImagePlane& plane, const shared::Camera& camera, Silhouettes& edges)
        : plane_(plane), edges_(edges) {
        const glm::dvec3 u = plane_.toView(camera.lensU), v = plane_.toView(camera.lensV);
        lens_ = plane_.size() * glm::dvec2(std::hypot(u.x, v.x), std::hypot(u.y, v.y));
    }

    const glm::dvec3& eye() const { return plane_.eye(); }

    // Pixels that a length takes across the view at this distance, about, but no more than matter.
    double pixels(double length, double distance) const {
        return std::min(length * plane_.pixelsPerLength() / std::max(distance, 1e-6 * length), 1e6);
    }

    // A side of the outline of a light: pixels that the line from a to b crosses, or comes as near to as `margin`
    // pixels, have edges.
    void addLine(const glm::dvec3& a, const glm::dvec3& b, double margin) {
        glm::dvec3 from = plane_.toView(a - eye()), to = plane_.toView(b - eye());
        if (from.z > to.z) std::swap(from, to);
        const double nearest = kNearest * to.z;
        if (!(to.z > 0.0)) return;
        if (from.z < nearest) {
            from += (to - from) * ((nearest - from.z) / (to.z - from.z));
            isCut_ = true;
        }
        // What is out of focus is blurred: the further from its plane, the more.
        const double blur = std::max(std::abs(1.0 - 1.0 / from.z), std::abs(1.0 - 1.0 / to.z));
        lines_.push_back({plane_.placeOf(from), plane_.placeOf(to), lens_ * blur + margin});
    }

    // Draws the lines that have been added. `isWhole`: they are the whole outline of a light, which covers nothing
    // beyond them.
    void draw(bool isWhole) {
        glm::dvec2 low = plane_.size(), high(0.0);
        for (const Line& line : lines_) {
            low = glm::min(low, glm::min(line.a, line.b) - line.reach);
            high = glm::max(high, glm::max(line.a, line.b) + line.reach);
        }
        if (isCut_ || !isWhole) {
            low = glm::dvec2(0.0);
            high = plane_.size();
        }
        for (const Line& line : lines_) drawLine(line, low, high);
        lines_.clear();
        isCut_ = false;
    }

  private:
    // Of the distance of a line's far end: what is nearer to the camera's own plane is cut off.
    static constexpr double kNearest = 1e-3;

    // In pixels, and how far to its sides edges are blurred.
    struct Line {
        glm::dvec2 a, b, reach;
    };

    // Of a light within a rectangle.
    void drawLine(const Line& line, const glm::dvec2& low, const glm::dvec2& high) {
        const glm::dvec2 reach = line.reach;
        glm::dvec2 a = line.a, b = line.b;
        if (a.y > b.y) std::swap(a, b);
        const double first = std::max(std::floor(a.y - reach.y), 0.0);
        const double last = std::min(std::floor(b.y + reach.y), plane_.size().y - 1.0);
        const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0.0;
        for (double row = first; row <= last; ++row) {
            // The part of the line that comes near enough to this row.
            double enter = a.x, leave = b.x;
            if (row - reach.y > a.y) enter = a.x + slope * (row - reach.y - a.y);
            if (row + 1.0 + reach.y < b.y) leave = a.x + slope * (row + 1.0 + reach.y - a.y);
            const double left = std::max(std::floor(std::min(enter, leave) - reach.x), 0.0);
            const double right = std::min(std::floor(std::max(enter, leave) + reach.x), plane_.size().x - 1.0);
            if (left > right) continue;
            for (double column = left; column <= right; ++column) {
                const glm::dvec2 corner(column, row);
                edges_.add(plane_.pixelAt(column, row), low - corner, high - corner);
            }
        }
    }

    const ImagePlane& plane_;
    glm::dvec2 lens_; // half axes of the blur of what is infinitely far away, in pixels
    Silhouettes& edges_;
    std::vector<Line> lines_;
    bool isCut_ = false; // a part of them is behind the camera
};

// ---- round lights --------------------------------------------------------------------------------------------------

// The unit sphere under an affine map.
struct Ellipsoid {
    glm::dvec3 center;
    glm::dmat3 axes;
};

// What of it the eye sees ends on a circle of the unit sphere, whose plane is across the direction to the eye.
void drawOutline(const Ellipsoid& light, double pixels, EdgeImage& image) {
    const glm::dvec3 eye = glm::inverse(light.axes) * (image.eye() - light.center);
    const double distance = glm::length(eye);
    if (!(distance > 1.0 && std::isfinite(distance))) return;
    const glm::dvec3 towards = eye / distance;
    const glm::dvec3 side = std::abs(towards.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(towards, side)), y = glm::cross(towards, x);
    const double radius = std::sqrt(1.0 - 1.0 / (distance * distance));
    // Chords are off by pixels * (pi / corners)^2 / 2.
    const int corners = static_cast<int>(std::clamp(7.0 * std::sqrt(pixels), 8.0, 1024.0));
    const double off = pixels * 0.5 * std::pow(std::numbers::pi / corners, 2);
    const auto corner = [&](int i) {
        const double angle = 2.0 * std::numbers::pi * i / corners;
        return light.center + light.axes * (towards / distance + radius * (std::cos(angle) * x + std::sin(angle) * y));
    };
    glm::dvec3 from = corner(0);
    for (int i = 1; i <= corners; ++i) {
        const glm::dvec3 to = corner(i);
        image.addLine(from, to, off);
        from = to;
    }
}

void drawRound(const Light& light, EdgeImage& image) {
    constexpr double kMaxSteps = 64.0;
    const glm::dvec3 center(light.position);
    const double distance = glm::length(center - image.eye());
    if (light.kind == shared::kLightEllipsoid) {
        const glm::dmat3 axes(light.edgeU, light.edgeV, light.normal);
        const double longest = std::max({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
        drawOutline({center, axes}, image.pixels(longest, distance), image);
        image.draw(true);
        return;
    }
    // One that moves is drawn where it is a pixel further on.
    const glm::dvec3 way(light.edgeU);
    const double steps = std::clamp(std::ceil(image.pixels(glm::length(way), distance)), 1.0, kMaxSteps);
    for (double i = 0; i < (way == glm::dvec3(0.0) ? 1.0 : steps + 1.0); ++i) {
        drawOutline({center + way * (i / steps), glm::dmat3(light.radius)}, image.pixels(light.radius, distance),
                    image);
    }
    image.draw(true);
}

// ---- flat lights ---------------------------------------------------------------------------------------------------

constexpr double kRounding = 0.01; // pixels

void drawQuad(const Light& light, EdgeImage& image) {
    const glm::dvec3 corner(light.position), u(light.edgeU), v(light.edgeV);
    image.addLine(corner, corner + u, kRounding);
    image.addLine(corner, corner + v, kRounding);
    image.addLine(corner + u, corner + u + v, kRounding);
    image.addLine(corner + v, corner + u + v, kRounding);
    image.draw(true);
}

// Positions on a grid so fine that only those of one vertex share a place, but for where rounding parts them.
using GridPlace = std::array<std::int64_t, 3>;

struct TriangleEdge {
    GridPlace first, second; // first <= second
    bool isFront;            // the eye sees the triangle's front side
    std::uint32_t triangle;  // among the lights
    glm::dvec3 a, b;
    auto key() const { return std::tie(first, second, isFront); }
};

void appendEdges(const Light& light, std::uint32_t index, bool isFront, double grid, std::vector<TriangleEdge>& edges) {
    const glm::dvec3 corners[] = {light.position, light.position + light.edgeU, light.position + light.edgeV};
    GridPlace places[3];
    for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
            places[i][static_cast<std::size_t>(c)] = static_cast<std::int64_t>(std::round(corners[i][c] / grid));
    for (int i = 0; i < 3; ++i) {
        const int k = (i + 1) % 3;
        edges.push_back(
            {std::min(places[i], places[k]), std::max(places[i], places[k]), isFront, index, corners[i], corners[k]});
    }
}

// Draws the edges that only one triangle has, of all triangles that face the same way.
void drawBorders(std::vector<TriangleEdge>& edges, EdgeImage& image) {
    std::ranges::sort(edges, {}, &TriangleEdge::key);
    std::vector<TriangleEdge> borders;
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t next = i + 1;
        while (next < edges.size() && edges[next].key() == edges[i].key()) ++next;
        if (next == i + 1) borders.push_back(edges[i]);
        i = next;
    }
    std::ranges::sort(borders, {}, &TriangleEdge::triangle);
    for (std::size_t i = 0; i < borders.size();) {
        const std::uint32_t triangle = borders[i].triangle;
        const std::size_t first = i;
        for (; i < borders.size() && borders[i].triangle == triangle; ++i)
            image.addLine(borders[i].a, borders[i].b, kRounding);
        image.draw(i - first == 3);
    }
}

double largestCoordinate(const std::vector<Light>& lights) {
    float largest = 0;
    for (const Light& light : lights) {
        const bool isSphere = light.kind == shared::kLightSphere; // whose edgeV is no length
        for (const shared::vec3& p : {light.position, light.edgeU, isSphere ? light.edgeU : light.edgeV})
            largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    return largest;
}

// Where the steps of a pixel begin that hold what is between these places, and 16 bits above it where they end.
std::uint32_t stepsBetween(double begin, double end) {
    constexpr double kSteps = 255.0;
    const double first = std::clamp(std::floor(kSteps * begin), 0.0, kSteps - 1.0);
    const double last = std::clamp(std::ceil(kSteps * end), first + 1.0, kSteps);
    return static_cast<std::uint32_t>(first) | static_cast<std::uint32_t>(last) << 16;
}

} // namespace

void Silhouettes::add(std::uint64_t pixel, const glm::dvec2& begin, const glm::dvec2& end) {
    const std::uint32_t part = stepsBetween(begin.x, end.x) | stepsBetween(begin.y, end.y) << 8;
    std::uint32_t& all = parts[pixel];
    if (all == 0) {
        all = part;
        ++count;
        return;
    }
    std::uint32_t united = 0;
    for (std::uint32_t shift = 0; shift < 32; shift += 8) {
        const std::uint32_t a = all >> shift & 255, b = part >> shift & 255;
        united |= (shift < 16 ? std::min(a, b) : std::max(a, b)) << shift;
    }
    all = united;
}

std::vector<std::uint32_t> Silhouettes::bits() const {
    std::vector<std::uint32_t> words((parts.size() + 31) / 32);
    for (std::size_t pixel = 0; pixel < parts.size(); ++pixel)
        words[pixel / 32] |= static_cast<std::uint32_t>(parts[pixel] != 0) << pixel % 32;
    return words;
}

bool mayHaveSilhouettes(const CompiledScene& scene) {
    const auto hasShape = [](const Light& light) { return isRound(light) || isPolygon(light); };
    return scene.globals.lightCount <= kMaxLightsWithEdges &&
           std::any_of(scene.lights.begin(), scene.lights.begin() + scene.globals.lightCount, hasShape);
}

Silhouettes findSilhouettes(const CompiledScene& scene, const shared::Camera& camera, std::uint32_t width,
                            std::uint32_t height) {
    if (!mayHaveSilhouettes(scene)) return {};
    constexpr double kGrid = 1e-5; // of the largest coordinate
    Silhouettes edges;
    edges.parts.resize(std::uint64_t{width} * height);
    const ImagePlane plane(camera, width, height);
    EdgeImage image(plane, camera, edges);
    const double grid = kGrid * std::max(largestCoordinate(scene.lights), 1e-30);
    std::vector<TriangleEdge> ofTriangles;
    for (std::uint32_t i = 0; i < scene.globals.lightCount; ++i) {
        const Light& light = scene.lights[i];
        if (isRound(light)) drawRound(light, image);
        if (!isPolygon(light)) continue;
        const bool isFront = glm::dot(glm::dvec3(light.normal), image.eye() - glm::dvec3(light.position)) > 0.0;
        if (!isFront && light.sides != shared::kSidesBoth) continue;
        if (light.kind == shared::kLightQuad)
            drawQuad(light, image);
        else
            appendEdges(light, i, isFront, grid, ofTriangles);
    }
    drawBorders(ofTriangles, image);
    addLightsInSpheres(scene, camera, width, height, edges);
    addLightsInMirrors(scene, plane, edges);
    if (edges.count == 0) edges.parts.clear();
    return edges;
}

} // namespace rt::scene
