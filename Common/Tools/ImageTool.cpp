// ray-tracing-image: compares, describes and converts image files, joins parts of an image, and shows how lights are
// sampled at a point.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

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
#include "Common/Tools/Image/ImageArguments.h"
#include "Common/Tools/Image/PathsCommand.h"
#include "Common/Tools/Image/ProbeCommand.h"

namespace {

using namespace rt;
using tools::kMetrics;
using tools::Metric;
using Arguments = tools::ImageArguments;

constexpr std::size_t kMaxDescription = 16384; // bytes of it that are printed

// The table's row of that name, of which there is one.
template <class Row, std::size_t N>
const Row& rowOf(const Row (&table)[N], const std::string& name) {
    return *std::find_if(std::begin(table), std::end(table), [&](const Row& row) { return row.name == name; });
}

// Prints the metric asked for, or all of them; with --max the exit code tells whether it (mse by default) is exceeded.
int diff(const Arguments& arguments) {
    if (!arguments.output.empty()) image::checkWritable(arguments.output);
    if (arguments.max && !std::isfinite(*arguments.max)) throw UsageError("--max: allowed are finite numbers");
    const image::Image a = image::readImage(arguments.a), b = image::readImage(arguments.b);
    image::checkFinite(a, arguments.a);
    image::checkFinite(b, arguments.b);
    const tools::Difference difference{a, b, image::compare(a, b)};
    for (const Metric& metric : kMetrics)
        if (arguments.metric.empty() || arguments.metric == metric.name)
            std::cout << metric.name << ' ' << metric.of(difference) << '\n';
    if (arguments.metric.empty()) std::cout << "max " << difference.figures.maxAbs << '\n';
    if (!arguments.output.empty()) image::writeImage(arguments.output, image::heatMap(a, b));

    if (!arguments.max) return static_cast<int>(ExitCode::Done);
    const Metric& metric = arguments.metric.empty() ? kMetrics[0] : rowOf(kMetrics, arguments.metric);
    const double value = metric.of(difference);
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
    const image::Denoised result = image::denoise(image::filmHalves(kept.film), 2, 0, false);
    image::writeImage(arguments.output, result.picture);
    std::cout << "estimated_relmse " << result.relmse.value << '\n';
    return static_cast<int>(ExitCode::Done);
}

int runCommand(const std::vector<std::string>& line) {
    const std::optional<Arguments> arguments = tools::parseImageArguments(line, std::cout);
    if (!arguments) return static_cast<int>(ExitCode::Done); // --help, --version
    setUpLog({tools::kImageTool, false, false, ""});         // of what is left out of images
    if (arguments->command == "diff") return diff(*arguments);
    if (arguments->command == "denoise") return denoise(*arguments);
    if (arguments->command == "merge") return merge(*arguments);
    if (arguments->command == "probe") {
        tools::runProbe(*arguments, std::cout);
        return static_cast<int>(ExitCode::Done);
    }
    if (arguments->command == "paths") {
        tools::runPaths(*arguments, std::cout);
        return static_cast<int>(ExitCode::Done);
    }
    return arguments->command == "info" ? info(*arguments) : convert(*arguments);
}

} // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> line(argv + std::min(argc, 1), argv + argc);
    return rt::runMain(rt::tools::kImageTool, [&] { return runCommand(line); });
}
