#include "Common/Scene/Compiler/DirectionalAlbedos.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "Common/Core/Parallel.h"
#include "Common/Shared/Material/Bsdf.h"

namespace rt::scene {

namespace {

using namespace shared;

constexpr uint kNormals = 512; // of facets, in a Hammersley set
constexpr uint kHeights = 48;  // of wi over sheen
constexpr uint kTurns = 24;
constexpr std::size_t kMaxKept = 16; // tables of glass, 8 KiB each

// The direction in the plane y = 0. Grazing ones stay above the surface.
vec3 outgoing(float cosine) {
    const float z = std::max(cosine, 1.0e-3f);
    return vec3(shared::sqrt(1.0f - z * z), 0.0f, z);
}

vec2 hammersley(uint i) {
    return vec2((static_cast<float>(i) + 0.5f) / kNormals, static_cast<float>(bitfieldReverse(i)) * 0x1p-32f);
}

// What the facets that wo sees let pass of a direction, 0 below the surface.
float shadowing(const vec3& wo, const vec3& wi, float alpha) {
    if (!(wi.z > 0.0f)) return 0.0f;
    return 4.0f * wo.z * wi.z * smithVisibility(wo.z, wi.z, alpha) / smithMasking(wo.z, alpha);
}

// (factor of the reflectance at normal incidence, at grazing incidence).
vec2 facets(float cosine, float alpha) {
    const vec3 wo = outgoing(cosine);
    if (isMirror(alpha)) return vec2(1.0f - schlick(wo.z), schlick(wo.z));
    vec2 sum(0.0f);
    for (uint i = 0; i < kNormals; ++i) {
        const vec3 h = sampleVisibleNormal(wo, alpha, hammersley(i));
        const float c = std::min(dot(wo, h), 1.0f);
        const float weight = shadowing(wo, h * (2.0f * c) - wo, alpha);
        sum += vec2(1.0f - schlick(c), schlick(c)) * weight;
    }
    return sum * (1.0f / kNormals);
}

float sheen(float cosine, float roughness) {
    const vec3 wo = outgoing(cosine);
    const float exponent = 1.0f / square(std::max(roughness, kMinSheenRoughness));
    float sum = 0.0f;
    for (uint i = 0; i < kHeights; ++i)
        for (uint k = 0; k < kTurns; ++k) {
            const float z = (static_cast<float>(i) + 0.5f) / kHeights;
            const vec2 turn = sinCos2Pi((static_cast<float>(k) + 0.5f) / (2.0f * kTurns)); // by symmetry half a turn
            const vec3 wi = vec3(shared::sqrt(1.0f - z * z) * turn.y, shared::sqrt(1.0f - z * z) * turn.x, z);
            sum += sheenValue(exponent, wo, wi, normalize(wo + wi)) * z;
        }
    return sum * (2.0f * kPi / (kHeights * kTurns));
}

float glass(float cosine, float alpha, float eta) {
    if (isMirror(alpha)) return 1.0f;
    const vec3 wo = outgoing(cosine);
    float sum = 0.0f;
    for (uint i = 0; i < kNormals; ++i) {
        const vec3 h = sampleVisibleNormal(wo, alpha, hammersley(i));
        const float c = std::min(dot(wo, h), 1.0f);
        const vec2 f = fresnel(c, eta);
        const vec3 refracted = h * (eta * c - f.y) - wo * eta;
        sum += f.x * shadowing(wo, h * (2.0f * c) - wo, alpha);
        sum += (1.0f - f.x) * shadowing(wo, vec3(refracted.x, refracted.y, -refracted.z), alpha);
    }
    return sum * (1.0f / kNormals);
}

std::vector<vec3> makeTable() {
    std::vector<vec3> table(kAlbedoSteps * kAlbedoSteps);
    parallelFor(0, kAlbedoSteps, [&](std::size_t row) {
        for (uint column = 0; column < kAlbedoSteps; ++column) {
            const float roughness = static_cast<float>(row) / (kAlbedoSteps - 1);
            const float cosine = static_cast<float>(column) / (kAlbedoSteps - 1);
            table[row * kAlbedoSteps + column] = vec3(facets(cosine, square(roughness)), sheen(cosine, roughness));
        }
    });
    return table;
}

std::vector<float> makeGlassTable(float ior) {
    std::vector<float> table(std::size_t{2} * kAlbedoSteps * kAlbedoSteps);
    parallelFor(0, std::size_t{2} * kAlbedoSteps, [&](std::size_t i) { // rows leaving, then rows entering
        const float eta = i < kAlbedoSteps ? 1.0f / ior : ior;
        const float roughness = static_cast<float>(i % kAlbedoSteps) / (kAlbedoSteps - 1);
        for (uint column = 0; column < kAlbedoSteps; ++column)
            table[i * kAlbedoSteps + column] =
                glass(static_cast<float>(column) / (kAlbedoSteps - 1), square(roughness), eta);
    });
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
