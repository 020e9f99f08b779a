// A winged figure with a torch, as the union of rounded solids.
#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "Common/Core/Error.h"
#include "Common/Scene/Builtin/Placeholders.h"
#include "Common/Scene/Builtin/SurfaceNet.h"

namespace rt::scene {

namespace {

struct Size {
    const char* name;
    double cell;
};
constexpr Size kSizes[] = {{"statue", 1.88},        // about 450 000 triangles
                           {"statue-fine", 1.255}}; // about a million

// Distances to solids, negative inside; of ellipsoids approximate.

// Two spheres and the cone between them.
double roundCone(const glm::dvec3& p, const glm::dvec3& a, double ra, const glm::dvec3& b, double rb) {
    const glm::dvec3 axis = b - a;
    const double t = std::clamp(glm::dot(p - a, axis) / glm::dot(axis, axis), 0.0, 1.0);
    return glm::length(p - a - t * axis) - glm::mix(ra, rb, t);
}

double ellipsoid(const glm::dvec3& p, const glm::dvec3& radii) {
    const double k0 = glm::length(p / radii), k1 = glm::length(p / (radii * radii));
    return k1 > 0 ? k0 * (k0 - 1) / k1 : -std::min({radii.x, radii.y, radii.z});
}

// Of two solids with a fillet of about `k`.
double blend(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * k * 0.25;
}

// Turned about +X.
glm::dvec3 turned(const glm::dvec3& p, double sine, double cosine) {
    return {p.x, cosine * p.y - sine * p.z, sine * p.y + cosine * p.z};
}

double robe(const glm::dvec3& p) {
    const double folds = 3.5 * std::sin(13 * std::atan2(p.z, p.x) + 0.012 * p.y) * glm::smoothstep(480.0, 250.0, p.y);
    const double skirt = roundCone(p * glm::dvec3(1.1, 1, 1), {0, 105, 0}, 88, {0, 430, 0}, 52) + folds;
    return blend(skirt, ellipsoid(p - glm::dvec3(0, 500, 0), {50, 112, 74}), 40);
}

double arms(const glm::dvec3& p) {
    const double raised = blend(roundCone(p, {0, 570, 66}, 23, {-18, 668, 128}, 18),
                                roundCone(p, {-18, 668, 128}, 18, {-22, 786, 96}, 12), 8);
    const double lowered = blend(roundCone(p, {0, 570, -66}, 23, {-24, 466, -100}, 18),
                                 roundCone(p, {-24, 466, -100}, 18, {-98, 436, -52}, 12), 8);
    return std::min(raised, lowered);
}

double torch(const glm::dvec3& p) {
    const glm::dvec3 q = p - glm::dvec3(-22, 0, 96);
    const double handle = roundCone(q, {0, 752, 0}, 6, {0, 826, 0}, 13);
    return blend(handle, ellipsoid(q - glm::dvec3(0, 850, 0), {13, 35, 13}), 6);
}

// One of a pair, mirrored in z.
double wing(const glm::dvec3& p) {
    const glm::dvec3 q = turned(glm::dvec3(p.x - 62, p.y - 560, std::abs(p.z) - 128), std::sin(-0.45), std::cos(-0.45));
    const double feathers = 2.0 * std::sin(0.16 * q.z + 0.03 * q.y) * glm::smoothstep(60.0, -120.0, q.y);
    return ellipsoid(q, {17, 178, 86}) + feathers;
}

// Whatever is farther away than `kOutOfReach` need not be looked at.
constexpr double kOutOfReach = 50;

double figure(const glm::dvec3& p) {
    const double plinth = std::max(glm::length(glm::dvec2(p.x, p.z)) - 112, std::abs(p.y - 34) - 19);
    double d = p.y < 612 + kOutOfReach ? blend(plinth, robe(p), 12) : kOutOfReach;
    if (p.y < 390 - kOutOfReach) return d;
    d = blend(d, arms(p), 14);
    d = blend(d, wing(p), 18);
    if (p.y < 564 - kOutOfReach) return d;
    d = blend(d, roundCone(p, {0, 590, 0}, 26, {-4, 640, 0}, 18), 14);
    d = blend(d, ellipsoid(p - glm::dvec3(-6, 672, 0), {38, 46, 34}), 6);
    return blend(d, torch(p), 5);
}

} // namespace

const std::vector<std::string>& meshStandInNames() {
    static const std::vector<std::string> names = {kSizes[0].name, kSizes[1].name};
    return names;
}

MeshData makeMeshStandIn(const std::string& name) {
    for (const Size& size : kSizes)
        if (name == size.name) return surfaceNet(figure, {-140, 5, -260}, {120, 895, 260}, size.cell);
    throw InputError("stand-in \"" + name + "\": no such mesh");
}

} // namespace rt::scene
