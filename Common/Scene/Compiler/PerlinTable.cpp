#include "Common/Scene/Compiler/PerlinTable.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "Common/Shared/Base/Random.h"

namespace rt::scene {

namespace {

constexpr std::uint32_t kGradientStream = 0x67726164u;
constexpr std::uint32_t kShuffleStream = 0x73687566u;

double uniform(std::uint32_t word) {
    return word * 0x1p-32;
}

} // namespace

std::uint32_t appendPerlinTable(std::uint32_t seed, CompiledScene& out) {
    const auto table = static_cast<std::uint32_t>(out.perlinGradients.size() / shared::kPerlinSize);
    for (std::uint32_t i = 0; i < shared::kPerlinSize; ++i) {
        const shared::uvec3 words = shared::hash3({i, seed, kGradientStream});
        const double z = 1 - 2 * uniform(words.x), r = std::sqrt((1 - z) * (1 + z));
        const double phi = 2 * 3.14159265358979323846 * uniform(words.y);
        out.perlinGradients.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
    }
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::size_t first = out.perlinPermutations.size();
        out.perlinPermutations.resize(first + shared::kPerlinSize);
        const auto begin = out.perlinPermutations.begin() + static_cast<std::ptrdiff_t>(first);
        std::iota(begin, out.perlinPermutations.end(), 0u);
        for (std::uint32_t i = shared::kPerlinSize - 1; i > 0; --i) {
            const std::uint64_t word = shared::hash3({i, seed, kShuffleStream + axis}).x;
            std::swap(begin[i], begin[static_cast<std::uint32_t>(word * (i + 1) >> 32)]); // Fisher-Yates
        }
    }
    return table;
}

} // namespace rt::scene
