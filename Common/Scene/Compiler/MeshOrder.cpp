#include "Common/Scene/Compiler/MeshOrder.h"

#include <array>
#include <cstdint>

#include <glm/common.hpp>

namespace rt::scene {

namespace {

constexpr std::uint32_t kBits = 10; // per axis

// Two zero bits between the lowest ten.
std::uint32_t spread(std::uint32_t x) {
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

struct Keyed {
    std::uint32_t code;
    std::uint32_t index;
};

// Stable, least significant digit first.
void radixSort(std::vector<Keyed>& items) {
    std::vector<Keyed> other(items.size());
    for (std::uint32_t shift = 0; shift < 3 * kBits; shift += kBits) {
        std::array<std::size_t, 1u << kBits> starts{};
        const auto digit = [shift](const Keyed& item) { return item.code >> shift & ((1u << kBits) - 1); };
        for (const Keyed& item : items) ++starts[digit(item)];
        std::size_t sum = 0;
        for (std::size_t& start : starts) {
            const std::size_t count = start;
            start = sum;
            sum += count;
        }
        for (const Keyed& item : items) other[starts[digit(item)]++] = item;
        items.swap(other);
    }
}

} // namespace

void orderAlongCurve(const std::vector<glm::vec3>& positions, std::vector<glm::uvec3>& triangles) {
    if (triangles.size() < 2) return;
    // Three times the middle, bounded by three times the box of the vertices.
    const auto middle = [&](const glm::uvec3& t) { return positions[t.x] + positions[t.y] + positions[t.z]; };
    glm::vec3 lower = middle(triangles[0]), upper = lower;
    for (const glm::uvec3& t : triangles) {
        const glm::vec3 m = middle(t);
        lower = glm::min(lower, m);
        upper = glm::max(upper, m);
    }
    const glm::vec3 size = glm::max(upper - lower, glm::vec3(1e-30f));
    const float cells = 1u << kBits;
    std::vector<Keyed> keys(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::vec3 unit = (middle(triangles[i]) - lower) / size;
        const glm::vec3 cell = glm::min(unit * cells, glm::vec3(cells - 1));
        keys[i] = {spread(static_cast<std::uint32_t>(cell.x)) | spread(static_cast<std::uint32_t>(cell.y)) << 1 |
                       spread(static_cast<std::uint32_t>(cell.z)) << 2,
                   static_cast<std::uint32_t>(i)};
    }
    radixSort(keys);
    std::vector<glm::uvec3> ordered(triangles.size());
    for (std::size_t i = 0; i < keys.size(); ++i) ordered[i] = triangles[keys[i].index];
    triangles.swap(ordered);
}

} // namespace rt::scene
