#include "Common/Scene/Compiler/DirectionalAlbedos.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>

#include "Common/Core/Parallel.h"
#include "Common/Shared/Material/PrincipledSurface.h"

namespace rt::scene {

namespace {

using namespace shared;

constexpr uint kNormals = 512;        // in a Hammersley set
constexpr uint kNormalsInside = 1024; // of glass seen from inside: of little that leaves it the error must be less
constexpr uint kHeights = 48;         // of wi over sheen
constexpr uint kTurns = 24;
constexpr float kQuadratureError = 1.0e-3f;
constexpr uint kFineSteps = 2 * kAlbedoSteps - 1; // with what is between the entries
constexpr std::size_t kMaxKept = 16;              // tables of glass, 8 KiB each

// The direction in the plane y = 0.
vec3 outgoing(float cosine) {
    return vec3(shared::sqrt((1.0f - cosine) * (1.0f + cosine)), 0.0f, cosine);
}

// A visible normal of a Hammersley set and its weight. The other half of the turn mirrors this one, and at both ends of
// the heights, where the weights vary as square roots do, normals are denser.
struct WeighedNormal {
    vec3 h;
    float weight;
};
WeighedNormal visibleNormal(const vec3& wo, float alpha, uint i, uint count) {
    const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    const vec2 u(t * t * (3.0f - 2.0f * t), static_cast<float>(bitfieldReverse(i)) * 0x1p-33f);
    return {sampleVisibleNormal(wo, alpha, u), 6.0f * t * (1.0f - t) / static_cast<float>(count)};
}

// What the facets that wo sees let pass of a direction, 0 below the surface.
float shadowing(const vec3& wo, const vec3& wi, float alpha) {
    if (!(wi.z > 0.0f)) return 0.0f;
    // 4 wo.z wi.z smithVisibility() / smithMasking()
    const float termO = smithTerm(wo.z, alpha), termI = smithTerm(wi.z, alpha);
    return wi.z * (wo.z + termO) / (wi.z * termO + wo.z * termI);
}

// (factor of the reflectance at normal incidence, at grazing incidence).
vec2 facets(float cosine, float alpha) {
    const vec3 wo = outgoing(cosine);
    vec2 sum(0.0f);
    for (uint i = 0; i < kNormals; ++i) {
        const auto [h, part] = visibleNormal(wo, alpha, i, kNormals);
        const float c = std::min(dot(wo, h), 1.0f);
        const float weight = part * shadowing(wo, h * (2.0f * c) - wo, alpha);
        sum += vec2(1.0f - schlick(c), schlick(c)) * weight;
    }
    return sum;
}

float sheen(float cosine, float roughness) {
    const vec3 wo = outgoing(cosine);
    const float exponent = 1.0f / square(roughness);
    float sum = 0.0f;
    for (uint i = 0; i < kHeights; ++i)
        for (uint k = 0; k < kTurns; ++k) {
            const float t = (static_cast<float>(i) + 0.5f) / kHeights;
            const float z = t * t; // denser at the horizon, where fibres send most
            const vec2 turn = sinCos2Pi((static_cast<float>(k) + 0.5f) / (2.0f * kTurns)); // by symmetry half a turn
            const float radius = shared::sqrt((1.0f - z) * (1.0f + z));
            const vec3 wi(radius * turn.y, radius * turn.x, z);
            sum += sheenValue(exponent, wo, wi, normalize(wo + wi)) * z * t;
        }
    return sum * (4.0f * kPi / (kHeights * kTurns));
}

float glass(float cosine, float alpha, float eta) {
    const vec3 wo = outgoing(cosine);
    const uint count = eta > 1.0f ? kNormalsInside : kNormals;
    float sum = 0.0f;
    for (uint i = 0; i < count; ++i) {
        const auto [h, part] = visibleNormal(wo, alpha, i, count);
        const float c = std::min(dot(wo, h), 1.0f);
        const vec2 f = fresnel(c, eta);
        const vec3 refracted = h * (eta * c - f.y) - wo * eta;
        sum += part * f.x * shadowing(wo, h * (2.0f * c) - wo, alpha);
        sum += part * (1.0f - f.x) * shadowing(wo, vec3(refracted.x, refracted.y, -refracted.z), alpha);
    }
    return sum;
}

// Albedos for a cosine and a row: the part of the roughness beyond the least one.
using Albedos = std::function<vec3(float, float)>;

// At the entries of a table of which albedoPlace() finds the places, and halfway between.
std::vector<vec3> fineTableOf(const Albedos& albedos) {
    std::vector<vec3> fine(std::size_t{kFineSteps} * kFineSteps);
    parallelFor(0, kFineSteps, [&](std::size_t row) {
        const float r = static_cast<float>(row) / (kFineSteps - 1);
        for (uint column = 0; column < kFineSteps; ++column) {
            const float c = 0.1f + 0.9f * static_cast<float>(column) / (kFineSteps - 1);
            const float cosine = std::min(square(square(c)), 1.0f);
            fine[row * kFineSteps + column] = albedos(cosine, r * r) + vec3(kQuadratureError);
        }
    });
    return fine;
}

// Entries are raised until the table is nowhere below the albedo, neither at an entry nor halfway between.
std::vector<vec3> tableOf(const Albedos& albedos) {
    const std::vector<vec3> fine = fineTableOf(albedos);
    const auto at = [&](uint row, uint column) { return fine[std::size_t{row} * kFineSteps + column]; };
    std::vector<vec3> table(std::size_t{kAlbedoSteps} * kAlbedoSteps);
    for (uint row = 0; row < kAlbedoSteps; ++row)
        for (uint column = 0; column < kAlbedoSteps; ++column)
            table[row * kAlbedoSteps + column] = at(2 * row, 2 * column);
    std::vector<vec3> raised = table;
    for (uint row = 0; row + 1 < kAlbedoSteps; ++row)
        for (uint column = 0; column + 1 < kAlbedoSteps; ++column) {
            const uint first = row * kAlbedoSteps + column;
            const std::array<uint, 4> corners = {first, first + 1, first + kAlbedoSteps, first + kAlbedoSteps + 1};
            vec3 lacking(0.0f);
            for (uint y = 0; y <= 2; ++y)
                for (uint x = 0; x <= 2; ++x) {
                    const float part = 0.5f * static_cast<float>(x);
                    const vec3 lower = mix(table[corners[0]], table[corners[1]], part);
                    const vec3 upper = mix(table[corners[2]], table[corners[3]], part);
                    const vec3 there = mix(lower, upper, 0.5f * static_cast<float>(y));
                    lacking = glm::max(lacking, at(2 * row + y, 2 * column + x) - there);
                }
            for (const uint i : corners) raised[i] = glm::max(raised[i], table[i] + lacking);
        }
    return raised;
}

float roughnessOf(float minRoughness, float row) {
    return minRoughness + (1.0f - minRoughness) * row;
}

std::vector<vec3> makeTable() {
    return tableOf([](float cosine, float row) {
        return vec3(facets(cosine, square(roughnessOf(kMinRoughness, row))),
                    sheen(cosine, roughnessOf(kMinSheenRoughness, row)));
    });
}

// Seen from outside, then from inside.
std::vector<float> makeGlassTable(float ior) {
    std::vector<float> table;
    for (const float eta : {1.0f / ior, ior}) {
        const std::vector<vec3> side = tableOf([eta](float cosine, float row) {
            return vec3(glass(cosine, square(roughnessOf(kMinRoughness, row)), eta));
        });
        for (const vec3& entry : side) table.push_back(entry.x);
    }
    return table;
}

} // namespace

const std::vector<vec3>& directionalAlbedos() {
    static const std::vector<vec3> table = makeTable();
    return table;
}

std::vector<float> glassAlbedos(float ior) {
    static std::mutex mutex;
    static std::map<float, std::vector<float>> kept;
    {
        const std::scoped_lock lock(mutex);
        if (const auto known = kept.find(ior); known != kept.end()) return known->second;
    }
    std::vector<float> table = makeGlassTable(ior); // whose loop may do other work that asks for a table meanwhile
    const std::scoped_lock lock(mutex);
    if (kept.size() >= kMaxKept) kept.clear();
    kept.emplace(ior, table);
    return table;
}

} // namespace rt::scene
