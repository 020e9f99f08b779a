#include "Common/Tools/Image/ProbeCommand.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"
#include "Common/Probe/ChiSquare.h"
#include "Common/Probe/Probe.h"
#include "Common/Probe/ProbePicture.h"
#include "Common/Render/Names.h"

namespace rt::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kSide = 4; // places of a cell, squared

// The table's value of that name, which the parser has checked; what it is without a name.
template <class E, std::size_t N>
E named(const app::Named<E> (&table)[N], const std::string& name, E otherwise) {
    const auto isNamed = [&](const app::Named<E>& row) { return row.name == name; };
    const auto* row = std::find_if(std::begin(table), std::end(table), isNamed);
    return row == std::end(table) ? otherwise : row->value;
}

app::Options optionsOf(const ProbeArguments& arguments) {
    app::Options options;
    options.program = kImageTool;
    options.scene = arguments.scene;
    options.camera = arguments.camera;
    if (arguments.width != 0) options.size.width = arguments.width;
    if (arguments.height != 0) options.size.height = arguments.height;
    app::RenderSettings& settings = options.settings;
    settings.sphereLight = named(app::kSphereLights, arguments.sphereLight, settings.sphereLight);
    settings.quadLight = named(app::kFlatLights, arguments.quadLight, settings.quadLight);
    settings.triangleLight = named(app::kFlatLights, arguments.triangleLight, settings.triangleLight);
    settings.lightSelection = named(app::kLightSelections, arguments.lightSelection, settings.lightSelection);
    return options;
}

std::pair<std::uint32_t, std::uint32_t> pixelOf(const std::string& text, const app::RenderSettings& settings) {
    std::uint32_t x = 0, y = 0;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, x);
    const bool hasComma = first.ec == std::errc() && first.ptr != end && *first.ptr == ',';
    const auto second = hasComma ? std::from_chars(first.ptr + 1, end, y) : first;
    if (!hasComma || second.ec != std::errc() || second.ptr != end || x >= settings.width || y >= settings.height)
        throw UsageError(text + ": must be a pixel X,Y from 0,0 to " + std::to_string(settings.width - 1) + "," +
                         std::to_string(settings.height - 1));
    return {x, y};
}

Json numbers(const shared::vec3& v) {
    return {v.x, v.y, v.z};
}

// Whether the samples follow the map.
Json testOf(const probe::DirectionMap& map, const std::vector<std::optional<shared::vec3>>& drawn) {
    std::vector<double> counts(map.density.size());
    for (const auto& direction : drawn)
        if (direction) ++counts[map.cellOf(*direction)];
    const std::vector<double> expectations(map.density.begin(), map.density.end());
    const auto test = probe::chiSquare(counts, expectations);
    if (!test) return nullptr;
    return {{"statistic", test->statistic}, {"degrees", test->degrees}, {"p", test->p}};
}

// Of every strategy that has a density here.
Json estimatesOf(const probe::Probe& at, std::size_t samples, probe::Probe::Random& random) {
    static constexpr std::pair<const char*, probe::StrategyKind> kAll[] = {{"bsdf", probe::StrategyKind::Bsdf},
                                                                           {"lights", probe::StrategyKind::Lights},
                                                                           {"mixture", probe::StrategyKind::Mixture},
                                                                           {"mis", probe::StrategyKind::Mis}};
    Json estimates = Json::object();
    for (const auto& [name, kind] : kAll) {
        if (!at.whyNoDensity({kind}).empty()) continue;
        const probe::DirectEstimate estimate = at.estimate({kind}, samples, random);
        estimates[name] = {{"mean", estimate.mean}, {"variance", estimate.variance}};
    }
    return estimates;
}

// "key value" a line; of what holds more, "key.key value".
void printLines(const Json& figures, const std::string& prefix, std::ostream& out) {
    for (const auto& [key, value] : figures.items()) {
        if (value.is_object()) {
            printLines(value, prefix + key + ".", out);
            continue;
        }
        out << prefix << key;
        if (value.is_array())
            for (const Json& element : value) out << ' ' << element.dump();
        else
            out << ' ' << (value.is_string() ? value.get<std::string>() : value.dump());
        out << '\n';
    }
}

} // namespace

void runProbe(const ImageArguments& arguments, std::ostream& out) {
    const ProbeArguments& asked = arguments.probe;
    if (!arguments.output.empty()) image::checkWritable(arguments.output);
    const app::Options options = optionsOf(asked);
    const probe::SceneFormulas scene(app::compile(app::SceneRequest{asked.scene, true, asked.camera}), options, 0.0);
    const auto [x, y] = pixelOf(asked.pixel, scene.options().settings);
    const std::uint32_t lights = scene.compiled()->globals.lightCount;
    const auto strategy = probe::strategyOf(asked.strategy, lights);
    if (!strategy)
        throw UsageError("--strategy " + asked.strategy +
                         ": must be bsdf, lights, mixture, mis or the index of one of " + std::to_string(lights) +
                         " lights");
    const auto at = probe::Probe::at(scene, x, y);
    if (!at) throw InputError(asked.scene + ": pixel " + asked.pixel + " shows no surface");
    if (const std::string why = at->whyNoDensity(*strategy); !why.empty())
        throw InputError(asked.scene + ": pixel " + asked.pixel + ", strategy " + asked.strategy + ": " + why);

    probe::Probe::Random random(asked.seed);
    const auto drawn = at->draw(*strategy, asked.samples, random);
    const probe::DirectionMap map = probe::mapOf(*at, *strategy, asked.rows, kSide);
    const auto dropped = std::count(drawn.begin(), drawn.end(), std::nullopt);
    const Json figures = {{"version", 1},
                          {"scene", scene.compiled()->id},
                          {"pixel", {x, y}},
                          {"strategy", asked.strategy},
                          {"position", numbers(at->position())},
                          {"normal", numbers(at->vertex().shading)},
                          {"material", scene.compiled()->materialNames[at->material()]},
                          {"lights", lights},
                          {"integral", map.integral()},
                          {"samples", asked.samples},
                          {"dropped", dropped},
                          {"chi_square", testOf(map, drawn)},
                          {"estimates", estimatesOf(*at, asked.samples / 2 * 2, random)}};
    if (!arguments.output.empty())
        image::writeImage(arguments.output, image::isDisplayReferred(arguments.output)
                                                ? probe::pictureOf(*at, *strategy, map, drawn)
                                                : probe::imageOf(map));
    if (asked.json)
        out << figures.dump(2) << '\n';
    else
        printLines(figures, "", out);
}

} // namespace rt::tools
