// ray-tracing-bench: flags to a suite, a suite to results, and the engines that it drives.
#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "Common/App/Session/Interrupt.h"
#include "Common/Bench/BenchOptions.h"
#include "Common/Bench/Comparison.h"
#include "Common/Bench/Live.h"
#include "Common/Bench/Machine.h"
#include "Common/Bench/Parts.h"
#include "Common/Bench/Report.h"
#include "Common/Bench/Runner.h"
#include "Common/Bench/Stability.h"
#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/Paths.h"
#include "Common/Core/RunMain.h"
#include "Common/Render/Stopwatch.h"
#include "RayTracingCPU/CpuEngine.h"
#include "tests/bench/EmbreeCeiling.h"
#ifdef RT_HAS_GPU
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/GpuEngine.h"
#endif

namespace {

using namespace rt;

constexpr const char* kProgram = "ray-tracing-bench";

constexpr std::uint32_t kRanksOfThread = 2; // so many take turns on a processor: what is left of its speed then?

bench::EngineKind cpuKind(const char* name, cpu::Policy policy) {
    bench::EngineKind kind{name,
                           [policy](std::uint32_t threads) {
                               cpu::CpuEngineOptions options;
                               options.policy = policy;
                               options.threads = threads;
                               return cpu::makeCpuEngine(options);
                           },
                           ""};
    if (policy == cpu::Policy::Par) kind.maxRanks = kRanksOfThread * std::max(1u, std::thread::hardware_concurrency());
    return kind;
}

// The engines of this machine, and the device that some of them share.
class EngineList {
  public:
    const std::vector<bench::EngineKind>& kinds() const { return kinds_; }
    const std::vector<bench::Fact>& facts() const { return facts_; }

    explicit EngineList(const bench::BenchOptions& options) {
        kinds_.push_back(cpuKind("single", cpu::Policy::Seq));
        kinds_.push_back(cpuKind("multi", cpu::Policy::Par));
#ifdef RT_HAS_GPU
        addGpu(options);
#else
        (void)options;
#endif
    }

  private:
#ifdef RT_HAS_GPU
    void addGpu(const bench::BenchOptions& options) {
        try {
            context_.emplace(vulkan::ContextOptions{.device = options.device, .shaderFigures = options.parts});
        } catch (const Error& error) {
            if (!options.device.empty()) throw;
            for (const auto& [name, kind] : kGpuKinds) kinds_.push_back({name, {}, error.what()});
            return;
        }
        energy_.emplace(context_->limits().uuid);
        const std::vector<vulkan::DeviceInfo> devices = vulkan::findDevices(vulkan::Instance(false));
        facts_.push_back({"GPU", context_->info().name});
        facts_.push_back({"GPU driver", context_->info().driver});
        for (const auto& [name, kind] : kGpuKinds) {
            bench::EngineKind added{name, {}, "", [this] { return energy_->joules(); }};
            if (const vulkan::DeviceInfo& info = context_->info(); !info.serves(gpu::neededBy(kind))) {
                const bool isQuery = kind == app::GpuEngineKind::Query;
                added.missing = info.name + " lacks " + (isQuery ? info.missingForQuery : info.missingForPipeline);
            } else {
                added.make = [this, engine = kind](std::uint32_t) {
                    return gpu::makeGpuEngine(*context_, {.engine = engine, .passSeconds = gpu::kUnwatchedPassSeconds});
                };
                if (options.device.empty()) // ranks choose among all
                    added.maxRanks =
                        static_cast<std::uint32_t>(vulkan::devicesForRanks(devices, gpu::neededBy(kind)).size());
            }
            kinds_.push_back(std::move(added));
        }
    }

    static constexpr std::pair<const char*, app::GpuEngineKind> kGpuKinds[] = {
        {"pipeline", app::GpuEngineKind::Pipeline},
        {"compute", app::GpuEngineKind::Compute},
        {"query", app::GpuEngineKind::Query}};
    std::optional<vulkan::VulkanContext> context_;
    std::optional<bench::NvidiaEnergy> energy_; // of its device
#endif
    std::vector<bench::EngineKind> kinds_;
    std::vector<bench::Fact> facts_;
};

std::filesystem::path referenceFolder() {
    const std::filesystem::path cache = userCacheFolder();
    return cache.empty() ? cache : cache / "references";
}

std::string noLinks(std::size_t) {
    return {};
}

int compare(const bench::BenchOptions& options) {
    const bench::Results before = bench::loadResults(options.compare[0]),
                         after = bench::loadResults(options.compare[1]);
    const bench::Comparison comparison = bench::compareResults(before, after);
    if (comparison.changes.empty())
        throw InputError(options.compare[0] + " and " + options.compare[1] + ": no row of one is in the other");
    std::cout << toMarkdown(describe(comparison, before, after), noLinks);
    return static_cast<int>(comparison.regressions() > 0 ? ExitCode::Different : ExitCode::Done);
}

int measure(const bench::BenchOptions& options) {
    bench::Suite suite = bench::loadSuite(options.suite);
    if (!options.scenes.empty()) replaceScenes(suite, options.scenes);
    if (!options.engines.empty()) restrictEngines(suite, options.engines);
    if (suite.experiments.empty())
        throw UsageError("--engine: the suite " + options.suite + " has none of these engines");
    suite.imports = options.imports;
    if (!options.report.empty()) bench::checkReportFolder(options.report);

    app::Interrupt interrupt;
    const EngineList list(options);
    bench::Engines engines(list.kinds());
    bench::ReferenceStore references(referenceFolder(), options.freshReferences);
    bench::RunnerHooks hooks;
    hooks.say = [&](const std::string& text) {
        if (!options.quiet) std::cerr << text << std::endl;
    };
    hooks.rayCeiling = bench::embreeRaysPerSecond;
    hooks.launcher = bench::findRankLauncher();
    interrupt.defer(); // from here on there may be something to keep
    bench::Results results = runSuite(suite, engines, references, hooks, interrupt.requested());
    std::vector<bench::Fact> facts = bench::machineFacts();
    facts.insert(facts.end(), list.facts().begin(), list.facts().end());
    results.facts = std::move(facts);

    std::cout << toMarkdown(makeReport(results, suite), noLinks);
    if (!options.report.empty()) {
        writeReport(options.report, results, suite);
        hooks.say("written: " + (std::filesystem::path(options.report) / "report.html").string());
    }
    if (!results.complete) return static_cast<int>(ExitCode::Interrupted);
    if (results.failure) std::rethrow_exception(results.failure);
    if (results.rows.empty())
        throw RenderError("nothing was measured" + (results.notices.empty() ? "" : ": " + results.notices.front()));
    return static_cast<int>(ExitCode::Done);
}

int listSuites() {
    for (const bench::NamedSuite& suite : bench::namedSuites())
        std::cout << suite.name << ": " << bench::loadSuite(suite.name).title << "\n";
    std::cout << bench::kLiveSuite << ": A camera that moves: error and time of each frame, raw and live\n";
    return static_cast<int>(ExitCode::Done);
}

// Every engine of this machine under every stress.
int measureStability(const bench::BenchOptions& options) {
    const EngineList list(options);
    std::vector<bench::StabilityRow> rows;
    const app::Stopwatch watch;
    const auto report = [&](const bench::StabilityRow& row) {
        if (options.quiet) return;
        std::cerr << std::lround(watch.seconds()) << " s  " << row.engine << ": " << row.name
                  << (row.pass ? " passes" : " FAILS") << std::endl;
    };
    for (const bench::EngineKind& kind : list.kinds()) {
        const auto& asked = options.engines;
        const bool wanted = asked.empty() ? kind.name != "single" // its kernels are those of multi
                                          : std::find(asked.begin(), asked.end(), kind.name) != asked.end();
        if (!wanted || !kind.make) continue;
        const auto found = bench::measureStability(*kind.make(0), {true, report});
        rows.insert(rows.end(), found.begin(), found.end());
    }
    std::cout << toMarkdown(bench::describeStability(rows), noLinks);
    const bool pass = std::all_of(rows.begin(), rows.end(), [](const bench::StabilityRow& row) { return row.pass; });
    return static_cast<int>(pass ? ExitCode::Done : ExitCode::Different);
}

// Of every scene that is asked for on every engine that is, or on all GPU engines that there are.
int measureParts(const bench::BenchOptions& options) {
    app::Interrupt interrupt;
    const EngineList list(options);
    bench::Engines engines(list.kinds());
    std::vector<std::string> names = options.engines;
    for (const bench::EngineKind& kind : list.kinds())
        if (options.engines.empty() && bench::isGpuEngine(kind.name) && kind.make) names.push_back(kind.name);
    if (names.empty()) throw RenderError("there is no GPU engine here; --engine multi measures that of the processor");
    interrupt.defer();
    for (const std::string& scene : options.scenes.empty() ? std::vector<std::string>{""} : options.scenes)
        for (const std::string& engine : names) {
            bench::PartsRequest request;
            if (!scene.empty()) request.scene = scene;
            request.engine = engine;
            const auto rows =
                bench::measureParts(engines, request, interrupt.requested(), [&](const bench::PartRow& row) {
                    if (!options.quiet) std::cerr << request.scene << ", " << engine << ": " << row.part << std::endl;
                });
            std::cout << toMarkdown(bench::describeParts(request, rows), noLinks) << std::flush;
            if (interrupt.requested()) return static_cast<int>(ExitCode::Interrupted);
        }
    return static_cast<int>(ExitCode::Done);
}

// Of every scene that is asked for on every engine that is.
int measureLive(const bench::BenchOptions& options) {
    app::Interrupt interrupt;
    const EngineList list(options);
    bench::Engines engines(list.kinds());
    bench::ReferenceStore references(referenceFolder(), options.freshReferences);
    bench::LiveRequest request;
    interrupt.defer();
    const auto say = [&](const std::string& text) {
        if (!options.quiet) std::cerr << request.scene << ", " << request.engine << ": " << text << std::endl;
    };
    for (const std::string& scene : options.scenes.empty() ? std::vector{request.scene} : options.scenes)
        for (const std::string& engine : options.engines.empty() ? std::vector{request.engine} : options.engines) {
            if (const std::string why = engines.missing(engine); !why.empty()) throw RenderError(engine + ": " + why);
            request.scene = scene;
            request.engine = engine;
            const auto frames = bench::measureLive(engines, references, request, interrupt.requested(), say);
            std::cout << toMarkdown(bench::describeLive(request, frames), noLinks) << std::flush;
            if (interrupt.requested()) return static_cast<int>(ExitCode::Interrupted);
        }
    return static_cast<int>(ExitCode::Done);
}

int runBench(const std::vector<std::string>& arguments) {
    const auto options = bench::parseBenchOptions(arguments, std::cout);
    if (!options) return 0; // --help, --version
    setUpLog({kProgram, options->quiet, false, ""});
    if (options->listSuites) return listSuites();
    if (!options->compare.empty()) return compare(*options);
    if (options->stability) return measureStability(*options);
    if (options->parts) return measureParts(*options);
    if (options->suite == bench::kLiveSuite) return measureLive(*options);
    return measure(*options);
}

} // namespace

int main(int argc, char** argv) {
    return rt::runMain(kProgram, [&] { return runBench({argv + std::min(argc, 1), argv + argc}); });
}
