#include "Common/Bench/Runner.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <set>
#include <thread>
#include <tuple>

#include "Common/App/Session/OpenImageDenoise.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Bench/Analysis.h"
#include "Common/Bench/Import.h"
#include "Common/Bench/Pictures.h"
#include "Common/Bench/ReferenceRows.h"
#include "Common/Core/Error.h"
#include "Common/Core/Format.h"
#include "Common/Core/Interruption.h"
#include "Common/Render/Stopwatch.h"

namespace rt::bench {
namespace {

using image::Image;

constexpr double kRateSeconds = 0.3; // of sampling
constexpr double kMinFall = -0.5;    // slope of mse over samples that is still one
constexpr double kLargestZ = 4;

std::string describe(const Experiment& experiment, const Config& config) {
    if (config.imported) return config.scene + ", " + config.engine;
    std::string text;
    for (const Axis& axis : axes()) {
        const bool always = axis.name == "scene" || axis.name == "engine";
        if (always || varies(experiment, axis)) text += (text.empty() ? "" : ", ") + axis.get(config);
    }
    return text;
}

class SuiteRunner {
  public:
    SuiteRunner(const Suite& suite, Engines& engines, ReferenceStore& references, const RunnerHooks& hooks,
                const std::atomic<bool>& stop)
        : suite_(suite), engines_(engines), references_(references), hooks_(hooks), stop_(stop) {
        results_.suite = suite.name;
        results_.title = suite.title;
    }

    Results run() {
        const Interruptible interruptible(stop_); // reading a large scene
        checkOnePicture(suite_);
        readScenes();
        for (const Experiment& experiment : suite_.experiments) {
            if (stop_) break;
            runExperiment(experiment);
        }
        engines_.clear();
        results_.complete = !stop_;
        return std::move(results_);
    }

  private:
    // Configurations that render one image, but for their errors.
    struct Group {
        std::string scene;
        std::vector<Measured> measured;
    };

    void notice(const std::string& text) {
        if (std::find(results_.notices.begin(), results_.notices.end(), text) != results_.notices.end()) return;
        results_.notices.push_back(text);
        hooks_.say(text);
    }

    // What fails is told and left out, so that what else is measured is not lost.
    template <class Function>
    bool attempt(const std::string& what, Function work) {
        try {
            work();
            return true;
        } catch (const Interrupted&) {
            return false;
        } catch (const std::exception& error) {
            notice(what + ": " + messageOf(error));
            if (!results_.failure) results_.failure = std::current_exception();
            engines_.clear();
            return false;
        }
    }

    void readScenes();
    void runExperiment(const Experiment& experiment);
    bool hasLibrary();
    std::vector<Group> groupsOf(const Experiment& experiment);
    void runGroup(const Experiment& experiment, Group& group);
    void measureDeviceRate(Config config);
    void measureOnce(const Experiment& experiment, Measured& measured, std::uint32_t repeat);
    Ladder ladderFor(const Experiment& experiment, const Config& config);
    void loadScene(const std::string& source, const std::string& camera);
    const image::Reference* provideReference(const Group& group, std::vector<std::vector<Row>>& rows);

    const Suite& suite_;
    Engines& engines_;
    ReferenceStore& references_;
    const RunnerHooks& hooks_;
    const std::atomic<bool>& stop_;
    Results results_;

    std::vector<Measured> imported_;        // of the suite's one picture
    std::string sceneSource_, sceneCamera_; // of scene_
    std::shared_ptr<const scene::CompiledScene> scene_;
    double secondsLoad_ = 0;
    std::map<std::pair<std::string, std::string>, Figure> ceilings_; // rays/s by scene and kind of engine
    image::Reference reference_;
    bool referenceSuffices_ = false;
};

std::uint32_t heightOf(const app::RenderSettings& settings, double aspect) {
    return settings.height != 0 ? settings.height
                                : std::max(1u, static_cast<std::uint32_t>(std::lround(settings.width / aspect)));
}

// All of them, and imported pictures, before hours pass until the last turns out not to exist.
void SuiteRunner::readScenes() {
    std::set<std::string> read;
    for (const Experiment& experiment : suite_.experiments)
        for (const Config& config : combinations(experiment, std::numeric_limits<std::uint32_t>::max())) {
            const bool isNew = read.insert(config.scene).second;
            const bool isPicture = experiment.error && imported_.empty() && !suite_.imports.empty();
            if (stop_ || (!isNew && !isPicture)) continue;
            try {
                const double aspect = app::loadScene(config.scene).render.aspect;
                if (!isPicture) continue;
                Config picture = config;
                picture.settings.height = heightOf(config.settings, aspect);
                imported_ = readImports(suite_.imports, picture);
            } catch (const Interrupted&) {
                return;
            } catch (const InputError& error) {
                throw InputError("experiment " + experiment.name + ": " + error.what());
            }
        }
}

// Tests and benchmarks use the generated assets even where the user has others, so that figures compare across
// machines.
void SuiteRunner::loadScene(const std::string& source, const std::string& camera) {
    if (source == sceneSource_ && camera == sceneCamera_) return;
    engines_.clear();
    sceneSource_.clear();
    const app::Stopwatch watch;
    scene_ = app::compile(app::loadScene(source), true, true, camera);
    secondsLoad_ = watch.seconds();
    sceneSource_ = source;
    sceneCamera_ = camera;
    const std::pair key(source, std::string("multi"));
    if (hooks_.rayCeiling && !stop_ && !ceilings_.count(key)) ceilings_[key] = hooks_.rayCeiling(*scene_);
}

// Says which one, or why there is none.
bool SuiteRunner::hasLibrary() {
    try {
        notice("Rows of oidn are filtered by " + app::OpenImageDenoise().name() + ".");
        return true;
    } catch (const RenderError& error) {
        notice("Rows of oidn are left out: " + std::string(error.what()) + ".");
        return false;
    }
}

std::vector<SuiteRunner::Group> SuiteRunner::groupsOf(const Experiment& experiment) {
    std::vector<Group> groups;
    const auto imageOf = [](const Config& c) {
        return std::tuple(c.scene, c.camera, c.settings.width, c.settings.height, c.settings.maxDepth);
    };
    const std::uint32_t threads = std::max(1u, std::thread::hardware_concurrency());
    for (const Config& config : combinations(experiment, threads)) {
        if (const std::string why = engines_.missing(config.engine); !why.empty()) {
            notice("Engine " + config.engine + " is left out: " + why + ".");
            continue;
        }
        if (config.denoise == Denoise::Oidn && !hasLibrary()) continue;
        if (config.ranks > 1 && hooks_.launcher.mpirun.empty()) {
            notice("Rows of several ranks are left out: " + hooks_.launcher.missing + ".");
            continue;
        }
        if (const std::uint32_t maximum = engines_.maxRanks(config.engine); config.ranks > std::max(1u, maximum)) {
            notice("Engine " + config.engine + ": more than " + std::to_string(maximum) +
                   (maximum == 1 ? " rank is" : " ranks are") +
                   " left out, which would have nothing of their own to render on.");
            continue;
        }
        const auto same = [&](const Group& group) { return imageOf(group.measured.front().config) == imageOf(config); };
        auto place = std::find_if(groups.begin(), groups.end(), same);
        if (place == groups.end()) place = groups.insert(groups.end(), Group{config.scene, {}});
        place->measured.push_back({config, 0, {}});
    }
    if (combinations(experiment, threads).empty())
        notice(experiment.name + ": needs more threads than the " + std::to_string(threads) + " of this processor.");
    return groups;
}

void SuiteRunner::runExperiment(const Experiment& experiment) {
    hooks_.say("# " + experiment.title);
    std::vector<Group> groups = groupsOf(experiment);
    const std::size_t firstRow = results_.rows.size();
    for (Group& group : groups) {
        if (stop_) break;
        attempt(group.scene, [&] { runGroup(experiment, group); });
        group.measured.clear(); // its images
    }
    std::vector<Row> rows(results_.rows.begin() + static_cast<std::ptrdiff_t>(firstRow), results_.rows.end());
    addBaselines(experiment, rows);
    if (!experiment.baseline.empty() && !rows.empty() && !stop_ &&
        std::none_of(rows.begin(), rows.end(), [](const Row& row) { return bool(row.speedup); }))
        notice(experiment.name + ": the baseline was not measured, so there is no speed-up and no gain.");
    std::copy(rows.begin(), rows.end(), results_.rows.begin() + static_cast<std::ptrdiff_t>(firstRow));
}

void SuiteRunner::runGroup(const Experiment& experiment, Group& group) {
    loadScene(group.scene, group.measured.front().config.camera);
    for (Measured& measured : group.measured) {
        measured.secondsLoad = secondsLoad_;
        measured.config.settings.height = heightOf(measured.config.settings, scene_->defaults.aspect);
    }
    // Turn by turn, so that a busy machine disturbs all alike.
    for (std::uint32_t repeat = 0; repeat < experiment.repeats; ++repeat)
        for (Measured& measured : group.measured)
            if (!stop_ && !measured.failed)
                measured.failed = !attempt(experiment.name + ": " + describe(experiment, measured.config),
                                           [&] { measureOnce(experiment, measured, repeat); });
    std::erase_if(group.measured, [](const Measured& m) {
        return std::all_of(m.runs.begin(), m.runs.end(), [](const Run& run) { return run.snapshots.empty(); });
    });
    if (experiment.error && !group.measured.empty()) // of which all are of the one picture
        group.measured.insert(group.measured.end(), imported_.begin(), imported_.end());

    std::vector<std::vector<Row>> rows;
    for (const Measured& measured : group.measured) rows.push_back(makeRows(experiment, measured));
    const image::Reference* reference = nullptr;
    if (experiment.error && !group.measured.empty())
        attempt("reference of " + group.scene, [&] { reference = provideReference(group, rows); });
    std::vector<Row> all;
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (Row& row : rows[i]) {
            const auto ceiling = ceilings_.find({group.scene, row.config.engine});
            if (ceiling != ceilings_.end() && ceiling->second && row.config.threads == 0 && row.config.ranks == 1)
                row.ceiling = row.raysPerSecond.value_or(0) / *ceiling->second;
            all.push_back(row);
        }
    for (const Series& series : makeSeries(experiment, all)) {
        results_.series.push_back(series);
        if (series.config.denoise == Denoise::Off && series.tailSlope.value_or(-1) > kMinFall && referenceSuffices_)
            notice(experiment.name + ": " + describe(experiment, series.config) +
                   ": the error hardly falls at the end, with slope " + formatted("%.2f", *series.tailSlope) + ".");
    }
    for (const Row& row : all)
        if (std::abs(row.biasZ.value_or(0)) > kLargestZ)
            notice(experiment.name + ": " + describe(experiment, row.config) + ": at " +
                   (row.spp ? formatted("%.0f spp", *row.spp) : formatted("%.3g s", *row.seconds)) +
                   " the mean is off by " + formatted("%.1f", *row.biasZ) +
                   " standard deviations: biased, or ruled by a few bright samples.");
    for (const SkipRow& skip : compareFeatures(experiment, group.measured)) results_.skips.push_back(skip);
    if (reference != nullptr && experiment.images)
        results_.grids.push_back(makeGrid(experiment, group.measured, *reference));
    results_.rows.insert(results_.rows.end(), all.begin(), all.end());
}

Ladder SuiteRunner::ladderFor(const Experiment& experiment, const Config& config) {
    Ladder ladder{experiment.spp, experiment.seconds, experiment.maxSeconds, config.denoise};
    const auto maximum = experiment.maxSpp.find(config.engine);
    if (maximum != experiment.maxSpp.end())
        std::erase_if(ladder.spp, [&](std::uint32_t spp) { return spp > maximum->second; });
    return ladder;
}

// What a device does with rays of the camera alone: coherent, hardly any shading.
void SuiteRunner::measureDeviceRate(Config config) {
    Figure& rate = ceilings_[{sceneSource_, config.engine}];
    if (rate) return;
    config.settings.maxDepth = 1;
    config.settings.lightSampling = app::LightSampling::Bsdf;
    config.settings.sampler = app::SamplerKind::Independent;
    config.settings.edgeRays = false;
    config.settings.pathReuse = app::PathReuse::Off;
    config.settings.features.reset();
    app::Engine* engine = engines_.prepare(config, scene_, stop_);
    if (engine == nullptr) return;
    const Run run = measure(*engine, *scene_, config.settings, {{}, {kRateSeconds}, 1e30}, 0, stop_);
    if (run.snapshots.empty()) return;
    const Snapshot& snapshot = run.snapshots.back();
    rate = static_cast<double>(snapshot.rays.all()) / snapshot.seconds;
}

void SuiteRunner::measureOnce(const Experiment& experiment, Measured& measured, std::uint32_t repeat) {
    const std::string what = experiment.name + ": " + describe(experiment, measured.config);
    const Ladder ladder = ladderFor(experiment, measured.config);
    if (measured.config.ranks > 1) {
        engines_.clear(); // its memory and threads are the ranks' now
        measured.runs.push_back(measureRanks(hooks_.launcher, measured.config, ladder, repeat, stop_));
    } else {
        app::Engine* engine = engines_.prepare(measured.config, scene_, stop_);
        if (engine == nullptr) return;
        if (isGpuEngine(measured.config.engine)) measureDeviceRate(measured.config);
        measured.runs.push_back(measure(*engine, *scene_, measured.config.settings, ladder, repeat, stop_,
                                        engines_.energy(measured.config.engine)));
    }
    const std::vector<Snapshot>& snapshots = measured.runs.back().snapshots;
    const std::size_t wanted = ladder.spp.size() + ladder.seconds.size();
    const double longest = ladder.seconds.empty() ? experiment.maxSeconds : ladder.seconds.back();
    if (snapshots.empty()) {
        if (!stop_)
            notice(what + ": nothing within " +
                   (wanted == 0 ? "its max_spp" : formatted("%g s", std::min(experiment.maxSeconds, longest))) + ".");
        return;
    }
    const Snapshot& last = snapshots.back();
    if (last.spp == 0)
        notice(what + ": no whole picture within " + formatted("%g s", last.timeBudget.value_or(last.seconds)) +
               ", so that its error is not known.");
    hooks_.say(what + ": " + std::to_string(last.spp) + " spp in " + formatted("%.3g s", last.seconds) + ", " +
               formatted("%.3g M samples/s", static_cast<double>(last.samples) / last.seconds * 1e-6));
    if (snapshots.size() < wanted && !stop_)
        notice(what + ": ends at " + std::to_string(last.spp) + " spp, as more would take above " +
               formatted("%g s", experiment.maxSeconds) + ".");
}

// By the engine that was fastest; null when stopped before there is one. Adds the errors to the rows.
const image::Reference* SuiteRunner::provideReference(const Group& group, std::vector<std::vector<Row>>& rows) {
    const Measured* fastest = nullptr;
    double rate = 0;
    ReferenceRequest request;
    std::vector<const Image*> images;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Measured& measured = group.measured[i];
        if (const double own = rows[i].back().samplesPerSecond.value_or(0); own >= rate && !measured.config.imported) {
            rate = own;
            fastest = &measured;
        }
        for (const Run& run : measured.runs)
            for (const Snapshot& snapshot : run.snapshots) {
                images.push_back(&snapshot.image);
                request.firstSpp = std::max(request.firstSpp, snapshot.spp);
            }
    }
    const app::RenderSettings& settings = fastest->config.settings;
    request.scene = scene_.get();
    request.width = settings.width;
    request.height = settings.height;
    request.maxDepth = settings.maxDepth;
    request.maxSeconds = suite_.referenceSeconds;
    Config config = fastest->config;
    config.ranks = 1;
    config.settings.features.reset();
    app::Engine* engine = engines_.prepare(config, scene_, stop_);
    if (engine == nullptr) return nullptr;
    auto made = references_.provide(request, images, *engine, stop_);
    if (!made) {
        if (!stop_)
            notice(group.scene + ": no reference within " + formatted("%g s", request.maxSeconds) +
                   "; errors are not known.");
        return nullptr;
    }
    reference_ = std::move(made->reference);
    referenceSuffices_ = made->sufficient;
    for (std::size_t i = 0; i < rows.size(); ++i) addErrors(rows[i], group.measured[i], reference_);

    ReferenceRow row = makeReferenceRow(group.scene, request, config.engine, *made, reference_);
    verifyReference(rows, row);
    hooks_.say("reference of " + group.scene + ": " + std::to_string(made->spp) + " spp, " +
               formatted("%.3g s", made->seconds) + (made->cached ? ", partly cached" : ""));
    if (!made->sufficient && !stop_)
        notice(group.scene +
               ": the reference's standard error is more than a third of the least error measured; its "
               "variance is subtracted, but intervals are wider.");
    keepReference(row, results_.references);
    return &reference_;
}

} // namespace

Results runSuite(const Suite& suite, Engines& engines, ReferenceStore& references, const RunnerHooks& hooks,
                 const std::atomic<bool>& stop) {
    return SuiteRunner(suite, engines, references, hooks, stop).run();
}

} // namespace rt::bench
