// What can be asked of a probe: names on the command line, titles in windows.
#pragma once
#include <cstdint>

#include "Common/Render/Names.h"

namespace rt::probe {

// Of a direction. Mis: one of either by turns, so that its density is the mixture's, but each sample is weighed by the
// heuristic.
enum class StrategyKind { Bsdf, Lights, Light, Mixture, Mis };

struct Strategy {
    StrategyKind kind = StrategyKind::Lights;
    std::uint32_t light = 0; // of Light: its index
    bool operator==(const Strategy&) const = default;
};

// Of a direction.
enum class Quantity {
    Density,  // of the strategy, per steradian
    Radiance, // that arrives
    Product,  // of radiance, bsdf and cosine: what is to be integrated
    Weight    // of the strategy's sample against those of the other one
};

enum class Projection {
    Sphere,    // a cylinder of equal areas
    Hemisphere // Lambert's azimuthal one of what is above the surface, of equal areas as well
};

// All but those of one light.
inline constexpr app::Named<StrategyKind> kStrategies[] = {
    {"bsdf", StrategyKind::Bsdf, "BSDF", "directions in which the surface scatters"},
    {"lights", StrategyKind::Lights, "Lights", "a light is chosen, and its shape sampled"},
    {"mixture", StrategyKind::Mixture, "BSDF + light mixture", "one direction, half from lights, half from the BSDF"},
    {"mis", StrategyKind::Mis, "MIS", "one sample of the lights and one of the BSDF, each weighed"}};
inline constexpr app::Named<Quantity> kQuantities[] = {
    {"pdf", Quantity::Density, "Density (pdf)", "of the strategy's directions, per steradian"},
    {"radiance", Quantity::Radiance, "Arriving radiance", "that comes from each direction, traced, its luminance"},
    {"product", Quantity::Product, "Product", "radiance times BSDF times cosine: what is to be integrated"},
    {"mis-weight", Quantity::Weight, "MIS weight", "of a sample of the strategy against those of the other one"}};
inline constexpr app::Named<Projection> kProjections[] = {
    {"sphere", Projection::Sphere, "All directions",
     "rows by height, from +Y at the top, columns by azimuth with +X in the middle; cells of one solid angle"},
    {"hemisphere", Projection::Hemisphere, "Hemisphere",
     "above the surface, seen from above, with its normal in the middle; cells of one solid angle"}};
inline constexpr app::Named<app::SamplerKind> kProbeSamplers[] = {
    {"independent", app::SamplerKind::Independent, "Independent", "random numbers that know nothing of each other"},
    {"stratified", app::SamplerKind::Stratified, "Stratified", "one number in each cell of the unit square by turns"},
    {"sobol", app::SamplerKind::Sobol, "Sobol", "an Owen-scrambled (0,2)-sequence"}};

// Of all shapes of light alike, in place of what the render does.
inline constexpr app::Named<app::ShapeSampling> kShapeStrategies[] = {
    {"lights-area", app::ShapeSampling::Area, "Lights, area"},
    {"lights-solid-angle", app::ShapeSampling::SolidAngle, "Lights, solid angle"},
    {"lights-projected", app::ShapeSampling::Projected, "Lights, projected"}};

// Whether it takes rays to know it.
constexpr bool isTraced(Quantity quantity) {
    return quantity == Quantity::Radiance || quantity == Quantity::Product;
}

} // namespace rt::probe
