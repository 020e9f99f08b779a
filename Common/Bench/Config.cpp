#include "Common/Bench/Config.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "Common/App/Options/Names.h"
#include "Common/App/Options/OptionValues.h"
#include "Common/Shared/Base/Features.h"

namespace rt::bench {
namespace {

using namespace rt::app;
using Text = const std::string&;
using Says = Axis::Says;

constexpr Named<bool> kFeatures[] = {{"auto", false}, {"all", true}};

void setEngine(Config& config, Text value) {
    if (std::find(std::begin(kEngines), std::end(kEngines), value) == std::end(kEngines))
        refuseValue("engine", value, alternatives({std::begin(kEngines), std::end(kEngines)}));
    config.engine = value;
}

void setFeatures(Config& config, Text value) {
    config.settings.features.reset();
    if (parseChoice("features", value, kFeatures)) config.settings.features = shared::kFeatureAll;
}

constexpr std::uint32_t kMostThreads = 4096;
constexpr std::uint32_t kMostVertices = 4096;
constexpr std::uint32_t kMostPixels = 16384; // of a side

constexpr Axis kAxes[] = {
    {"scene", Says::Where, [](const Config& c) { return c.scene; }, [](Config& c, Text value) { c.scene = value; }},
    {"engine", Says::Where, [](const Config& c) { return c.engine; }, setEngine},
    {"threads", Says::Where, [](const Config& c) { return std::to_string(c.threads); },
     [](Config& c, Text value) { c.threads = parseWhole("threads", value, 0, kMostThreads); }},
    {"width", Says::Where, [](const Config& c) { return std::to_string(c.settings.width); },
     [](Config& c, Text value) { c.settings.width = parseWhole("width", value, 1, kMostPixels); }},
    {"height", Says::Where, [](const Config& c) { return std::to_string(c.settings.height); },
     [](Config& c, Text value) { c.settings.height = parseWhole("height", value, 0, kMostPixels); }},
    {"max_depth", Says::Where, [](const Config& c) { return std::to_string(c.settings.maxDepth); },
     [](Config& c, Text value) { c.settings.maxDepth = parseWhole("max_depth", value, 1, kMostVertices); }},
    {"light_sampling", Says::How, [](const Config& c) { return nameOf(kLightSamplings, c.settings.lightSampling); },
     [](Config& c, Text value) { c.settings.lightSampling = parseChoice("light_sampling", value, kLightSamplings); }},
    {"light_selection", Says::How, [](const Config& c) { return nameOf(kLightSelections, c.settings.lightSelection); },
     [](Config& c, Text value) {
         c.settings.lightSelection = parseChoice("light_selection", value, kLightSelections);
     }},
    {"sphere_light", Says::How, [](const Config& c) { return nameOf(kSphereLights, c.settings.sphereLight); },
     [](Config& c, Text value) { c.settings.sphereLight = parseChoice("sphere_light", value, kSphereLights); }},
    {"quad_light", Says::How, [](const Config& c) { return nameOf(kFlatLights, c.settings.quadLight); },
     [](Config& c, Text value) { c.settings.quadLight = parseChoice("quad_light", value, kFlatLights); }},
    {"triangle_light", Says::How, [](const Config& c) { return nameOf(kFlatLights, c.settings.triangleLight); },
     [](Config& c, Text value) { c.settings.triangleLight = parseChoice("triangle_light", value, kFlatLights); }},
    {"sampler", Says::How, [](const Config& c) { return nameOf(kSamplers, c.settings.sampler); },
     [](Config& c, Text value) { c.settings.sampler = parseChoice("sampler", value, kSamplers); }},
    {"russian_roulette", Says::How, [](const Config& c) { return nameOf(kOnOff, c.settings.russianRoulette); },
     [](Config& c, Text value) { c.settings.russianRoulette = parseChoice("russian_roulette", value, kOnOff); }},
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
    return engine == "pipeline" || engine == "compute";
}

} // namespace rt::bench
