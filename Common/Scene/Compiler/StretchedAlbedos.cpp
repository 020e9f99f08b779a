// The directional albedo of facets that are rougher along one direction.
#include <algorithm>
#include <array>

#include "Common/Core/Parallel.h"
#include "Common/Scene/Compiler/DirectionalAlbedos.h"
#include "Common/Shared/Material/PrincipledSurface.h"

namespace rt::scene {

namespace {

using namespace shared;

constexpr std::uint32_t kStretchedNormals = 512; // in a Hammersley set over the whole turn
constexpr float kStretchedError = 1.0e-3f;       // of the quadrature

// Linear interpolation between entries falls below a concave function by an eighth of its second difference, and less
// where neighbours differ; this much of it is added.
constexpr float kRaise = 1.25f / 8;

// Indices and numbers of entries, the fastest last: strength, roughness, turn, cosine.
using Place = std::array<std::uint32_t, 4>;
constexpr Place kCounts = {kStretchedStrengths, kStretchedRoughnesses, kStretchedTurns, kStretchedCosines};
constexpr std::array<std::size_t, 4> kStrides = {std::size_t{kCounts[1]} * kCounts[2] * kCounts[3],
                                                 std::size_t{kCounts[2]} * kCounts[3], kCounts[3], 1};

Place placeOf(std::size_t index) {
    Place place{};
    for (std::size_t d = 0; d < 4; ++d) place[d] = static_cast<std::uint32_t>(index / kStrides[d] % kCounts[d]);
    return place;
}

// (factor of the reflectance at normal incidence, at grazing incidence) for widths along x and y.
vec2 reflectedBy(const vec3& wo, const vec2& alpha) {
    const float termO = stretchedTerm(wo, alpha);
    vec2 sum(0.0f);
    for (std::uint32_t i = 0; i < kStretchedNormals; ++i) {
        // Normals are denser at both ends of the heights, where the weights vary as square roots do.
        const float t = (static_cast<float>(i) + 0.5f) / kStretchedNormals;
        const vec2 u(t * t * (3.0f - 2.0f * t), static_cast<float>(bitfieldReverse(i)) * 0x1p-32f);
        const vec3 h = sampleGgxCap(wo, alpha, 1.0f, u);
        const float c = std::min(dot(wo, h), 1.0f);
        const vec3 wi = h * (2.0f * c) - wo;
        if (!(c > 0.0f && wi.z > 0.0f)) continue;
        const float passing = wi.z * (wo.z + termO) / (wi.z * termO + wo.z * stretchedTerm(wi, alpha));
        sum += vec2(1.0f - schlick(c), schlick(c)) * (6.0f * t * (1.0f - t) * passing);
    }
    return sum * (1.0f / kStretchedNormals);
}

// The inverse of the places that stretchedAlbedo() finds.
vec2 stretchedEntry(const Place& place) {
    std::array<float, 4> at{};
    for (std::size_t d = 0; d < 4; ++d) at[d] = static_cast<float>(place[d]) / static_cast<float>(kCounts[d] - 1);
    const float strength = square(at[0]);
    const float roughness = kMinRoughness + (1.0f - kMinRoughness) * square(at[1]);
    const float cosine = std::min(square(square(0.1f + 0.9f * at[3])), 1.0f);
    const vec2 alpha(stretchedWidth(roughness, strength), square(roughness));
    const float seen = alpha.y + (alpha.x - alpha.y) * square(square(at[2]));
    const float range = square(alpha.x) - square(alpha.y);
    const float along = range > 0.0f ? std::clamp((square(seen) - square(alpha.y)) / range, 0.0f, 1.0f) : 0.0f;
    const float sine = shared::sqrt((1.0f - cosine) * (1.0f + cosine));
    return reflectedBy(vec3(sine * shared::sqrt(along), sine * shared::sqrt(1.0f - along), cosine), alpha);
}

// What keeps the table, interpolated, from being too low about an entry.
vec2 raiseAt(const std::vector<vec2>& table, std::size_t index) {
    const Place place = placeOf(index);
    vec2 sum(kStretchedError);
    for (std::size_t d = 0; d < 4; ++d) {
        vec2 worst(0.0f);
        for (const std::size_t middle : {std::size_t{place[d]} - 1, std::size_t{place[d]},
                                         std::size_t{place[d]} + 1}) { // -1 is far beyond the last
            if (middle < 1 || middle >= kCounts[d] - 1) continue;
            const vec2* entry = &table[index + middle * kStrides[d] - place[d] * kStrides[d]];
            worst = glm::max(worst, *entry * 2.0f - *(entry - kStrides[d]) - *(entry + kStrides[d]));
        }
        sum += worst * kRaise;
    }
    return sum;
}

std::vector<vec2> makeStretchedTable() {
    std::vector<vec2> table(kStrides[0] * kCounts[0]);
    parallelFor(0, table.size(), [&](std::size_t i) { table[i] = stretchedEntry(placeOf(i)); });
    std::vector<vec2> raised(table.size());
    for (std::size_t i = 0; i < table.size(); ++i) raised[i] = table[i] + raiseAt(table, i);
    return raised;
}

} // namespace

const std::vector<shared::vec2>& stretchedAlbedos() {
    static const std::vector<shared::vec2> table = makeStretchedTable();
    return table;
}

} // namespace rt::scene
