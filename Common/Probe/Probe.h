// What light sampling and scattering do at the surface that a pixel shows: densities over the sphere of directions,
// directions that are drawn, and the light that comes from there.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "Common/Probe/ArrivingLight.h"
#include "Common/Probe/ProbeNames.h"
#include "Common/Probe/SceneFormulas.h"
#include "Common/Shared/Path/PathSamples.h"
#include "Common/Shared/Path/Vertex.h"

namespace rt::probe {

// bsdf, lights, mixture, mis or the index of a light, of which there are `lightCount`. Nothing: it is none of them.
std::optional<Strategy> strategyOf(const std::string& text, std::uint32_t lightCount);
std::string nameOf(const Strategy& strategy); // the reverse

// Where the numbers of samples come from, as in a render; of stratified ones the square has strata * strata cells.
struct NumberSettings {
    app::SamplerKind kind = app::SamplerKind::Independent;
    std::uint32_t strata = 8;
    std::uint32_t seed = 0;
    bool operator==(const NumberSettings&) const = default;
};
// Of sample `index`; those of different streams have nothing to do with each other.
shared::Sampler samplerOf(const NumberSettings& settings, std::uint32_t stream, std::uint32_t index);

// A direction that was drawn.
struct Drawn {
    shared::vec2 place; // in the unit square, that it was made of
    bool isByBsdf = false;
    std::optional<shared::vec3>
        direction; // nothing: absorbed, below the surface, hidden by the light itself, or of a light without extent
};

// A light, and with which probability it is chosen.
struct LightShare {
    std::uint32_t light = 0;
    float probability = 0;
};

class Probe {
  public:
    // Of the camera of the scene or another one, as its image of that size sees it. Nothing where the middle of the
    // pixel shows no surface. The scene must outlive the probe.
    static std::optional<Probe> at(const SceneFormulas& scene, std::uint32_t x, std::uint32_t y);
    static std::optional<Probe> at(const SceneFormulas& scene, const shared::Camera& camera, std::uint32_t x,
                                   std::uint32_t y);

    // The same surface, for formulas of the same scene with other options, which must outlive it.
    Probe with(const SceneFormulas& scene) const;

    // Why the strategy has no density here; empty where it has one.
    std::string whyNoDensity(const Strategy& strategy) const;
    // Per steradian. Lights are aimed at above the surface only.
    float density(const Strategy& strategy, const shared::vec3& direction) const;
    // Of a sample of the lights in this direction, or of scattering where the strategy is Bsdf: its share of the light
    // from there by the renderer's heuristic, of Mixture by the balance heuristic. 0 where the strategy has no density.
    float weight(const Strategy& strategy, const shared::vec3& direction) const;
    // The quantity in a direction, of light its luminance; what is traced takes numbers from the sampler.
    double value(Quantity quantity, const Strategy& strategy, const shared::vec3& direction,
                 const shared::Sampler& sampler) const;

    // Sample `index`, a pure function of its arguments. Of Mis every other one is of the lights.
    Drawn draw(const Strategy& strategy, const NumberSettings& settings, std::uint32_t index) const;
    // What a place in the unit square becomes; nothing where its direction would be dropped, or isOfOneSquare() is
    // false. Of Mis that of the lights.
    std::optional<shared::vec3> directionAt(const Strategy& strategy, const shared::vec2& place) const;
    // Whether the direction follows from one place in the unit square alone.
    bool isOfOneSquare(const Strategy& strategy) const;

    // Luminance that leaves to the camera for light that lamps with an extent and the sky send from this direction.
    double contribution(const shared::vec3& direction) const;
    // The lights that are chosen most often, the first one most; at most so many.
    std::vector<LightShare> likelyLights(std::size_t most) const;

    const SceneFormulas& scene() const { return *scene_; }
    const shared::Vertex& vertex() const { return vertex_; }
    shared::vec3 position() const { return scene_->toWorld(vertex_.position); }
    std::uint32_t material() const { return material_; }

  private:
    Probe(const SceneFormulas& scene, const shared::Vertex& vertex, std::uint32_t material);

    std::optional<shared::vec3> drawLight(const Strategy& strategy, const shared::VertexSamples& u) const;
    std::optional<shared::vec3> drawBsdf(const shared::vec2& place) const;
    shared::Ray rayTo(const shared::vec3& direction) const;
    shared::vec3 emittedFrom(const shared::vec3& direction) const;

    const SceneFormulas* scene_;
    ArrivingLight arriving_;
    shared::Vertex vertex_;
    shared::LightContext context_;
    std::uint32_t material_;
};

} // namespace rt::probe
