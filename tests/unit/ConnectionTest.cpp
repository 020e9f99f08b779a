// Connections by way of smooth spheres as the engines make them, together with scattering weighed against them, against
// rays traced in double precision.
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include <gtest/gtest.h>

#include "Common/App/Session/RenderParams.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Shared/Path/PathStep.h"
#include "tests/ConnectedScene.h"
#include "tests/unit/CompilerScenes.h"
#include "tests/unit/SphereConstellations.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::Constellation;
using test::kConstellations;
using test::kReflections;
using test::LightQuad;
using test::Mean;
using test::Traced;
using test::Uniforms;

constexpr double kPhaseDensity = 1 / (4 * test::kPiD);

std::shared_ptr<const scene::CompiledScene> compiled(const Constellation& c) {
    scene::SceneDesc desc = scene::withMaterials();
    desc.camera.lookFrom = dvec3(0);
    desc.materials["glass"] = c.eta == test::kMirror ? scene::metal(dvec3(1), 0) : scene::glass(c.eta);
    desc.materials["lamp"] = scene::emitter(dvec3(1));
    desc.materials["lamp"].sides = scene::Sides::Both;
    desc.objects = {{scene::SphereDesc{{0, 0, 0}, 1, {}, "glass"}},
                    {scene::QuadDesc{c.corner, c.edgeU, c.edgeV, "lamp"}},
                    {scene::SphereDesc{{900, 0, 0}, 1, {}, "matte"}}};
    return test::connectedThroughAll(*scene::compileScene(desc));
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
    Scattered(const Constellation& c, std::uint32_t heuristic) : c_(c), light_(c), compiled_(compiled(c)) {
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
        return traced(test::traceThrough(c_.x, direction, c_.eta), kChainBeyond, u, weighed) +
               traced(test::traceOff(c_.x, direction, c_.eta), kChainReflected, u, weighed);
    }

    // One sample of that light by connections.
    double connect(Uniforms& u) const {
        PathState s = pathAt();
        const Passage p = connection(u, s);
        return p.segments != 0u ? double(p.radiance.x) : 0;
    }

  private:
    double traced(const Traced& ray, uint state, Uniforms& u, bool weighed) const {
        dvec3 y;
        const double light = light_.along(ray, y) * kPhaseDensity * coneSolidAngle(c_);
        if (!weighed || light == 0) return light;
        PathState s = pathAt();
        connection(u, s); // what connections are made there
        s.chain.from = vec3(c_.x);
        s.chain.pdf = float(kPhaseDensity);
        s.chain.met = 0;
        s.chain.state = state;
        s.ray.origin = vec3(ray.origin);
        s.ray.direction = vec3(ray.direction);
        if (!(s.chain.rate > 0)) return light;
        const float weight = passageWeight(kFeatureAll, view_, params_, s, 0, vec3(y), compiled_->lights[0].normal);
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

    Passage connection(Uniforms& u, PathState& s) const {
        Sampler smp = makeSampler(params_, 0u, 0u, 0u);
        smp.kind = kSamplerIndependent;
        smp.key = u.word();
        smp.index = u.word();
        return connectLight(kFeatureAll, view_, params_, smp, vertexAt(c_.x), vertexSamples(kFeatureAll, smp, 0u), s);
    }

    Constellation c_;
    LightQuad light_;
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
Worth expectLightOfTracedRays(const std::array<Constellation, kCount>& constellations, int weighings,
                              std::uint32_t seed) {
    const int tracings = 7 * weighings;
    Worth worth;
    for (const std::uint32_t heuristic : {kSampleMis, kSampleMisBalance}) {
        for (const Constellation& c : constellations) {
            const Scattered scattered(c, heuristic);
            EXPECT_EQ(scattered.scene().smoothSpheres.size(), c.eta == test::kMirror ? 1u : 2u);
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
    const Worth worth = expectLightOfTracedRays(kConstellations, 60000, 7);
    EXPECT_GE(worth.covered, 6);
    EXPECT_GE(worth.better, 2);
}

TEST(Connection, WithScatteringTheLightIsThatOfReflectedRays) {
    const Worth worth = expectLightOfTracedRays(kReflections, 30000, 31);
    EXPECT_GE(worth.covered, 12);
    EXPECT_GE(worth.better, 4);
}

} // namespace
} // namespace rt::shared
