// The tables of what can be chosen: names on the command line, in statistics and in checkpoints, titles in windows. The
// first row is the default.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>

#include "Common/Render/Settings.h"
#include "Common/Shared/Tonemap.h"

namespace rt::app {

// Execution policy of the CPU engine.
enum class Policy { Par, Seq, ParUnseq };
// How the GPU engine traces rays.
enum class GpuEngineKind { Auto, Pipeline, Compute, Query };
// How radiance is brought into [0,1] for display.
enum class Tonemap : std::uint32_t {
    None = shared::kTonemapNone, // clamped
    Reinhard = shared::kTonemapReinhard,
    Aces = shared::kTonemapAces,
    Agx = shared::kTonemapAgx,
    Neutral = shared::kTonemapNeutral
};
// Images beside the picture: features of surfaces in sight, and what the film knows of each pixel.
enum class Aov {
    Albedo,
    Normal,
    Depth,
    WideAlbedo,
    WideNormal,
    WideDepth,
    Emission,
    Variance,
    Samples,
    Denoised,
    DenoisedError
};

// A value of an enumeration: on the command line, in files and in statistics; in a window; and a sentence on what it
// does.
template <class E>
struct Named {
    std::string_view name;
    E value;
    const char* title = nullptr; // null: the name
    const char* help = nullptr;
};

inline constexpr Named<LightSampling> kLightSamplings[] = {
    {"mis", LightSampling::Mis, "MIS (power heuristic)",
     "lights and the BSDF are both sampled, weighed against each other by the power heuristic"},
    {"mis-balance", LightSampling::MisBalance, "MIS (balance heuristic)", "weighed by the balance heuristic instead"},
    {"mixture", LightSampling::Mixture, "BSDF + light mixture", "one direction, half from lights, half from the BSDF"},
    {"bsdf", LightSampling::Bsdf, "Off (BSDF only)", "light is found by chance"}};
inline constexpr Named<LightSelection> kLightSelections[] = {
    {"contribution", LightSelection::Contribution, "By contribution", "by a bound of what each brings to the point"},
    {"power", LightSelection::Power, "By power", "in proportion to what each emits"},
    {"uniform", LightSelection::Uniform, "Uniform", "all alike"}};
inline constexpr Named<ShapeSampling> kSphereLights[] = {
    {"auto", ShapeSampling::Auto, "Auto", "nearly as projected, but faster; cone when far"},
    {"cone", ShapeSampling::SolidAngle, "Cone", "in the cone of directions that it is seen in"},
    {"projected", ShapeSampling::Projected, "Projected cap", "in that cone, weighed by the cosine at the surface"},
    {"area", ShapeSampling::Area, "Area", "on its area"}};
// Of quads and of triangles.
inline constexpr Named<ShapeSampling> kFlatLights[] = {
    {"auto", ShapeSampling::Auto, "Auto", "area when far, strip when thin, else solid angle"},
    {"solid-angle", ShapeSampling::SolidAngle, "Solid angle", "in the solid angle that it is seen in"},
    {"projected", ShapeSampling::Projected, "Projected solid angle", "in that, weighed by the cosine at the surface"},
    {"area", ShapeSampling::Area, "Area", "on its area"}};
inline constexpr Named<SamplerKind> kSamplers[] = {
    {"sobol", SamplerKind::Sobol, "Sobol (Owen-scrambled)", "well spread in many dimensions"},
    {"sobol-blue", SamplerKind::SobolBlue, "Sobol, blue noise", "one sequence for all pixels, so that noise is finer"},
    {"stratified", SamplerKind::Stratified, "Stratified", "one in each cell of a grid"},
    {"independent", SamplerKind::Independent, "Independent (random)", "each on its own"}};
inline constexpr Named<Policy> kPolicies[] = {{"par", Policy::Par, "All cores"},
                                              {"seq", Policy::Seq, "One core"},
                                              {"par_unseq", Policy::ParUnseq, "All cores (par_unseq)"}};
inline constexpr Named<GpuEngineKind> kGpuEngines[] = {
    {"auto", GpuEngineKind::Auto, "Auto", "what is measured to be fastest on this device for such a scene"},
    {"pipeline", GpuEngineKind::Pipeline, "Ray tracing pipeline", "the device's own acceleration structures"},
    {"compute", GpuEngineKind::Compute, "Compute shaders", "our tree, for devices without a ray tracing pipeline too"},
    {"query", GpuEngineKind::Query, "Ray queries", "compute shaders through the device's own acceleration structures"}};
inline constexpr Named<Tonemap> kTonemaps[] = {{"none", Tonemap::None, "None (clamp)"},
                                               {"reinhard", Tonemap::Reinhard, "Reinhard"},
                                               {"aces", Tonemap::Aces, "ACES-like"},
                                               {"agx", Tonemap::Agx, "AgX (filmic)"},
                                               {"neutral", Tonemap::Neutral, "Neutral (Khronos PBR)"}};
inline constexpr Named<Aov> kAovs[] = {{"albedo", Aov::Albedo},
                                       {"normal", Aov::Normal},
                                       {"depth", Aov::Depth},
                                       {"wide-albedo", Aov::WideAlbedo},
                                       {"wide-normal", Aov::WideNormal},
                                       {"wide-depth", Aov::WideDepth},
                                       {"emission", Aov::Emission},
                                       {"variance", Aov::Variance},
                                       {"samples", Aov::Samples},
                                       {"denoised", Aov::Denoised},
                                       {"denoised-error", Aov::DenoisedError}};
inline constexpr Named<bool> kAdaptive[] = {
    {"off", false, "Off", "every pixel gets the same number"},
    {"on", true, "On", "more where a pilot has met more noise; unbiased, SPP is the mean; not with strata"}};
inline constexpr Named<bool> kSpecularConnections[] = {
    {"off", false, "Off", "scattering alone finds it"},
    {"on", true, "On",
     "by connections to where it comes from, or paths aimed at glass, where chance is noisy; unbiased"}};
inline constexpr Named<bool> kEdgeRays[] = {
    {"off", false, "Off", "the path's own ray finds or misses the light"},
    {"on", true, "On", "several rays a sample where a light's edge crosses a pixel, or a ball shows lights; unbiased"}};
inline constexpr Named<PathReuse> kPathReuse[] = {
    {"auto", PathReuse::Auto, "Auto", "in rooms of few lamps, where indirect light makes the noise"},
    {"off", PathReuse::Off, "Off", "each pixel has the light of its own paths alone"},
    {"on", PathReuse::On, "On", "less noise of light by way of other surfaces; unbiased"}};
inline constexpr Named<bool> kOnOff[] = {{"on", true}, {"off", false}};

// Each setting that chooses a method: visit(key, title, help, table, settings.member...), the key as in files; with
// dashes it is the flag. The title, without "Sampling strategy for", fits the windows' column of labels. Of one
// RenderSettings, or of several side by side.
template <typename Visit, typename... Settings>
void forEachMethod(const Visit& visit, Settings&... settings) {
    visit("light_sampling", "Light sampling", "direct-lighting estimator: how light is found", kLightSamplings,
          settings.lightSampling...);
    visit("light_selection", "Light selection", "how one of the lights is chosen", kLightSelections,
          settings.lightSelection...);
    visit("sphere_light", "Sampling strategy for sphere lights", "where a sphere is sampled", kSphereLights,
          settings.sphereLight...);
    visit("quad_light", "Sampling strategy for quad lights", "where a quad, disk or cylinder is sampled", kFlatLights,
          settings.quadLight...);
    visit("triangle_light", "Sampling strategy for triangle lights", "where a triangle is sampled", kFlatLights,
          settings.triangleLight...);
    visit("specular_connections", "Glass connections", "how light that smooth spheres refract or reflect is found",
          kSpecularConnections, settings.specularConnections...);
    visit("edge_rays", "Edge rays", "how camera rays sample lights in sight at their edges", kEdgeRays,
          settings.edgeRays...);
    visit("path_reuse", "Path reuse",
          "whether neighbouring pixels share what their paths bring from the second vertex on", kPathReuse,
          settings.pathReuse...);
    visit("sampler", "Pixel sampling", "the random numbers", kSamplers, settings.sampler...);
    visit("adaptive", "Adaptive samples", "how many samples each pixel gets", kAdaptive, settings.adaptive...);
}

// "--light-sampling" of "light_sampling".
inline std::string flagOf(std::string key) {
    std::replace(key.begin(), key.end(), '_', '-');
    return "--" + key;
}

template <class E, std::size_t N>
std::string nameOf(const Named<E> (&table)[N], E value) {
    for (const auto& row : table)
        if (row.value == value) return std::string(row.name);
    return {};
}

template <class E, std::size_t N>
std::string titleOf(const Named<E> (&table)[N], E value) {
    for (const auto& row : table)
        if (row.value == value) return row.title ? row.title : std::string(row.name);
    return {};
}

// "a, b, c".
template <class E, std::size_t N>
std::string joinedNames(const Named<E> (&table)[N]) {
    std::string text;
    for (const auto& row : table) text += (text.empty() ? "" : ", ") + std::string(row.name);
    return text;
}

} // namespace rt::app
