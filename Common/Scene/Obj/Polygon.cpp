#include "Common/Scene/Obj/Polygon.h"

#include <numeric>

#include <glm/geometric.hpp>

namespace rt::scene {

namespace {

using Corners = std::vector<glm::dvec3>;

// Newell's: twice the vector area.
glm::dvec3 normalOf(const Corners& corners) {
    glm::dvec3 normal(0);
    for (std::size_t i = 0; i < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    return normal;
}

// Area of a triangle as seen along the normal, up to a positive factor; negative: clockwise.
double turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& normal) {
    return glm::dot(glm::cross(b - a, c - a), normal);
}

// Whether corner `i` of what is left can be cut off: a left turn with no other corner inside.
bool isEar(const Corners& corners, const std::vector<std::uint32_t>& left, std::size_t i, const glm::dvec3& normal) {
    const std::size_t n = left.size();
    const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
    const glm::dvec3 &a = corners[left[before]], &b = corners[left[i]], &c = corners[left[after]];
    if (!(turn(a, b, c, normal) > 0)) return false;
    for (std::size_t k = 0; k < n; ++k) {
        if (k == before || k == i || k == after) continue;
        const glm::dvec3& p = corners[left[k]];
        if (p == a || p == b || p == c) continue;
        if (turn(a, b, p, normal) >= 0 && turn(b, c, p, normal) >= 0 && turn(c, a, p, normal) >= 0) return false;
    }
    return true;
}

} // namespace

std::vector<glm::uvec3> cutPolygon(const Corners& corners) {
    std::vector<glm::uvec3> triangles;
    triangles.reserve(corners.size() - 2);
    std::vector<std::uint32_t> left(corners.size());
    std::iota(left.begin(), left.end(), 0u);
    const glm::dvec3 normal = normalOf(corners);
    std::size_t i = 0, misses = 0;
    while (left.size() > 3) {
        const std::size_t n = left.size();
        i %= n;
        // After a whole round without an ear any corner goes.
        if (misses < n && !isEar(corners, left, i, normal)) {
            ++misses;
            ++i;
            continue;
        }
        triangles.emplace_back(left[(i + n - 1) % n], left[i], left[(i + 1) % n]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
        misses = 0;
    }
    triangles.emplace_back(left[0], left[1], left[2]);
    return triangles;
}

} // namespace rt::scene
