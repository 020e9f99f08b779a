#include "Common/Bench/BenchOptions.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <CLI/CLI.hpp>

#include "Common/App/Options/OptionValues.h"
#include "Common/Bench/Config.h"
#include "Common/Bench/Import.h"
#include "Common/Core/BuildInfo.h"
#include "Common/Core/Error.h"
#include "Common/Manual/Parse.h"

namespace rt::bench {
namespace {

void checkEngines(const std::vector<std::string>& engines) {
    for (const std::string& engine : engines)
        if (std::find(std::begin(kEngines), std::end(kEngines), engine) == std::end(kEngines))
            app::refuseValue("--engine", engine, app::alternatives({std::begin(kEngines), std::end(kEngines)}));
}

constexpr const char* kBenchProgram = "ray-tracing-bench";
constexpr const char* kBenchDescription =
    "Measures run time against error: engines, estimators, samplers. Exit code 5: --compare found a regression.";

struct BenchFlags {
    BenchOptions options;
    std::vector<std::string> imports; // three words each
    bool quick = false;
};

void addSuiteFlags(CLI::App& app, BenchFlags& flags) {
    BenchOptions& options = flags.options;
    std::string suites;
    for (const NamedSuite& suite : namedSuites()) suites += std::string(suite.name) + "|";
    suites += std::string(kLiveSuite) + "|";
    app.add_option("SUITE", options.suite,
                   "quick (the default) or another that comes with the program, or a .json file")
        ->type_name(suites + "FILE");
    app.add_option("--suite", options.suite, "the same as SUITE")->type_name("SUITE")->excludes("SUITE");
    app.add_flag("--quick", flags.quick, "the suite quick");
    app.add_flag("--list-suites", options.listSuites, "names and titles of the suites that come with the program");
    app.add_option("--scene", options.scenes, "render these scenes instead of the suite's")
        ->type_name("SCENE")
        ->allow_extra_args(false);
    std::string engines;
    for (const std::string_view engine : kEngines) engines += (engines.empty() ? "" : "|") + std::string(engine);
    app.add_option("--engine", options.engines, "of the suite's engines only these")
        ->type_name(engines)
        ->allow_extra_args(false);
    app.add_option("--report", options.report, "folder for report.html, report.md, results.json, results.csv and plots")
        ->type_name("DIR");
    app.add_option("--device", options.device, "Vulkan device by index or part of its name")->type_name("N|TEXT");
    app.add_flag("--fresh-references", options.freshReferences, "do not read references from the cache");
    app.add_option("--import", flags.imports,
                   "set another program's picture, of linear radiance and rendered in so many seconds, beside the "
                   "suite's, which must render one scene in one size; of one name several are a curve")
        ->type_name("NAME IMAGE SECONDS")
        ->type_size(3)
        ->allow_extra_args(false);
    app.add_flag("-q,--quiet", options.quiet, "no progress");
}

// What is done instead of a suite.
void addOtherModes(CLI::App& app, BenchOptions& options) {
    std::vector<CLI::Option*> others = {app.get_option("SUITE"), app.get_option("--suite"), app.get_option("--quick"),
                                        app.get_option("--report"), app.get_option("--import")};
    const auto exclude = [&others](CLI::Option* option) {
        for (CLI::Option* other : others) option->excludes(other);
        others.push_back(option);
    };
    CLI::Option* const compare =
        app.add_option("--compare", options.compare,
                       "compare two reports: folders or results.json; exits with 5 when B is worse than A beyond noise")
            ->type_name("A B")
            ->expected(2);
    compare->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    exclude(compare);
    exclude(app.add_flag(
        "--stability", options.stability,
        "instead of a suite: scenes whose answer is known, pushed to the limits of single precision; exits with "
        "5 when an engine misses one"));
    exclude(app.add_flag(
        "--parts", options.parts,
        "instead of a suite: what parts of the work cost, each left out in turn, and what the driver tells of "
        "the shaders; of Cornell Box Lights on GPU engines unless --scene and --engine say otherwise"));
}

void addBenchFlags(CLI::App& app, BenchFlags& flags) {
    app.set_help_flag("--help,-h", "print the flags that matter most and exit");
    app.set_help_all_flag("--help-all", "print every flag and exit");
    app.set_version_flag("--version", versionText(kBenchProgram),
                         "print version, commit, features and compilers and exit");
    addSuiteFlags(app, flags);
    addOtherModes(app, flags.options);
}

manual::Page benchPageOf(const CLI::App& app) {
    manual::Page page = manual::pageOf(app);
    page.essentials = {"--list-suites", "--scene", "--engine", "--report", "--device", "--compare"};
    page.environment = {{"XDG_CACHE_HOME", "ray-tracing/references in it holds references that were rendered"}};
    page.examples = {{"ray-tracing-bench --report report", "Measure the suite quick and write a report of it."},
                     {"ray-tracing-bench --scene veach-mis --import Another theirs.exr 12.5 --report report",
                      "Set another renderer's picture beside our own."},
                     {"ray-tracing-bench --compare before after", "Tell whether the second report is worse."}};
    return page;
}

} // namespace

manual::Page benchPage() {
    CLI::App app{kBenchDescription, kBenchProgram};
    BenchFlags flags;
    addBenchFlags(app, flags);
    return benchPageOf(app);
}

std::optional<BenchOptions> parseBenchOptions(const std::vector<std::string>& arguments, std::ostream& out) {
    CLI::App app{kBenchDescription, kBenchProgram};
    BenchFlags flags;
    addBenchFlags(app, flags);
    if (!manual::parse(app, arguments, out, [&] { return benchPageOf(app); })) return std::nullopt;
    BenchOptions& options = flags.options;
    if (flags.quick && app.count("SUITE") + app.count("--suite") > 0 && options.suite != "quick")
        throw UsageError("--quick: " + options.suite + " is another suite");
    checkEngines(options.engines);
    options.imports = parseImports(flags.imports);
    if (options.suite == kLiveSuite && !options.report.empty())
        throw UsageError("--report: not with the suite live, whose tables go to standard output");
    return options;
}

} // namespace rt::bench
