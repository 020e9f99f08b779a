// What every enumeration is called on the command line, in statistics and in checkpoints. The first row is the default.
#pragma once
#include <string>
#include <string_view>

#include "Common/App/Session/Settings.h"
#include "Common/Shared/Tonemap.h"

namespace rt::app {

// Execution policy of the CPU engine.
enum class Policy { Par, Seq, ParUnseq };
// How the GPU engine traces rays.
enum class GpuEngineKind { Auto, Pipeline, Compute };
// How radiance is brought into [0,1] for display.
enum class Tonemap : std::uint32_t {
    None = shared::kTonemapNone, // clamped
    Reinhard = shared::kTonemapReinhard,
    Aces = shared::kTonemapAces
};
// Images beside the picture: first-hit features, and what the film knows of each pixel.
enum class Aov { Albedo, Normal, Depth, Variance, Samples };

template <class E>
struct Named {
    std::string_view name;
    E value;
};

inline constexpr Named<LightSampling> kLightSamplings[] = {{"mis", LightSampling::Mis},
                                                           {"mis-balance", LightSampling::MisBalance},
                                                           {"mixture", LightSampling::Mixture},
                                                           {"bsdf", LightSampling::Bsdf}};
inline constexpr Named<LightSelection> kLightSelections[] = {{"contribution", LightSelection::Contribution},
                                                             {"power", LightSelection::Power},
                                                             {"uniform", LightSelection::Uniform}};
inline constexpr Named<ShapeSampling> kSphereLights[] = {{"auto", ShapeSampling::Auto},
                                                         {"cone", ShapeSampling::SolidAngle},
                                                         {"projected", ShapeSampling::Projected},
                                                         {"area", ShapeSampling::Area}};
inline constexpr Named<ShapeSampling> kFlatLights[] = {{"auto", ShapeSampling::Auto},
                                                       {"solid-angle", ShapeSampling::SolidAngle},
                                                       {"projected", ShapeSampling::Projected},
                                                       {"area", ShapeSampling::Area}};
inline constexpr Named<SamplerKind> kSamplers[] = {{"sobol", SamplerKind::Sobol},
                                                   {"sobol-blue", SamplerKind::SobolBlue},
                                                   {"stratified", SamplerKind::Stratified},
                                                   {"independent", SamplerKind::Independent}};
inline constexpr Named<Policy> kPolicies[] = {
    {"par", Policy::Par}, {"seq", Policy::Seq}, {"par_unseq", Policy::ParUnseq}};
inline constexpr Named<GpuEngineKind> kGpuEngines[] = {
    {"auto", GpuEngineKind::Auto}, {"pipeline", GpuEngineKind::Pipeline}, {"compute", GpuEngineKind::Compute}};
inline constexpr Named<Tonemap> kTonemaps[] = {
    {"none", Tonemap::None}, {"reinhard", Tonemap::Reinhard}, {"aces", Tonemap::Aces}};
inline constexpr Named<Aov> kAovs[] = {{"albedo", Aov::Albedo},
                                       {"normal", Aov::Normal},
                                       {"depth", Aov::Depth},
                                       {"variance", Aov::Variance},
                                       {"samples", Aov::Samples}};
inline constexpr Named<bool> kOnOff[] = {{"on", true}, {"off", false}};

template <class E, std::size_t N>
std::string nameOf(const Named<E> (&table)[N], E value) {
    for (const auto& row : table)
        if (row.value == value) return std::string(row.name);
    return {};
}

} // namespace rt::app
