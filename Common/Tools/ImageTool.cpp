// ray-tracing-image: compares, describes and converts image files, and joins parts of an image.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/Printable.h"
#include "Common/Core/RunMain.h"
#include "Common/Image/Denoise/FilmHalves.h"
#include "Common/Image/Display.h"
#include "Common/Image/FilmRows.h"
#include "Common/Image/ImageIo.h"
#include "Common/Image/MergeCheckpoints.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/Names.h"

namespace {

using namespace rt;

constexpr const char* kProgram = "ray-tracing-image";
constexpr std::size_t kMaxDescription = 16384; // bytes of it that are printed

struct Metric {
    const char* name;
    double image::ErrorFigures::*value;
    bool moreIsBetter;
};

constexpr Metric kMetrics[] = {{"mse", &image::ErrorFigures::mse, false},
                               {"rmse", &image::ErrorFigures::rmse, false},
                               {"relmse", &image::ErrorFigures::relmse, false},
                               {"mae", &image::ErrorFigures::mae, false},
                               {"psnr", &image::ErrorFigures::psnr, true}};

struct Arguments {
    std::string a, b;
    std::string metric;
    std::optional<double> max;
    std::string output;
    std::string layer;
    std::vector<std::string> parts;
    float exposure = 0;
    std::string tonemap = "none";
};

// The table's row of that name; CLI11 has checked that there is one.
template <class Row, std::size_t N>
const Row& rowOf(const Row (&table)[N], const std::string& name) {
    return *std::find_if(std::begin(table), std::end(table), [&](const Row& row) { return row.name == name; });
}

template <class Row, std::size_t N>
std::vector<std::string> namesOf(const Row (&table)[N]) {
    std::vector<std::string> names;
    for (const Row& row : table) names.emplace_back(row.name);
    return names;
}

// Prints the metric asked for, or all of them; with --max the exit code tells whether it (mse by default) is exceeded.
int diff(const Arguments& arguments) {
    if (!arguments.output.empty()) image::checkWritable(arguments.output);
    if (arguments.max && !std::isfinite(*arguments.max)) throw UsageError("--max: allowed are finite numbers");
    const image::Image a = image::readImage(arguments.a), b = image::readImage(arguments.b);
    image::checkFinite(a, arguments.a);
    image::checkFinite(b, arguments.b);
    const image::ErrorFigures figures = image::compare(a, b);
    for (const Metric& metric : kMetrics)
        if (arguments.metric.empty() || arguments.metric == metric.name)
            std::cout << metric.name << ' ' << figures.*metric.value << '\n';
    if (arguments.metric.empty()) std::cout << "max " << figures.maxAbs << '\n';
    if (!arguments.output.empty()) image::writeImage(arguments.output, image::heatMap(a, b));

    if (!arguments.max) return static_cast<int>(ExitCode::Done);
    const Metric& metric = arguments.metric.empty() ? kMetrics[0] : rowOf(kMetrics, arguments.metric);
    const double value = figures.*metric.value;
    const bool within = metric.moreIsBetter ? value >= *arguments.max : value <= *arguments.max;
    return static_cast<int>(within ? ExitCode::Done : ExitCode::Different);
}

int info(const Arguments& arguments) {
    const image::Image image = image::readImage(arguments.a, arguments.layer);
    const auto [minimum, maximum] = std::minmax_element(image.data.begin(), image.data.end());
    const auto bad = std::count_if(image.data.begin(), image.data.end(), [](float v) { return !std::isfinite(v); });
    const auto mean = image::channelMeans(image);
    std::cout << "size " << image.width << ' ' << image.height << "\nchannels " << image.channels << "\nmin "
              << *minimum << "\nmax " << *maximum << "\nmean";
    for (std::uint32_t c = 0; c < image.channels; ++c) std::cout << ' ' << mean[c];
    std::cout << "\nnonfinite " << bad << '\n';
    std::string layers;
    for (const std::string& layer : image::readLayers(arguments.a)) layers += (layers.empty() ? "" : ", ") + layer;
    if (!layers.empty()) std::cout << "layers " << printable(layers, kMaxDescription) << '\n';
    if (const auto description = image::readDescription(arguments.a)) // by whomever: it must not look like other lines
        std::cout << "render " << printable(*description, kMaxDescription) << '\n';
    return static_cast<int>(ExitCode::Done);
}

int convert(const Arguments& arguments) {
    image::checkWritable(arguments.b);
    const image::Image image = image::readImage(arguments.a, arguments.layer);
    image::ImageRows rows = image;
    if (arguments.exposure != 0 || arguments.tonemap != "none") {
        if (!image::isDisplayReferred(arguments.b))
            throw UsageError(arguments.b + ": --exposure and --tonemap are for .png only");
        rows = image::toDisplay(image, arguments.exposure,
                                static_cast<std::uint32_t>(rowOf(app::kTonemaps, arguments.tonemap).value));
    }
    image::writeImage(arguments.b, rows);
    return static_cast<int>(ExitCode::Done);
}

int merge(const Arguments& arguments) {
    const std::filesystem::path output = arguments.output;
    const bool isCheckpoint = output.extension() == ".rtc";
    if (!isCheckpoint) image::checkWritable(output);
    for (const std::string& part : arguments.parts) {
        std::error_code ignored; // of files that are not there, which reading them tells
        if (std::filesystem::equivalent(part, output, ignored))
            throw UsageError("--output " + output.string() + ": would overwrite one of the parts");
    }
    const image::Checkpoint whole = image::mergeCheckpoints({arguments.parts.begin(), arguments.parts.end()});
    if (isCheckpoint)
        image::writeCheckpoint(output, whole.render, whole.film);
    else
        image::writeImage(output, image::meanRows(whole.film));
    return static_cast<int>(ExitCode::Done);
}

// Of a film that was kept; it has no features of surfaces, so that edges are known by the samples alone.
int denoise(const Arguments& arguments) {
    image::checkWritable(arguments.output);
    const image::Checkpoint kept = image::readCheckpoint(arguments.a);
    if (const std::string why = image::whyNoHalves(kept.film); !why.empty()) throw InputError(arguments.a + ": " + why);
    // Whether pixels share paths is not kept; that they might costs the estimate little.
    const image::Denoised result = image::denoise(image::filmHalves(kept.film), 2);
    image::writeImage(arguments.output, result.picture);
    std::cout << "estimated_relmse " << result.relmse.value << '\n';
    return static_cast<int>(ExitCode::Done);
}

// Runs the command that the command line asks for.
int run(int argc, char** argv) {
    CLI::App app{"Compares, describes and converts images: .png .exr .hdr .pfm, and to read .jpg .bmp .tga .tif .webp.",
                 kProgram};
    app.set_version_flag("--version", std::string(kProgram) + " " RT_VERSION);
    app.require_subcommand(0, 1); // an unknown one is named in its error, a missing one below
    Arguments arguments;

    CLI::App* const diffs = app.add_subcommand("diff", "Print how far image A is from B; both in linear radiance");
    diffs->add_option("A", arguments.a)->required();
    diffs->add_option("B", arguments.b, "Reference")->required();
    diffs->add_option("--metric", arguments.metric, "Print this one only")->check(CLI::IsMember(namesOf(kMetrics)));
    diffs->add_option("--max", arguments.max, "Exit with 5 when the metric (default mse) is worse than this");
    diffs->add_option("--output", arguments.output, "Write a heat map of the differences");

    CLI::App* const infos = app.add_subcommand(
        "info", "Print size, channels, range and mean of an image, and how it was rendered where the file tells");
    infos->add_option("F", arguments.a)->required();
    infos->add_option("--layer", arguments.layer, "Of an .exr: this layer, part or channel");

    CLI::App* const converts = app.add_subcommand("convert", "Write image A in the format of B's extension");
    converts->add_option("A", arguments.a)->required();
    converts->add_option("B", arguments.b)->required();
    converts->add_option("--layer", arguments.layer, "Of an .exr: this layer, part or channel, as info lists them");
    converts->add_option("--exposure", arguments.exposure, "Stops");
    converts->add_option("--tonemap", arguments.tonemap, "Tone curve")->check(CLI::IsMember(namesOf(app::kTonemaps)));

    CLI::App* const merges = app.add_subcommand("merge", "Join the checkpoints of --tiles or --region to one image");
    merges->add_option("PARTS", arguments.parts, "Checkpoints of all parts, in any order")->required();
    merges->add_option("--output,-o", arguments.output, "Image, or checkpoint .rtc")->required();

    CLI::App* const denoises = app.add_subcommand(
        "denoise", "Filter the film of a checkpoint with two replicates or more, and print the relMSE estimated");
    denoises->add_option("FILM", arguments.a, "Checkpoint .rtc")->required();
    denoises->add_option("--output,-o", arguments.output, "Image")->required();

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& request) { // --help or --version
        return app.exit(request);
    } catch (const CLI::ParseError& error) {
        throw UsageError(error.what());
    }
    setUpLog({kProgram, false, false, ""}); // of what is left out of images
    if (app.get_subcommands().empty())
        throw UsageError("a subcommand is required: diff, info, convert, denoise or merge");
    if (diffs->parsed()) return diff(arguments);
    if (denoises->parsed()) return denoise(arguments);
    if (merges->parsed()) return merge(arguments);
    return infos->parsed() ? info(arguments) : convert(arguments);
}

} // namespace

int main(int argc, char** argv) {
    return rt::runMain(kProgram, [&] { return run(argc, argv); });
}
