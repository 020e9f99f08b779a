#include "Common/Bench/BenchOptions.h"

#include <algorithm>
#include <iterator>
#include <sstream>

#include <CLI/CLI.hpp>

#include "Common/App/Options/OptionValues.h"
#include "Common/Bench/Config.h"
#include "Common/Core/Error.h"

namespace rt::bench {
namespace {

std::string oneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

void checkEngines(const std::vector<std::string>& engines) {
    for (const std::string& engine : engines)
        if (std::find(std::begin(kEngines), std::end(kEngines), engine) == std::end(kEngines))
            app::refuseValue("--engine", engine, app::alternatives({std::begin(kEngines), std::end(kEngines)}));
}

} // namespace

std::optional<BenchOptions> parseBenchOptions(const std::vector<std::string>& arguments, std::ostream& out) {
    constexpr const char* kName = "ray-tracing-bench";
    CLI::App app{
        "Measures run time against error: engines, estimators, samplers. Exit code 5: --compare found a regression.",
        kName};
    app.set_version_flag("--version", std::string(kName) + " " RT_VERSION);
    BenchOptions options;
    bool quick = false;
    auto* const suite = app.add_option(
        "SUITE", options.suite,
        "quick (the default), predecessor, defaults, lights, samplers, scaling, peers, full, or a .json file");
    auto* const quickFlag = app.add_flag("--quick", quick, "the suite quick");
    app.add_flag("--list-suites", options.listSuites, "names and titles of the suites that come with the program");
    app.add_option("--scene", options.scenes, "render these scenes instead of the suite's")
        ->type_name("S")
        ->allow_extra_args(false);
    app.add_option("--engine", options.engines,
                   "of the suite's engines only these: single, multi, pipeline, compute, query")
        ->type_name("E")
        ->allow_extra_args(false);
    auto* const report = app.add_option("--report", options.report,
                                        "folder for report.html, report.md, results.json, results.csv and plots")
                             ->type_name("DIR");
    app.add_option("--device", options.device, "Vulkan device by index or part of its name")->type_name("N|TEXT");
    app.add_flag("--fresh-references", options.freshReferences, "do not read references from the cache");
    app.add_flag("-q,--quiet", options.quiet, "no progress");
    auto* const compare =
        app.add_option("--compare", options.compare,
                       "compare two reports: folders or results.json; exits with 5 when B is worse than A beyond noise")
            ->type_name("A B")
            ->expected(2)
            ->excludes(suite, quickFlag, report);
    compare->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    auto* const stability =
        app.add_flag(
               "--stability", options.stability,
               "instead of a suite: scenes whose answer is known, pushed to the limits of single precision; exits with "
               "5 when an engine misses one")
            ->excludes(suite, quickFlag, report, compare);
    app.add_flag("--parts", options.parts,
                 "instead of a suite: what parts of the work cost, each left out in turn, and what the driver tells of "
                 "the shaders; of Cornell Box Lights on GPU engines unless --scene and --engine say otherwise")
        ->excludes(suite, quickFlag, report, compare, stability);
    try {
        std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
        app.parse(reversed);
    } catch (const CLI::Success& request) { // --help or --version
        std::ostringstream errors;
        app.exit(request, out, errors);
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        throw UsageError(oneLine(error.what()));
    }
    if (quick && suite->count() > 0 && options.suite != "quick")
        throw UsageError("--quick: " + options.suite + " is another suite");
    checkEngines(options.engines);
    return options;
}

} // namespace rt::bench
