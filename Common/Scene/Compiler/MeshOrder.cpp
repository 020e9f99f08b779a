#include "Common/Scene/Compiler/MeshOrder.h"

#include <array>

#include <glm/common.hpp>

#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"

namespace rt::scene {

namespace {

constexpr std::uint32_t kBits = 10;             // per axis
constexpr std::size_t kCodesAtATime = 1u << 13; // triangles that a thread gives their codes at a time

// Two zero bits between the lowest ten.
std::uint32_t spread(std::uint32_t x) {
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

// By their codes, stably, least significant digit first.
void radixSort(std::vector<std::uint32_t>& codes, std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> otherCodes, otherOrder;
    resizeLarge(otherCodes, codes.size());
    resizeLarge(otherOrder, codes.size());
    for (std::uint32_t shift = 0; shift < 3 * kBits; shift += kBits) {
        std::array<std::size_t, 1u << kBits> starts{};
        const auto digit = [shift](std::uint32_t code) { return code >> shift & ((1u << kBits) - 1); };
        for (const std::uint32_t code : codes) ++starts[digit(code)];
        std::size_t sum = 0;
        for (std::size_t& start : starts) {
            const std::size_t count = start;
            start = sum;
            sum += count;
        }
        for (std::size_t i = 0; i < codes.size(); ++i) {
            const std::size_t place = starts[digit(codes[i])]++;
            otherCodes[place] = codes[i];
            otherOrder[place] = order[i];
        }
        codes.swap(otherCodes);
        order.swap(otherOrder);
    }
}

} // namespace

void orderAlongCurve(const std::vector<glm::vec3>& positions, const WoundTriangles& triangles,
                     std::vector<std::uint32_t>& order) {
    if (order.size() < 2) return;
    // Three times the middle, bounded by three times the box of the vertices.
    const auto middle = [&](std::uint32_t i) {
        const glm::uvec3 t = triangles[i];
        return positions[t.x] + positions[t.y] + positions[t.z];
    };
    glm::vec3 lower = middle(order[0]), upper = lower;
    for (const std::uint32_t i : order) {
        const glm::vec3 m = middle(i);
        lower = glm::min(lower, m);
        upper = glm::max(upper, m);
    }
    const glm::vec3 size = glm::max(upper - lower, glm::vec3(1e-30f));
    const float cells = 1u << kBits;
    std::vector<std::uint32_t> codes;
    resizeLarge(codes, order.size());
    parallelChunks(0, codes.size(), kCodesAtATime, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const glm::vec3 unit = (middle(order[k]) - lower) / size;
            const glm::vec3 cell = glm::min(unit * cells, glm::vec3(cells - 1));
            codes[k] = spread(static_cast<std::uint32_t>(cell.x)) | spread(static_cast<std::uint32_t>(cell.y)) << 1 |
                       spread(static_cast<std::uint32_t>(cell.z)) << 2;
        }
    });
    radixSort(codes, order);
}

} // namespace rt::scene
