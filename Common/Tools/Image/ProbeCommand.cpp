#include "Common/Tools/Image/ProbeCommand.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <system_error>

#include <nlohmann/json.hpp>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"
#include "Common/Probe/ProbeReport.h"
#include "Common/Render/Names.h"

namespace rt::tools {
namespace {

using Json = nlohmann::ordered_json;

// The table's value of that name, which the parser has checked; what it is without a name.
template <class E, std::size_t N>
E named(const app::Named<E> (&table)[N], const std::string& name, E otherwise) {
    const auto isNamed = [&](const app::Named<E>& row) { return row.name == name; };
    const auto* row = std::find_if(std::begin(table), std::end(table), isNamed);
    return row == std::end(table) ? otherwise : row->value;
}

app::Options optionsOf(const ProbeArguments& arguments) {
    app::Options options;
    applyPixel(arguments, options);
    app::RenderSettings& settings = options.settings;
    settings.sphereLight = named(app::kSphereLights, arguments.sphereLight, settings.sphereLight);
    settings.quadLight = named(app::kFlatLights, arguments.quadLight, settings.quadLight);
    settings.triangleLight = named(app::kFlatLights, arguments.triangleLight, settings.triangleLight);
    settings.lightSelection = named(app::kLightSelections, arguments.lightSelection, settings.lightSelection);
    return options;
}

probe::ProbeSettings settingsOf(const ProbeArguments& asked, const probe::Strategy& strategy) {
    probe::ProbeSettings settings;
    settings.strategy = strategy;
    settings.quantity = named(probe::kQuantities, asked.show, settings.quantity);
    settings.projections = {probe::Projection::Sphere, probe::Projection::Hemisphere};
    settings.rows = asked.rows;
    settings.paths = asked.paths;
    settings.samples = asked.samples;
    settings.numbers.kind = named(probe::kProbeSamplers, asked.sampler, settings.numbers.kind);
    settings.numbers.seed = asked.seed;
    settings.showsStrata = asked.strata > 0;
    if (settings.showsStrata) settings.numbers.strata = asked.strata;
    return settings;
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

void applyPixel(const PixelArguments& arguments, app::Options& options) {
    options.program = kImageTool;
    options.scene = arguments.scene;
    options.camera = arguments.camera;
    if (arguments.width != 0) options.size.width = arguments.width;
    if (arguments.height != 0) options.size.height = arguments.height;
}

std::array<std::uint32_t, 2> pixelOf(const std::string& text, const app::RenderSettings& settings) {
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

    probe::ProbeRun work(*at, settingsOf(asked, *strategy));
    while (!work.isDone()) work.advance();
    const probe::ProbeResult result = work.result();
    const Json figures = probe::figuresOf(result, scene.compiled()->id, {x, y});
    if (!arguments.output.empty()) probe::writePicture(arguments.output, result);
    if (asked.json)
        out << figures.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    else
        printLines(figures, "", out);
}

} // namespace rt::tools
