#include "Common/Tools/Image/ImageArguments.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <system_error>

#include <CLI/CLI.hpp>

#include "Common/Core/BuildInfo.h"
#include "Common/Core/Error.h"
#include "Common/Image/Film.h"
#include "Common/Manual/Parse.h"
#include "Common/Probe/ProbeNames.h"
#include "Common/Render/Names.h"

namespace rt::tools {
namespace {

constexpr const char* kReadable = "F.exr|.png|.hdr|.pfm|.jpg|.bmp|.tga|.tif|.webp";
constexpr const char* kWritable = "F.png|.exr|.hdr|.pfm";

template <class Row, std::size_t N>
std::string alternativesOf(const Row (&table)[N]) {
    std::string text;
    for (const Row& row : table) text += (text.empty() ? "" : "|") + std::string(row.name);
    return text;
}

template <class Row, std::size_t N>
CLI::Validator isNameIn(const Row (&table)[N]) {
    const auto check = [&table](const std::string& name) {
        const auto isNamed = [&name](const Row& row) { return row.name == name; };
        const bool found = std::any_of(std::begin(table), std::end(table), isNamed);
        return found ? std::string() : name + ": must be among " + alternativesOf(table);
    };
    return CLI::Validator(check, "");
}

// A value that must be the name of a row.
template <class Row, std::size_t N>
void addName(CLI::App& app, const std::string& flag, std::string& target, const Row (&table)[N],
             const std::string& help) {
    app.add_option(flag, target, help)->check(isNameIn(table))->type_name(alternativesOf(table));
}

// A flag with a value of a table; `target` becomes the row's value.
template <class E, std::size_t N>
void addChoice(CLI::App& app, const std::string& flag, E& target, const app::Named<E> (&table)[N],
               const std::string& help) {
    const auto set = [&table, &target](const std::string& name) {
        for (const auto& row : table)
            if (row.name == name) target = row.value;
    };
    app.add_option_function<std::string>(flag, set, help)->check(isNameIn(table))->type_name(alternativesOf(table));
}

void addFile(CLI::App& app, const std::string& name, std::string& target, const char* type, const std::string& help,
             bool required) {
    app.add_option(name, target, help)->type_name(type)->required(required);
}

void addDiff(CLI::App& app, ImageArguments& arguments) {
    CLI::App& diff = *app.add_subcommand("diff", "Print how far image A is from B, both in linear radiance");
    addFile(diff, "A", arguments.a, kReadable, "the image", true);
    addFile(diff, "B", arguments.b, kReadable, "the reference", true);
    addName(diff, "--metric", arguments.metric, kMetrics, "print this one only");
    diff.add_option("--max", arguments.max, "exit with 5 when the metric (mse without --metric) is worse than this")
        ->type_name("E");
    addFile(diff, "--output", arguments.output, kWritable, "write a heat map of the differences", false);
}

void addInfo(CLI::App& app, ImageArguments& arguments) {
    CLI::App& info = *app.add_subcommand(
        "info", "Print size, channels, range and mean of an image, and how it was rendered where the file tells");
    addFile(info, "F", arguments.a, kReadable, "the image", true);
    info.add_option("--layer", arguments.layer, "of an .exr: this layer, part or channel")->type_name("L");
}

void addConvert(CLI::App& app, ImageArguments& arguments) {
    CLI::App& convert = *app.add_subcommand("convert", "Write image A in the format of B's extension");
    addFile(convert, "A", arguments.a, kReadable, "the image", true);
    addFile(convert, "B", arguments.b, kWritable, "the file to write", true);
    convert.add_option("--layer", arguments.layer, "of an .exr: this layer, part or channel, as info lists them")
        ->type_name("L");
    convert.add_option("--exposure", arguments.exposure, "stops, for PNG")->type_name("E");
    addName(convert, "--tonemap", arguments.tonemap, app::kTonemaps, "tone curve, for PNG");
}

void addMerge(CLI::App& app, ImageArguments& arguments) {
    CLI::App& merge = *app.add_subcommand("merge", "Join the checkpoints of --tiles or --region to one image");
    merge.add_option("PARTS", arguments.parts, "checkpoints of all parts, in any order")
        ->type_name("F.rtc")
        ->required();
    addFile(merge, "--output,-o", arguments.output, "F.png|.exr|.hdr|.pfm|.rtc", "image, or checkpoint", true);
}

void addDenoise(CLI::App& app, ImageArguments& arguments) {
    CLI::App& denoise = *app.add_subcommand(
        "denoise", "Filter the film of a checkpoint with two replicates or more, and print the relMSE estimated");
    addFile(denoise, "FILM", arguments.a, "F.rtc", "the checkpoint", true);
    addFile(denoise, "--output,-o", arguments.output, kWritable, "the image to write", true);
}

// A whole number in a range.
CLI::Option& addWhole(CLI::App& app, const std::string& flag, std::uint32_t& target, std::uint32_t least,
                      std::uint32_t most, const std::string& help) {
    const auto check = [least, most](const std::string& text) {
        std::uint32_t value = 0;
        const char* const end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data(), end, value);
        const bool isInRange = error == std::errc() && rest == end && value >= least && value <= most;
        return isInRange
                   ? std::string()
                   : text + ": must be a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    };
    return *app.add_option(flag, target, help)->check(CLI::Validator(check, ""))->type_name("N");
}

// How the scene is seen: as the flags of the programs.
void addView(CLI::App& app, PixelArguments& arguments) {
    app.add_option("--camera", arguments.camera, "pose as JSON, or the name of one of the scene's cameras")
        ->type_name("POSE");
    addWhole(app, "--width", arguments.width, 1, image::kMaxImageSide, "of the image that the pixel is of")
        .default_str("600");
    addWhole(app, "--height", arguments.height, 1, image::kMaxImageSide, "likewise; by the scene's aspect");
}

void addPixel(CLI::App& app, PixelArguments& arguments) {
    addFile(app, "SCENE", arguments.scene, "SCENE", "the scene, as --scene of the programs takes it", true);
    addFile(app, "PIXEL", arguments.pixel, "X,Y", "from the image's upper left, 0,0", true);
}

// And how its lights are sampled.
void addProbeSettings(CLI::App& probe, ProbeArguments& arguments) {
    addView(probe, arguments);
    addName(probe, "--light-selection", arguments.lightSelection, app::kLightSelections, "how a light is chosen");
    addName(probe, "--sphere-light", arguments.sphereLight, app::kSphereLights, "where a sphere is sampled");
    addName(probe, "--quad-light", arguments.quadLight, app::kFlatLights, "where a quad, disk or cylinder is");
    addName(probe, "--triangle-light", arguments.triangleLight, app::kFlatLights, "where a triangle is");
}

void addProbe(CLI::App& app, ImageArguments& arguments) {
    constexpr std::uint32_t kMaxRows = 4096, kMaxSamples = 10000000, kMaxSeed = 0xffffffff;
    constexpr std::uint32_t kMaxPaths = 65536, kMaxStrata = 256;
    CLI::App& probe = *app.add_subcommand(
        "probe",
        "Show what light sampling does where a pixel looks: densities of directions, samples, a chi-square test, "
        "variances");
    ProbeArguments& values = arguments.probe;
    addPixel(probe, values);
    addFile(probe, "--strategy", values.strategy, "bsdf|lights|mixture|mis|N",
            "lights: one is chosen and its shape sampled; mixture: half of either; mis: one sample of each; or the "
            "index of a light, whose shape alone is sampled",
            false);
    addFile(probe, "--output,-o", arguments.output, kWritable,
            "the picture; as .exr, .hdr and .pfm the map alone, of the density per steradian", false);
    addName(probe, "--show", values.show, probe::kQuantities, "what the map is of");
    probe.add_flag("--json", values.json, "print the figures as JSON");
    addProbeSettings(probe, values);
    addWhole(probe, "--rows", values.rows, 8, kMaxRows, "of the map, which has twice as many columns")
        .capture_default_str();
    addWhole(probe, "--paths", values.paths, 1, kMaxPaths, "of a cell, where radiance is traced").capture_default_str();
    addWhole(probe, "--samples", values.samples, 2, kMaxSamples, "to draw, and to estimate variances from")
        .capture_default_str();
    addName(probe, "--sampler", values.sampler, probe::kProbeSamplers, "where the samples' numbers come from");
    addWhole(probe, "--strata", values.strata, 1, kMaxStrata,
             "cells a side of the numbers' unit square, for stratified samples; the picture then shows their edges")
        .default_str("8");
    addWhole(probe, "--seed", values.seed, 0, kMaxSeed, "the same seed draws the same samples").capture_default_str();
}

void addPaths(CLI::App& app, ImageArguments& arguments) {
    constexpr std::uint32_t kMaxSamples = 1u << 20, kMaxListed = 4096, kMaxDepth = 4096, kMaxReplicates = 1024;
    constexpr std::uint32_t kMaxSeed = 0xffffffff;
    CLI::App& paths = *app.add_subcommand(
        "paths",
        "Tell why a pixel is noisy: its samples traced again, the shares of their variance, the brightest paths");
    PathsArguments& values = arguments.paths;
    app::RenderSettings& settings = values.settings;
    addPixel(paths, values);
    addFile(paths, "--output,-o", arguments.output, kWritable,
            "a strip with a bar for each sample, in order, in the colour of what brought most of it", false);
    paths.add_flag("--json", values.json, "print the figures as JSON, with the lines of paths");
    addView(paths, values);
    addWhole(paths, "--spp", settings.spp, 1, kMaxSamples, "samples per pixel of the render, all of which are traced")
        .capture_default_str();
    addWhole(paths, "--sample", values.sample, 0, kMaxSamples, "list all paths of this one");
    addWhole(paths, "--list", values.listed, 1, kMaxListed, "so many paths, the brightest ones").capture_default_str();
    addWhole(paths, "--max-depth", settings.maxDepth, 1, kMaxDepth, "path vertices after the camera")
        .capture_default_str();
    addWhole(paths, "--seed", settings.seed, 0, kMaxSeed, "as that of the render").capture_default_str();
    addWhole(paths, "--replicates", settings.replicates, 1, kMaxReplicates, "likewise").capture_default_str();
    app::forEachMethod([&paths](const char* key, const char*, const char* help, const auto& table,
                                auto& value) { addChoice(paths, app::flagOf(key), value, table, help); },
                       settings);
    addChoice(paths, "--russian-roulette", settings.russianRoulette, app::kOnOff, "end dim paths early");
}

void addCommands(CLI::App& app, ImageArguments& arguments) {
    app.set_help_flag("--help,-h", "print the flags and exit");
    addDiff(app, arguments);
    addInfo(app, arguments);
    addConvert(app, arguments);
    addMerge(app, arguments);
    addDenoise(app, arguments);
    addProbe(app, arguments);
    addPaths(app, arguments);
    app.set_help_all_flag("--help-all", "print every flag of every command and exit"); // which commands do not have
    app.set_version_flag("--version", versionText(kImageTool),
                         "print version, commit, features and compilers and exit");
    app.require_subcommand(0, 1); // an unknown one is named in its error, a missing one below
}

constexpr const char* kDescription =
    "Compares, describes and converts images: .png .exr .hdr .pfm, and to read .jpg .bmp .tga .tif .webp. Shows how "
    "lights are sampled at a point of a scene, and why a pixel is noisy.";

manual::Page pageOfCommands(const CLI::App& app) {
    manual::Page page = manual::pageOf(app);
    page.examples = {
        {"ray-tracing-image info spheres.png", "Tell how a picture was rendered."},
        {"ray-tracing-image diff a.exr b.exr --metric relmse --max 0.01",
         "Exit with 5 where a.exr is further from b.exr than that."},
        {"ray-tracing-image probe veach-mis 300,400 --strategy mis -o probe.png",
         "Show which directions MIS samples at a pixel's surface."},
        {"ray-tracing-image paths cornell-box-lights 300,420 --spp 256", "Tell what makes the noise of a pixel."}};
    return page;
}

} // namespace

manual::Page imagePage() {
    CLI::App app{kDescription, kImageTool};
    ImageArguments arguments;
    addCommands(app, arguments);
    return pageOfCommands(app);
}

std::optional<ImageArguments> parseImageArguments(const std::vector<std::string>& arguments, std::ostream& out) {
    CLI::App app{kDescription, kImageTool};
    ImageArguments parsed;
    addCommands(app, parsed);
    if (!manual::parse(app, arguments, out, [&] { return pageOfCommands(app); })) return std::nullopt;
    if (app.get_subcommands().empty())
        throw UsageError("a subcommand is required: diff, info, convert, denoise, merge, probe or paths");
    parsed.command = app.get_subcommands().front()->get_name();
    return parsed;
}

} // namespace rt::tools
