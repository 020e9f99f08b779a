#include "Common/Bench/Config.h"

#include <algorithm>
#include <iterator>

#include "Common/App/Options/OptionValues.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Render/Names.h"
#include "Common/Shared/Base/Features.h"

namespace rt::bench {
namespace {

using namespace rt::app;
using Text = const std::string&;
using Says = Axis::Says;

constexpr Named<Denoise> kDenoise[] = {
    {"off", Denoise::Off}, {"on", Denoise::On}, {"live", Denoise::Live}, {"oidn", Denoise::Oidn}};
constexpr Named<bool> kFeatures[] = {{"auto", false}, {"all", true}};

void setEngine(Config& config, Text value) {
    if (std::find(std::begin(kEngines), std::end(kEngines), value) == std::end(kEngines))
        refuseValue("engine", value, alternatives({std::begin(kEngines), std::end(kEngines)}));
    config.engine = value;
}

// The name of one, which only the scene knows, or a pose.
void setCamera(Config& config, Text value) {
    if (isPose(value)) poseOf(value, {});
    config.camera = value;
}

void setFeatures(Config& config, Text value) {
    config.settings.features.reset();
    if (parseChoice("features", value, kFeatures)) config.settings.features = shared::kFeatureAll;
}

constexpr std::uint32_t kMaxThreads = 4096;
constexpr std::uint32_t kMaxRanks = 4096;
constexpr std::uint32_t kMaxVertices = 4096;
constexpr std::uint32_t kMaxPixels = 16384; // of a side

// A string as a template argument: functions of an axis have no other way to know its name.
template <std::size_t N>
struct Key {
    char text[N];
    constexpr Key(const char (&key)[N]) { std::copy_n(key, N, text); }
};

// The axis of a setting that is one of a table's.
template <Key kKey, auto kMember, const auto& kTable>
constexpr Axis method() {
    return {kKey.text, Says::How, [](const Config& c) { return nameOf(kTable, c.settings.*kMember); },
            [](Config& c, Text value) { c.settings.*kMember = parseChoice(kKey.text, value, kTable); }};
}

constexpr Axis kAxes[] = {
    {"scene", Says::Where, [](const Config& c) { return c.scene; }, [](Config& c, Text value) { c.scene = value; }},
    {"camera", Says::Where, [](const Config& c) { return c.camera; }, setCamera},
    {"engine", Says::Where, [](const Config& c) { return c.engine; }, setEngine},
    {"threads", Says::Where, [](const Config& c) { return std::to_string(c.threads); },
     [](Config& c, Text value) { c.threads = parseWhole("threads", value, 0, kMaxThreads); }},
    {"ranks", Says::Where, [](const Config& c) { return std::to_string(c.ranks); },
     [](Config& c, Text value) { c.ranks = parseWhole("ranks", value, 1, kMaxRanks); }},
    {"width", Says::Where, [](const Config& c) { return std::to_string(c.settings.width); },
     [](Config& c, Text value) { c.settings.width = parseWhole("width", value, 1, kMaxPixels); }},
    {"height", Says::Where, [](const Config& c) { return std::to_string(c.settings.height); },
     [](Config& c, Text value) { c.settings.height = parseWhole("height", value, 0, kMaxPixels); }},
    {"max_depth", Says::Where, [](const Config& c) { return std::to_string(c.settings.maxDepth); },
     [](Config& c, Text value) { c.settings.maxDepth = parseWhole("max_depth", value, 1, kMaxVertices); }},
    method<"light_sampling", &RenderSettings::lightSampling, kLightSamplings>(),
    method<"light_selection", &RenderSettings::lightSelection, kLightSelections>(),
    method<"sphere_light", &RenderSettings::sphereLight, kSphereLights>(),
    method<"quad_light", &RenderSettings::quadLight, kFlatLights>(),
    method<"triangle_light", &RenderSettings::triangleLight, kFlatLights>(),
    method<"specular_connections", &RenderSettings::specularConnections, kSpecularConnections>(),
    method<"edge_rays", &RenderSettings::edgeRays, kEdgeRays>(),
    method<"path_reuse", &RenderSettings::pathReuse, kPathReuse>(),
    method<"sampler", &RenderSettings::sampler, kSamplers>(),
    method<"adaptive", &RenderSettings::adaptive, kAdaptive>(),
    method<"russian_roulette", &RenderSettings::russianRoulette, kOnOff>(),
    {"denoise", Says::How, [](const Config& c) { return nameOf(kDenoise, c.denoise); },
     [](Config& c, Text value) { c.denoise = parseChoice("denoise", value, kDenoise); }},
    {"features", Says::How, [](const Config& c) { return nameOf(kFeatures, c.settings.features.has_value()); },
     setFeatures},
};

} // namespace

std::span<const Axis> axes() {
    return kAxes;
}

const Axis* findAxis(std::string_view name) {
    const auto* found = std::find_if(std::begin(kAxes), std::end(kAxes), [&](const Axis& a) { return a.name == name; });
    return found == std::end(kAxes) ? nullptr : found;
}

bool isKnown(const Axis& axis, const Config& config) {
    return !config.imported || (axis.says == Says::Where && axis.name != "threads" && axis.name != "ranks");
}

std::string keyOf(const Config& config) {
    std::string key;
    for (const Axis& axis : axes()) key += axis.get(config) + "|";
    return key;
}

std::string keyOf(const Config& config, Axis::Says what) {
    std::string key;
    for (const Axis& axis : axes())
        if (axis.says == what) key += axis.get(config) + "|";
    return key;
}

bool isGpuEngine(std::string_view engine) {
    return engine == "pipeline" || engine == "compute" || engine == "query";
}

} // namespace rt::bench
