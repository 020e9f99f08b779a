// Connections by way of smooth spheres as the engines make them, together with scattering weighed against them, against
// rays traced in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "Common/Render/RenderParams.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Shared/Path/PathStep.h"
#include "tests/ConnectedScene.h"
#include "tests/unit/CompilerScenes.h"
#include "tests/unit/SkyImages.h"
#include "tests/unit/SphereConstellations.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::Constellation;
using test::kConstellations;
using test::kPiD;
using test::kReflections;
using test::LightQuad;
using test::Mean;
using test::Traced;
using test::Uniforms;

constexpr double kPhaseDensity = 1 / (4 * test::kPiD);

// A constellation's scene, and the light that is left of rays in it.
struct Lit {
    std::shared_ptr<const scene::CompiledScene> scene;    // with one light
    std::function<double(const Traced&, dvec3& y)> along; // y: a point that it comes from
};

scene::SceneDesc sphereOf(double eta) {
    scene::SceneDesc desc = scene::withMaterials();
    desc.camera.lookFrom = dvec3(0);
    desc.materials["glass"] = eta == test::kMirror ? scene::metal(dvec3(1), 0) : scene::glass(eta);
    desc.objects = {{scene::SphereDesc{{0, 0, 0}, 1, {}, "glass"}}, {scene::SphereDesc{{900, 0, 0}, 1, {}, "matte"}}};
    return desc;
}

Lit litByQuad(const Constellation& c) {
    scene::SceneDesc desc = sphereOf(c.eta);
    desc.materials["lamp"] = scene::emitter(dvec3(1));
    desc.materials["lamp"].sides = scene::Sides::Both;
    desc.objects.push_back({scene::QuadDesc{c.corner, c.edgeU, c.edgeV, "lamp"}});
    const LightQuad light(c);
    return {test::connectedThroughAll(*scene::compileScene(desc)),
            [light](const Traced& ray, dvec3& y) { return light.along(ray, y); }};
}

// A sky with a sun of six texels that differ, on the left edge of the image where it is cut in two, and a dim rest.
constexpr std::uint32_t kSkyWidth = 128, kSkyHeight = 64;

float skyTexelAt(std::uint32_t x, std::uint32_t y) {
    const bool isSun = (x < 2 || x == kSkyWidth - 1) && (y == 20 || y == 21);
    return isSun ? 10.0f + 5.0f * float((x + y) % 3) : 0.01f * float(1 + (x + 3 * y) % 5);
}

// What directions lead to the middle of the sun.
dvec3 sunDirection() {
    const double polar = kPiD * 21 / kSkyHeight, azimuth = kPiD / kSkyWidth;
    return {-std::sin(polar) * std::cos(azimuth), std::cos(polar), -std::sin(polar) * std::sin(azimuth)};
}

double skyAlong(const Traced& ray) {
    if (ray.left == 0) return 0;
    const dvec3& d = ray.direction;
    const double turn = std::atan2(-d.z, -d.x) / (2 * kPiD), u = turn < 0 ? turn + 1 : turn;
    const auto x = std::uint32_t(u * kSkyWidth), y = std::uint32_t(std::acos(d.y) / kPiD * kSkyHeight);
    return ray.left * double(skyTexelAt(std::min(x, kSkyWidth - 1), std::min(y, kSkyHeight - 1)));
}

Lit litBySky(const Constellation& c) {
    const scene::SkyPicture picture{kSkyWidth, kSkyHeight, skyTexelAt};
    return {test::connectedThroughAll(*scene::compileUnder(picture, sphereOf(c.eta))),
            [](const Traced& ray, dvec3&) { return skyAlong(ray); }};
}

// A vertex at x that scatters into all directions alike, nothing absorbed.
Vertex vertexAt(const dvec3& x) {
    Vertex v{};
    v.inMedium = 1u;
    v.front = 1u;
    v.wo = vec3(1, 0, 0);
    v.position = v.origin = vec3(x);
    v.bsdf = mediumBsdf(vec3(1));
    return v;
}

class Scattered {
  public:
    Scattered(const Constellation& c, const Lit& lit, std::uint32_t heuristic)
        : c_(c), lit_(lit), compiled_(lit.scene) {
        app::RenderSettings settings;
        settings.lightSampling = static_cast<app::LightSampling>(heuristic);
        settings.specularConnections = true;
        params_ = app::makeRenderParams(*compiled_, settings);
        view_ = viewOf(*compiled_, compiled_->globals);
    }

    const scene::CompiledScene& scene() const { return *compiled_; }

    // Light that arrives by way of the sphere and is scattered: by directions in the sphere's cone.
    double trace(Uniforms& u, bool weighed) const {
        const dvec3 direction = test::coneDirection(c_, u);
        return traced(test::traceThrough(c_.x, direction, c_.eta), kRefracted, u, weighed) +
               traced(test::traceOff(c_.x, direction, c_.eta), kReflectedOutside, u, weighed) +
               traced(test::traceThrough(c_.x, direction, c_.eta, 1), kReflectedInside, u, weighed);
    }

    // One sample of that light by connections.
    double connect(Uniforms& u) const {
        PathState s = pathAt();
        const SpecularConnection p = connection(u, s);
        return p.segments != 0u ? double(p.radiance.x) : 0;
    }

  private:
    double traced(const Traced& ray, uint crossings, Uniforms& u, bool weighed) const {
        dvec3 y;
        const double light = lit_.along(ray, y) * kPhaseDensity * coneSolidAngle(c_);
        if (!weighed || light == 0) return light;
        PathState s = pathAt();
        connection(u, s); // what connections are made there
        s.chain.from = vec3(c_.x);
        s.chain.pdf = float(kPhaseDensity);
        s.chain.met = 0;
        s.chain.state = kChainBeyond + crossings;
        s.ray.origin = vec3(ray.origin);
        s.ray.direction = vec3(ray.direction);
        if (!(s.chain.rate > 0)) return light;
        const float weight = connectionWeight(kFeatureAll, view_, params_, s, 0, vec3(y), compiled_->lights[0].normal);
        EXPECT_TRUE(weight >= 0 && weight <= 1) << weight;
        return light * double(weight);
    }

    PathState pathAt() const {
        Ray ray;
        ray.origin = vec3(c_.x);
        ray.direction = vec3(1, 0, 0);
        ray.time = 0.25f;
        return startPath(ray);
    }

    SpecularConnection connection(Uniforms& u, PathState& s) const {
        Sampler smp = makeSampler(params_, 0u, 0u, 0u);
        smp.kind = kSamplerIndependent;
        smp.key = u.word();
        smp.index = u.word();
        return connectLight(kFeatureAll, view_, params_, smp, vertexAt(c_.x), vertexSamples(kFeatureAll, smp, 0u), s);
    }

    Constellation c_;
    Lit lit_;
    std::shared_ptr<const scene::CompiledScene> compiled_;
    RenderParams params_{};
    SceneView view_;
};

// How many constellations have connections, and how many have a quarter of the variance or less by them.
struct Worth {
    int covered = 0, better = 0;
};

// By both heuristics.
template <std::size_t kCount>
Worth expectLightOfTracedRays(const std::array<Constellation, kCount>& constellations,
                              const std::function<Lit(const Constellation&)>& light, int weighings,
                              std::uint32_t seed) {
    const int tracings = 7 * weighings;
    Worth worth;
    for (const Constellation& c : constellations) {
        const Lit lit = light(c);
        for (const std::uint32_t heuristic : {kSampleMis, kSampleMisBalance}) {
            const Scattered scattered(c, lit, heuristic);
            EXPECT_EQ(scattered.scene().specularCasters.size(), c.eta == test::kMirror ? 1u : 3u);
            Uniforms u(seed++);
            Mean traced, weighed, connected;
            for (int k = 0; k < tracings; ++k) traced.add(scattered.trace(u, false));
            for (int k = 0; k < weighings; ++k) weighed.add(scattered.trace(u, true));
            for (int k = 0; k < weighings; ++k) {
                const double light = scattered.connect(u);
                EXPECT_TRUE(std::isfinite(light) && light >= 0) << c.name;
                connected.add(light);
            }
            const double sum = weighed.mean() + connected.mean();
            const double error =
                std::sqrt(traced.variance() / tracings + (weighed.variance() + connected.variance()) / weighings);
            EXPECT_LT(std::abs(sum - traced.mean()) / error, 4)
                << c.name << ": " << sum << " in place of " << traced.mean();
            worth.covered += connected.mean() > 0 ? 1 : 0;
            worth.better += weighed.variance() + connected.variance() < traced.variance() / 4 ? 1 : 0;
        }
    }
    return worth;
}

TEST(Connection, WithScatteringTheLightIsThatOfTracedRays) {
    const Worth worth = expectLightOfTracedRays(kConstellations, litByQuad, 60000, 7);
    EXPECT_GE(worth.covered, 6);
    EXPECT_GE(worth.better, 2);
}

TEST(Connection, WithScatteringTheLightIsThatOfReflectedRays) {
    const Worth worth = expectLightOfTracedRays(kReflections, litByQuad, 30000, 31);
    EXPECT_GE(worth.covered, 12);
    EXPECT_GE(worth.better, 4);
}

TEST(Connection, WithScatteringTheLightOfTheSkyIsThatOfTracedRays) {
    const dvec3 sun = sunDirection(), aside = test::acrossOf(sun);
    const auto at = [&](const char* name, double eta, double behind, double beside) {
        return Constellation{name, eta, aside * beside - sun * behind, {}, {}, {}};
    };
    const std::array places = {
        at("on the axis", 1.5, 4, 0),
        at("focus", 1.5, 1.5, 0),
        at("fold", 1.5, 1.3, 0.22),
        at("touching the sphere", 1.5, 1.002, 0),
        at("ice", 1.31, 2, 0.2),
        at("diamond", 2.4, 1.1, 0.3),
        at("beside", 1.5, 1, 2),
        at("between sun and mirror", test::kMirror, -2, 0.3),
        at("beside a mirror", test::kMirror, 0, 1.5),
        at("grazing a mirror", test::kMirror, 3, 1.4),
        at("touching a mirror", test::kMirror, 0, 1.002),
        at("far from a mirror", test::kMirror, -20, 20),
    };
    const Worth worth = expectLightOfTracedRays(places, litBySky, 30000, 57);
    EXPECT_EQ(worth.covered, 24);
    EXPECT_GE(worth.better, 16);
}

} // namespace
} // namespace rt::shared
