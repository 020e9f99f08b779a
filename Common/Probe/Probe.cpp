#include "Common/Probe/Probe.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "Common/Probe/Densities.h"
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Camera.h"
#include "Common/Shared/Path/Emission.h"
#include "Common/Shared/Shape/Surface.h"

namespace rt::probe {

using namespace rt::shared;

namespace {

double luminance(const shared::vec3& light) {
    return 0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z;
}

} // namespace

std::optional<Strategy> strategyOf(const std::string& text, std::uint32_t lightCount) {
    for (const auto& row : kStrategies)
        if (row.name == text) return Strategy{row.value};
    Strategy strategy{StrategyKind::Light};
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, strategy.light);
    if (error != std::errc() || rest != end || strategy.light >= lightCount) return std::nullopt;
    return strategy;
}

std::string nameOf(const Strategy& strategy) {
    for (const auto& row : kStrategies)
        if (row.value == strategy.kind) return std::string(row.name);
    return std::to_string(strategy.light);
}

Sampler samplerOf(const NumberSettings& settings, std::uint32_t stream, std::uint32_t index) {
    RenderParams params{};
    params.width = 1;
    params.seed = settings.seed;
    params.samplerKind = static_cast<uint>(settings.kind);
    params.strataX = params.strataY = std::max(settings.strata, 1u);
    return makeSampler(params, stream, 0u, index);
}

// ---- the place -----------------------------------------------------------------------------------------------------

std::optional<Probe> Probe::at(const SceneFormulas& scene, std::uint32_t x, std::uint32_t y) {
    return at(scene, scene.camera(), x, y);
}

std::optional<Probe> Probe::at(const SceneFormulas& scene, const Camera& camera, std::uint32_t x, std::uint32_t y) {
    const uvec2 size(scene.params().width, scene.params().height);
    const shared::vec2 middle(0.5f, 0.5f);
    const Ray ray = generateCameraRay(kFeatureAll, camera, uvec2(x, y), size, middle, middle, 0.0f);
    const Hit hit = ArrivingLight(scene).closest(ray);
    if (!(hit.t >= 0.0f)) return std::nullopt;
    const Surface surface = makeSurface(kFeatureAll, scene.view(), ray, hit);
    return Probe(scene, vertexOn(scene, surface, -ray.direction), surface.material);
}

Probe Probe::with(const SceneFormulas& scene) const {
    return {scene, vertex_, material_};
}

Probe::Probe(const SceneFormulas& scene, const Vertex& vertex, std::uint32_t material)
    : scene_(&scene),
      arriving_(scene),
      vertex_(vertex),
      context_(contextAt(vertex_.origin, vertex_.shading)),
      material_(material) {
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

std::vector<LightShare> Probe::likelyLights(std::size_t most) const {
    std::vector<LightShare> lights(scene_->compiled()->globals.lightCount);
    for (std::uint32_t i = 0; i < lights.size(); ++i) lights[i] = {i, probabilityOf(*scene_, i, context_)};
    const auto middle = lights.begin() + static_cast<std::ptrdiff_t>(std::min(most, lights.size()));
    std::partial_sort(lights.begin(), middle, lights.end(), [](const LightShare& a, const LightShare& b) {
        return a.probability != b.probability ? a.probability > b.probability : a.light < b.light;
    });
    lights.erase(middle, lights.end());
    return lights;
}

// ---- quantities of a direction -------------------------------------------------------------------------------------

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

float Probe::weight(const Strategy& strategy, const shared::vec3& direction) const {
    const bool isOfBsdf = strategy.kind == StrategyKind::Bsdf;
    const float own = density({isOfBsdf ? StrategyKind::Bsdf : StrategyKind::Lights}, direction);
    const float other = density({isOfBsdf ? StrategyKind::Lights : StrategyKind::Bsdf}, direction);
    if (!(own > 0.0f)) return 0.0f;
    const bool isBalanced =
        strategy.kind == StrategyKind::Mixture || scene_->params().lightSampling == kSampleMisBalance;
    return isBalanced ? balanceHeuristic(own, other) : powerHeuristic(own, other);
}

double Probe::value(Quantity quantity, const Strategy& strategy, const shared::vec3& direction,
                    const Sampler& sampler) const {
    switch (quantity) {
        case Quantity::Density:
            return density(strategy, direction);
        case Quantity::Weight:
            return weight(strategy, direction);
        default:
            break;
    }
    if (!(dot(direction, vertex_.normal) > 0.0f)) return 0;
    shared::vec3 scattered(1.0f);
    if (quantity == Quantity::Product) scattered = shared::vec3(evalScattering(kFeatureAll, vertex_, direction));
    if (!(maxComponent(scattered) > 0.0f)) return 0;
    return luminance(scattered * arriving_.trace(rayTo(direction), sampler));
}

Ray Probe::rayTo(const shared::vec3& direction) const {
    Ray ray;
    ray.origin = offsetOrigin(vertex_.position, vertex_.error, vertex_.normal, direction);
    ray.direction = direction;
    ray.time = 0.0f;
    return ray;
}

shared::vec3 Probe::emittedFrom(const shared::vec3& direction) const {
    const Ray ray = rayTo(direction);
    const Hit hit = arriving_.closest(ray);
    if (!(hit.t >= 0.0f)) return skyRadiance(kFeatureAll, scene_->view(), direction);
    const Surface surface = makeSurface(kFeatureAll, scene_->view(), ray, hit);
    const Material& material = scene_->view().materials[surface.material];
    const bool isFront = dot(direction, surface.normal) < 0.0f;
    if (!isFront && material.emissionSides != kSidesBoth) return shared::vec3(0.0f);
    return surfaceEmission(kFeatureAll, scene_->view(), material, surface);
}

double Probe::contribution(const shared::vec3& direction) const {
    return luminance(shared::vec3(evalScattering(kFeatureAll, vertex_, direction)) * emittedFrom(direction));
}

// ---- samples -------------------------------------------------------------------------------------------------------

std::optional<shared::vec3> Probe::drawLight(const Strategy& strategy, const VertexSamples& u) const {
    const SceneGlobals& globals = scene_->view().globals;
    std::uint32_t light = strategy.light;
    shared::vec2 place = u.light;
    if (strategy.kind != StrategyKind::Light) {
        LightContext context = context_;
        const LightChoice choice = chooseLightAt(*scene_, selectionSample(kFeatureAll, globals, u), context);
        if (choice.light == kNone) return std::nullopt;
        light = choice.light;
        place = positionSample(kFeatureAll, globals, choice, u);
    }
    const Light& chosen = scene_->view().lights[light];
    if (isPunctual(kFeatureAll, chosen)) return std::nullopt;
    const LightSample s =
        sampleChosenLight(kFeatureAll, scene_->view(), scene_->params(), chosen, vertex_, 0.0f, place);
    if (!(s.pdf > 0.0f) || !(dot(s.wi, vertex_.shading) > 0.0f)) return std::nullopt;
    if (isHiddenByItself(chosen, context_.position, 0.0f, s)) return std::nullopt;
    return s.wi;
}

std::optional<shared::vec3> Probe::drawBsdf(const shared::vec2& place) const {
    const BsdfSample s = sampleScattering(kFeatureAll, vertex_, place);
    if (!(maxComponent(s.weight) > 0.0f)) return std::nullopt;
    return s.wi;
}

Drawn Probe::draw(const Strategy& strategy, const NumberSettings& settings, std::uint32_t index) const {
    const bool isMis = strategy.kind == StrategyKind::Mis; // both samples of a pair have the numbers of one path
    const VertexSamples u = vertexSamples(kFeatureAll, samplerOf(settings, 0u, isMis ? index / 2 : index), 0u);
    const bool isByBsdf = strategy.kind == StrategyKind::Bsdf || (isMis && index % 2 == 1) ||
                          (strategy.kind == StrategyKind::Mixture && !(u.roulette.y < 0.5f));
    if (isByBsdf) return {u.bsdf, true, drawBsdf(u.bsdf)};
    return {u.light, false, drawLight(strategy, u)};
}

bool Probe::isOfOneSquare(const Strategy& strategy) const {
    if (strategy.kind == StrategyKind::Mixture) return false;
    const bool isChosen = strategy.kind == StrategyKind::Lights || strategy.kind == StrategyKind::Mis;
    return !isChosen || !usesLightTree(kFeatureAll, scene_->view().globals.lightCount);
}

std::optional<shared::vec3> Probe::directionAt(const Strategy& strategy, const shared::vec2& place) const {
    if (!isOfOneSquare(strategy)) return std::nullopt;
    if (strategy.kind == StrategyKind::Bsdf) return drawBsdf(place);
    VertexSamples u{};
    u.light = u.bsdf = place;
    return drawLight(strategy, u);
}

} // namespace rt::probe
