#include "Common/Probe/Probe.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <system_error>

#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Probe/Densities.h"
#include "Common/Shared/Camera.h"
#include "Common/Shared/Path/Emission.h"
#include "Common/Shared/Shape/Surface.h"

namespace rt::probe {

using namespace rt::shared;

namespace {

constexpr float kUnit = 1.0f / 16777216.0f; // 2^-24: numbers are below 1

shared::vec2 pairOf(Probe::Random& random) {
    const std::uint64_t bits = random();
    return {static_cast<float>(bits >> 40U) * kUnit, static_cast<float>(bits & 0xffffffU) * kUnit};
}

Hit closestHit(const SceneFormulas& scene, const Ray& ray) {
    const float end = kInfinity;
    Hit hit;
    accel::rayQuery().closest(scene.accel(), &ray, &end, &hit, 1);
    return hit;
}

// What is over a density that may be 0.
double ratio(double value, double density) {
    return value > 0 && density > 0 ? value / density : 0;
}

} // namespace

std::optional<Strategy> strategyOf(const std::string& text, std::uint32_t lightCount) {
    if (text == "bsdf") return Strategy{StrategyKind::Bsdf};
    if (text == "lights") return Strategy{StrategyKind::Lights};
    if (text == "mixture") return Strategy{StrategyKind::Mixture};
    if (text == "mis") return Strategy{StrategyKind::Mis};
    Strategy strategy{StrategyKind::Light};
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, strategy.light);
    if (error != std::errc() || rest != end || strategy.light >= lightCount) return std::nullopt;
    return strategy;
}

std::optional<Probe> Probe::at(const SceneFormulas& scene, std::uint32_t x, std::uint32_t y) {
    const uvec2 size(scene.params().width, scene.params().height);
    const shared::vec2 middle(0.5f, 0.5f);
    const Ray ray = generateCameraRay(kFeatureAll, scene.camera(), uvec2(x, y), size, middle, middle, 0.0f);
    const Hit hit = closestHit(scene, ray);
    if (!(hit.t >= 0.0f)) return std::nullopt;
    return Probe(scene, makeSurface(kFeatureAll, scene.view(), ray, hit), -ray.direction);
}

Probe::Probe(const SceneFormulas& scene, const Surface& surface, const shared::vec3& wo)
    : scene_(&scene),
      vertex_(vertexOn(scene, surface, wo)),
      context_(contextAt(vertex_.origin, vertex_.shading)),
      material_(surface.material) {
    if (scene.compiled()->globals.lightCount > 0) chooseLightAt(scene, {0.5f, 0.5f}, context_);
}

std::string Probe::whyNoDensity(const Strategy& strategy) const {
    const std::uint32_t lights = scene_->compiled()->globals.lightCount;
    if (strategy.kind == StrategyKind::Light)
        return isPunctual(kFeatureAll, scene_->view().lights[strategy.light])
                   ? "light " + std::to_string(strategy.light) + " has no extent, and so no density of directions"
                   : "";
    if (strategy.kind != StrategyKind::Bsdf && lights == 0) return "the scene has no lights to choose from";
    if (strategy.kind != StrategyKind::Lights && isDeltaVertex(kFeatureAll, vertex_))
        return "the pixel shows a mirror or clear glass, which scatters in single directions without a density";
    return "";
}

float Probe::density(const Strategy& strategy, const shared::vec3& direction) const {
    const bool isAbove = dot(direction, vertex_.shading) > 0.0f;
    const auto bsdf = [&] { return evalScattering(kFeatureAll, vertex_, direction).w; };
    const auto lights = [&] { return isAbove ? lightsDensity(*scene_, context_, 0.0f, direction) : 0.0f; };
    switch (strategy.kind) {
        case StrategyKind::Bsdf:
            return bsdf();
        case StrategyKind::Lights:
            return lights();
        case StrategyKind::Light:
            return isAbove ? lightDensity(*scene_, scene_->view().lights[strategy.light], context_.position,
                                          context_.normal, 0.0f, direction)
                           : 0.0f;
        default:
            return 0.5f * bsdf() + 0.5f * lights();
    }
}

std::optional<shared::vec3> Probe::drawLight(const Strategy& strategy, Random& random) const {
    std::uint32_t light = strategy.light;
    if (strategy.kind != StrategyKind::Light) {
        LightContext context = context_;
        light = chooseLightAt(*scene_, pairOf(random), context).light;
        if (light == kNone) return std::nullopt;
    }
    const Light& chosen = scene_->view().lights[light];
    const shared::vec2 place = pairOf(random);
    if (isPunctual(kFeatureAll, chosen)) return std::nullopt;
    const LightSample s =
        sampleChosenLight(kFeatureAll, scene_->view(), scene_->params(), chosen, vertex_, 0.0f, place);
    if (!(s.pdf > 0.0f) || !(dot(s.wi, vertex_.shading) > 0.0f)) return std::nullopt;
    return s.wi;
}

std::optional<shared::vec3> Probe::drawBsdf(Random& random) const {
    const BsdfSample s = sampleScattering(kFeatureAll, vertex_, pairOf(random));
    if (!(maxComponent(s.weight) > 0.0f)) return std::nullopt;
    return s.wi;
}

std::vector<std::optional<shared::vec3>> Probe::draw(const Strategy& strategy, std::size_t count,
                                                     Random& random) const {
    std::vector<std::optional<shared::vec3>> directions(count);
    for (std::size_t i = 0; i < count; ++i) {
        const bool isCoin = strategy.kind == StrategyKind::Mixture;
        const bool byBsdf = strategy.kind == StrategyKind::Bsdf || (isCoin && pairOf(random).x < 0.5f) ||
                            (strategy.kind == StrategyKind::Mis && i % 2 == 1);
        directions[i] = byBsdf ? drawBsdf(random) : drawLight(strategy, random);
    }
    return directions;
}

shared::vec3 Probe::arriving(const shared::vec3& direction) const {
    Ray ray;
    ray.origin = offsetOrigin(vertex_.position, vertex_.error, vertex_.normal, direction);
    ray.direction = direction;
    ray.time = 0.0f;
    const Hit hit = closestHit(*scene_, ray);
    if (!(hit.t >= 0.0f)) return skyRadiance(kFeatureAll, scene_->view(), direction);
    const Surface surface = makeSurface(kFeatureAll, scene_->view(), ray, hit);
    const Material& material = scene_->view().materials[surface.material];
    const bool isFront = dot(direction, surface.normal) < 0.0f;
    if (!isFront && material.emissionSides != kSidesBoth) return shared::vec3(0.0f);
    return surfaceEmission(kFeatureAll, scene_->view(), material, surface);
}

double Probe::contribution(const shared::vec3& direction) const {
    const shared::vec3 light = shared::vec3(evalScattering(kFeatureAll, vertex_, direction)) * arriving(direction);
    return 0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z;
}

// Of Mis a pair, one sample of the lights and one of the bsdf, is one value; else a sample is.
DirectEstimate Probe::estimate(const Strategy& strategy, std::size_t count, Random& random) const {
    const bool arePairs = strategy.kind == StrategyKind::Mis;
    const std::size_t step = arePairs ? 2 : 1;
    double mean = 0, squares = 0; // Welford 1962
    const auto directions = draw(strategy, count, random);
    for (std::size_t i = 0; i + step <= count; i += step) {
        double value = 0;
        for (std::size_t k = i; k < i + step; ++k) {
            if (!directions[k]) continue;
            const shared::vec3& wi = *directions[k];
            if (!arePairs) {
                value = ratio(contribution(wi), density(strategy, wi));
                continue;
            }
            const double lights = density({StrategyKind::Lights}, wi), bsdf = density({StrategyKind::Bsdf}, wi);
            const double own = k == i ? lights : bsdf, squared = lights * lights + bsdf * bsdf;
            value += ratio(contribution(wi) * own, squared);
        }
        const double before = value - mean;
        mean += before / static_cast<double>(i / step + 1);
        squares += before * (value - mean);
    }
    const double values = static_cast<double>(count / step);
    return {mean, values > 1 ? squares / (values - 1) * static_cast<double>(step) : 0};
}

double DirectionMap::integral() const {
    double sum = 0;
    for (const float value : density) sum += value;
    return density.empty() ? 0 : sum / static_cast<double>(density.size()) * 4 * std::numbers::pi;
}

std::size_t DirectionMap::cellOf(const shared::vec3& direction) const {
    const auto cell = [](double share, std::uint32_t n) {
        return std::min(static_cast<std::uint32_t>(std::max(share, 0.0) * n), n - 1);
    };
    const double azimuth = (std::atan2(direction.z, direction.x) + std::numbers::pi) / (2 * std::numbers::pi);
    return std::size_t{cell((1 - direction.y) / 2, height)} * 2 * height + cell(azimuth, 2 * height);
}

shared::vec3 cellDirection(std::uint32_t height, std::uint32_t column, std::uint32_t row, double u, double v) {
    const double y = 1 - 2 * (row + v) / height;
    const double angle = std::numbers::pi * (column + u) / height;
    const double radius = std::sqrt(std::max(0.0, 1 - y * y));
    return {static_cast<float>(-radius * std::cos(angle)), static_cast<float>(y),
            static_cast<float>(-radius * std::sin(angle))};
}

DirectionMap mapOf(const Probe& probe, const Strategy& strategy, std::uint32_t height, std::uint32_t side) {
    DirectionMap map{height, std::vector<float>(std::size_t{2} * height * height)};
    for (std::uint32_t row = 0; row < height; ++row) {
        for (std::uint32_t column = 0; column < 2 * height; ++column) {
            double sum = 0;
            for (std::uint32_t i = 0; i < side * side; ++i)
                sum += probe.density(strategy,
                                     cellDirection(height, column, row, (i % side + 0.5) / side,
                                                   (i / side + 0.5) / side)); // NOLINT(bugprone-integer-division)
            map.density[std::size_t{row} * 2 * height + column] = static_cast<float>(sum / (side * side));
        }
    }
    return map;
}

} // namespace rt::probe
