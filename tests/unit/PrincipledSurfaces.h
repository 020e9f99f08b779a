// Principled surfaces for tests of their lobes: cases, their bsdfs, what these send out.
#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "Common/Scene/Compiler/DirectionalAlbedos.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Material/PrincipledSurface.h"
#include "tests/unit/DirectionCells.h"

namespace rt::test {

using shared::Bsdf;
using shared::BsdfSample;
using shared::Principled;
using shared::PrincipledValues;
using shared::ScaledChannel;
using shared::SceneArraysOf;
using shared::SceneView;
using shared::Surface;
using shared::vec2;
using shared::vec3;
using shared::vec4;

inline const vec3 kUp(0, 0, 1);
inline constexpr float kPrincipledIor = 1.5f;

struct PrincipledTables : SceneArraysOf<std::vector> {
    explicit PrincipledTables(float ior) {
        directionalAlbedos = scene::directionalAlbedos();
        stretchedAlbedos = scene::stretchedAlbedos();
        glassAlbedos = scene::glassAlbedos(ior);
    }
    operator SceneView() const { return viewOf(*this, {}); }
};

inline const PrincipledTables& principledTables(float ior) {
    static std::map<float, PrincipledTables> made;
    return made.try_emplace(ior, ior).first->second;
}

struct PrincipledCase {
    const char* name;
    float metallic = 0, transmission = 0, clearcoat = 0, sheen = 0;
    bool thin = false;
    float anisotropy = 0;
    float film = 0;
    float beyond = 0; // share of the diffuse base that transmits
};
inline constexpr PrincipledCase kPrincipledCases[] = {{"metal", 1},
                                                      {"dielectric"},
                                                      {"glass", 0, 1},
                                                      {"sheet", 0, 1, 0, 0, true},
                                                      {"clearcoat", 0, 0, 1},
                                                      {"sheen", 0, 0, 0, 0.8f},
                                                      {"mixture", 0.3f, 0.5f, 0.5f, 0.5f},
                                                      {"brushed metal", 1, 0, 0, 0, false, 0.8f},
                                                      {"brushed mixture", 0.3f, 0.5f, 0.5f, 0.5f, false, 0.6f},
                                                      {"filmed metal", 1, 0, 0, 0, false, 0, 1},
                                                      {"filmed dielectric", 0, 0, 0, 0, false, 0, 1},
                                                      {"filmed glass", 0, 1, 0, 0, false, 0, 0.7f},
                                                      {"bubble", 0, 1, 0, 0, true, 0, 1}};

// Of these the diffuse base sends light to both sides, which paths choose from.
inline constexpr PrincipledCase kTranslucentCases[] = {{"leaf", 0, 0, 0, 0, false, 0, 0, 0.6f},
                                                       {"coated leaf", 0, 0, 1, 0.5f, false, 0, 0, 1},
                                                       {"wax", 0.2f, 0.3f, 0.3f, 0, false, 0.5f, 0.5f, 0.4f}};

// As tests are called.
inline std::string principledCaseName(const PrincipledCase& which) {
    std::string name = which.name;
    std::ranges::replace(name, ' ', '_');
    return name;
}

inline Principled principledOf(const PrincipledCase& which, float roughness) {
    const auto constant = [](float factor) { return ScaledChannel{factor, shared::kNone, 0}; };
    Principled p{};
    p.metallic = constant(which.metallic);
    p.roughness = constant(roughness);
    p.specular = constant(1);
    p.transmission = constant(which.transmission);
    p.clearcoat = constant(which.clearcoat);
    p.clearcoatRoughness = constant(roughness);
    p.sheenRoughness = constant(roughness);
    p.opacity = constant(1);
    p.anisotropy = constant(which.anisotropy);
    p.stretch = vec2(std::cos(0.4f), std::sin(0.4f));
    p.stretchTexture = shared::kNone;
    p.iridescence = constant(which.film);
    p.iridescenceThickness = constant(1);
    p.filmThickness = vec2(100, 400);
    p.filmIor = 1.3f;
    p.diffuseTransmission = constant(which.beyond);
    p.diffuseTransmissionColor = {vec3(1), shared::kNone};
    p.specularColor = {vec3(1), shared::kNone};
    p.sheenColor = {vec3(which.sheen), shared::kNone};
    p.ior = kPrincipledIor;
    p.thin = which.thin ? 1u : 0u;
    p.glass = which.thin ? shared::kNone : 0u;
    p.normalTexture = p.coatTexture = shared::kNone;
    p.alphaCutoff = -1;
    return p;
}

// `beyond`: what transmits diffusely, as it is seen from there.
inline Bsdf bsdfOf(const Principled& p, const vec3& albedo, const vec3& wo, bool front = true, const vec3& coat = kUp,
                   bool beyond = false) {
    Bsdf b{};
    b.kind = shared::kMaterialPrincipled;
    b.albedo = albedo;
    const PrincipledTables& tables = principledTables(p.ior);
    Surface surface{};
    surface.tangent = vec4(1, 0, 0, 1);
    PrincipledValues values = principledValues(shared::kFeatureAll, tables, p, surface);
    addRareValues(shared::kFeatureAll, tables, p, surface, kUp, 1, values);
    values.rare.isBeyond = beyond ? 1u : 0u;
    b.lobes = makeLobes(shared::kFeatureAll, tables, values, albedo, wo.z,
                        facetsAlbedo(shared::kFeatureAll, tables, values, kUp, wo), coat, std::max(dot(coat, wo), 0.0f),
                        front);
    return b;
}

inline vec3 outgoingAt(double cosine) {
    return vec3(onSphere(0.5 * (cosine + 1), 0.1));
}

// On both sides.
inline vec4 evalBothSides(const Bsdf& b, const vec3& wo, const vec3& wi) {
    BsdfSample s = shared::absorbed();
    s.wi = wi;
    s.transmitted = wi.z < 0 ? 1u : 0u;
    return evalProposal(shared::kFeatureAll, b, wo, s);
}

inline BsdfSample drawFrom(const Bsdf& b, const vec3& wo, const vec2& u) {
    return sampleBsdf(shared::kFeatureAll, b, kUp, 1, wo, u, u.x);
}

} // namespace rt::test
