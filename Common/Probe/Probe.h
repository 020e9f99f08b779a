// What light sampling and scattering do at the surface that a pixel shows: densities over the sphere of directions,
// directions that are drawn, and how well each strategy estimates the light that is sent to the camera directly.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "Common/Probe/SceneFormulas.h"
#include "Common/Shared/Path/Vertex.h"

namespace rt::probe {

// Of a direction. Mis: one of either by turns, so that its density is the mixture's, but each sample is weighed by the
// power heuristic.
enum class StrategyKind { Bsdf, Lights, Light, Mixture, Mis };

struct Strategy {
    StrategyKind kind = StrategyKind::Lights;
    std::uint32_t light = 0; // of Light: its index
};

// bsdf, lights, mixture, mis or the index of a light, of which there are `lightCount`. Nothing: it is none of them.
std::optional<Strategy> strategyOf(const std::string& text, std::uint32_t lightCount);

// Of the light that lamps with an extent and the sky send to the camera by way of the surface, luminance.
struct DirectEstimate {
    double mean = 0;
    double variance = 0; // of a sample: that of the mean, times the number of samples
};

class Probe {
  public:
    using Random = std::mt19937_64;

    // Nothing where the middle of the pixel shows no surface. The scene must outlive the probe.
    static std::optional<Probe> at(const SceneFormulas& scene, std::uint32_t x, std::uint32_t y);

    // Why the strategy has no density here; empty where it has one.
    std::string whyNoDensity(const Strategy& strategy) const;
    // Per steradian. Lights are aimed at above the surface only.
    float density(const Strategy& strategy, const shared::vec3& direction) const;
    // Directions in the order of drawing; nothing where a sample is dropped: absorbed, below the surface, or of a light
    // without extent.
    std::vector<std::optional<shared::vec3>> draw(const Strategy& strategy, std::size_t count, Random& random) const;
    // From `count` samples, an even number.
    DirectEstimate estimate(const Strategy& strategy, std::size_t count, Random& random) const;

    const shared::Vertex& vertex() const { return vertex_; }
    shared::vec3 position() const { return scene_->toWorld(vertex_.position); }
    std::uint32_t material() const { return material_; }

  private:
    Probe(const SceneFormulas& scene, const shared::Surface& surface, const shared::vec3& wo);

    std::optional<shared::vec3> drawLight(const Strategy& strategy, Random& random) const;
    std::optional<shared::vec3> drawBsdf(Random& random) const;
    // Luminance that leaves along wo for light from this direction, cosine included.
    double contribution(const shared::vec3& direction) const;
    shared::vec3 arriving(const shared::vec3& direction) const;

    const SceneFormulas* scene_;
    shared::Vertex vertex_;
    shared::LightContext context_;
    std::uint32_t material_;
};

// Means of a density over cells of one solid angle: rows from +Y to -Y by height, columns by azimuth, +X in the middle.
struct DirectionMap {
    std::uint32_t height = 0;   // rows; twice as many columns
    std::vector<float> density; // per steradian

    double integral() const; // over all directions
    std::size_t cellOf(const shared::vec3& direction) const;
};

// The direction of a cell's place; u and v in [0, 1], from its upper left.
shared::vec3 cellDirection(std::uint32_t height, std::uint32_t column, std::uint32_t row, double u, double v);

// Each cell the mean of side * side places.
DirectionMap mapOf(const Probe& probe, const Strategy& strategy, std::uint32_t height, std::uint32_t side);

} // namespace rt::probe
