#include "Common/App/Session/Session.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "Common/App/Platform.h"
#include "Common/App/Ranks/LocalRank.h"
#include "Common/App/Ranks/RankedEngine.h"
#include "Common/App/Session/Attempt.h"
#include "Common/App/Session/DenoiseFilm.h"
#include "Common/App/Session/FeatureNames.h"
#include "Common/App/Session/ImagePart.h"
#include "Common/App/Session/Interrupt.h"
#include "Common/App/Session/OpenImageDenoise.h"
#include "Common/App/Session/Outputs.h"
#include "Common/App/Session/Reference.h"
#include "Common/App/Session/Resume.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/App/Session/Statistics.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Log.h"
#include "Common/Core/NewFile.h"
#include "Common/Core/Paths.h"
#include "Common/Core/ReadFile.h"
#include "Common/Image/Flip.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/FilmRun.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Scene/Json/SceneJson.h"

namespace rt::app {
namespace {

constexpr std::size_t kMemoryForWriting = std::size_t{4} << 20; // bytes
constexpr double kCutOffNoticed = 0.01;                         // share of throughput

void checkFeatures(const RenderSettings& settings, const scene::CompiledScene& scene) {
    const shared::Features missing = scene.features & ~settings.features.value_or(shared::kFeatureAll);
    if (missing == shared::kFeatureNone) return;
    std::string names;
    for (const std::string& name : featureNames(missing)) names += (names.empty() ? "" : ",") + name;
    throw UsageError("--features: the scene also needs " + names);
}

std::string describeEnd(const Statistics& statistics) {
    const StopReason reason = statistics.stoppedBy;
    std::string text = reason == StopReason::Interrupted   ? "interrupted"
                       : reason == StopReason::TimeLimit   ? "time limit reached"
                       : reason == StopReason::TargetError ? "target error reached"
                                                           : "done";
    if (statistics.error) text += ", relMSE " + std::to_string(statistics.error->relmse);
    return text;
}

void noticeCutOff(std::uint32_t maxDepth, double share) {
    if (share <= kCutOffNoticed) return;
    const long permille = std::lround(1000 * share);
    logWarning("max depth " + std::to_string(maxDepth) + " has cut off " + std::to_string(permille / 10) + "." +
               std::to_string(permille % 10) + " % of what paths carry, and the picture may be darker by as much; " +
               "--max-depth lets them go on");
}

// One render without a window, stage by stage.
class HeadlessRender {
  public:
    explicit HeadlessRender(Options options, Communicator* ranks = nullptr)
        : options_(std::move(options)), ranks_(ranks) {}

    ExitCode run(const EngineFactory& makeEngine) {
        interrupt_.finishFirst([this] { // before hours are spent
            checkOutputs(options_);
            if (options_.denoisesByOidn) OpenImageDenoise();
        });
        load();
        engine_ = makeEngine();
        if (ranks_ != nullptr) engine_ = makeRankedEngine(std::move(engine_), *ranks_);
        interrupt_.defer(); // from here on there may be something to save
        if (!engine_->setScene(scene_, &interrupt_.requested())) return ExitCode::Interrupted;
        beginFilm();
        try {
            sample();
        } catch (const std::exception&) { // of the engine, or want of memory
            statistics_.stoppedBy = StopReason::Failure;
            write();
            throw;
        }
        write();
        return statistics_.stoppedBy == StopReason::Interrupted ? ExitCode::Interrupted : ExitCode::Done;
    }

    // Writes nothing, and ends when rank 0 says so.
    void follow(const EngineFactory& makeEngine) {
        interrupt_.defer(); // rank 0 gets the same signal
        load();
        engine_ = makeEngine();
        engine_->setScene(scene_, nullptr);
        engine_->resetForLeases(scene_->camera, options_.settings);
        LocalRank rank(*engine_, *scene_, options_.settings);
        connect(rank, *ranks_);
    }

  private:
    void load();
    void beginFilm();
    void sample();
    void compareWithReference();
    void write();
    void save(const std::string& file) const;
    std::string rescue() const;

    Options options_;
    Communicator* ranks_; // null: this process renders alone
    Interrupt interrupt_;
    std::shared_ptr<const scene::CompiledScene> scene_;
    std::optional<image::Image> reference_;
    std::unique_ptr<Engine> engine_;
    std::optional<FilmRun> run_;
    Statistics statistics_;
    std::vector<std::string> failures_; // of what is done with the samples, one line each
    // Kept from the render, so that what it leaves can be written when it has taken all other memory.
    std::unique_ptr<std::byte[]> memoryForWriting_ = std::make_unique_for_overwrite<std::byte[]>(kMemoryForWriting);
};

// Also settles what the options leave to the scene.
void HeadlessRender::load() {
    const Stopwatch watch;
    scene_ = compile(SceneRequest{options_.scene, options_.oneSidedLights, options_.camera, options_.assetsBelow});
    for (const std::string& notice : scene_->notices) logWarning(scene_->id + ": " + notice);
    settleImageSize(options_, scene_->id, scene_->defaults.aspect);
    checkFeatures(options_.settings, *scene_);
    if (!options_.reference.empty())
        reference_ = readReference(options_.reference, options_.settings.width, options_.settings.height);
    statistics_.seconds.load = watch.seconds();
}

void HeadlessRender::beginFilm() {
    image::Film kept;
    if (!options_.resume.empty()) {
        kept = loadCheckpoint(options_.resume, options_.settings, *scene_, engine_->report());
        if (options_.wants(Aov::Variance) && options_.settings.replicates < 2 && !kept.desc().secondMoments)
            throw InputError(options_.resume +
                             ": second_moments is false in the checkpoint but --aov variance needs them");
    }
    run_.emplace(*engine_, scene_->camera, options_.settings, std::move(kept));
    if (!isWholeImage(options_)) run_->renderOnly(tilesToRender(options_, engine_->film()));
    statistics_.samplesRestored = engine_->film().totalSamples();
}

void HeadlessRender::sample() {
    const auto style = options_.quiet              ? Progress::Style::Silent
                       : standardErrorIsTerminal() ? Progress::Style::Terminal
                                                   : Progress::Style::Lines;
    Progress progress(std::cerr, style, options_.progressEvery.value_or(Progress::kLineSeconds));
    const auto saveOrWarn = [this] {
        std::vector<std::string> failures;
        attempt(failures, "cannot write " + options_.checkpoint, [this] { save(options_.checkpoint); });
        if (!failures.empty()) logWarning(failures.front()); // the render itself is well
    };
    FilmDenoiser denoiser(options_, *engine_); // whose picture's error counts, if there is one
    std::function<std::optional<image::RelMseEstimate>(const image::Film&)> estimate;
    if (options_.denoises())
        estimate = [&denoiser](const image::Film& film) { return std::optional(denoiser.denoise(film).relmse); };
    run_->limit({options_.timeLimit, options_.targetError, estimate, options_.saveEvery, saveOrWarn});
    std::optional<StopReason> reason;
    while (!reason) {
        reason = run_->slice(FilmRun::kSliceSeconds, interrupt_.requested());
        progress.update(run_->progress());
    }
    statistics_.stoppedBy = *reason;
    if (reference_)
        attempt(failures_, options_.reference + ": cannot be compared with", [this] { compareWithReference(); });
    progress.finish(run_->progress(), describeEnd(statistics_));
}

void HeadlessRender::compareWithReference() {
    const image::Image picture = engine_->film().resolve();
    statistics_.error = image::compare(picture, *reference_);
    statistics_.flip = image::flip(picture, *reference_);
}

// The checkpoint first, as all else can be made again from it. Whatever can be written is; then the first failure
// counts.
void HeadlessRender::write() {
    memoryForWriting_.reset();
    const Interruptible interruptible(interrupt_.requested()); // where a reader stalls
    const Stopwatch watch;
    std::string lost;
    const image::Film& film = run_->keptFilm(lost);
    if (statistics_.stoppedBy == StopReason::Failure) {
        if (film.totalSamples() == 0) return; // black pictures must not replace what there may be
        logWarning("the render failed; what there is of it is written");
    }
    if (!lost.empty()) failures_.push_back(lost);
    statistics_.seconds.render = run_->seconds();
    const auto saveCheckpoint = [this] { save(options_.checkpoint); };
    const bool isSaved =
        !options_.checkpoint.empty() && attempt(failures_, "cannot write " + options_.checkpoint, saveCheckpoint);
    const OutputResult outputs = writeOutputs(options_, scene_->camera, film, *engine_);
    failures_.insert(failures_.end(), outputs.failures.begin(), outputs.failures.end());
    statistics_.seconds.write = watch.seconds();
    statistics_.outputs = outputs.written;
    statistics_.denoised = outputs.denoised;
    if (!options_.stats.empty())
        attempt(failures_, "cannot write " + options_.stats,
                [&] { writeText(options_.stats, statistics_.toJson(options_, *scene_, engine_->report(), film)); });
    if (const std::uint64_t bad = engine_->report().nonfiniteSamples; bad > 0)
        logWarning(std::to_string(bad) + " samples were not finite and count as black");
    noticeCutOff(options_.settings.maxDepth, engine_->report().cutOffShare());
    if (failures_.empty()) return;
    for (std::size_t i = 1; i < failures_.size(); ++i) logWarning(failures_[i]);
    throw RenderError(failures_.front() + (outputs.failures.empty() || isSaved ? "" : rescue()));
}

void HeadlessRender::save(const std::string& file) const {
    const Interruptible interruptible(interrupt_.requested());
    saveCheckpoint(file, options_.settings, *scene_, engine_->report(), engine_->film());
}

// Samples that no output took must not be lost: they go to a new checkpoint in the first folder that takes it.
std::string HeadlessRender::rescue() const {
    namespace fs = std::filesystem;
    const fs::path beside = checkpointBeside(options_.outputs.front());
    std::vector<fs::path> folders = {beside.parent_path()};
    std::error_code ignored; // what cannot be made shows when the checkpoint is
    if (const fs::path state = userStateFolder(); !state.empty()) {
        if (fs::create_directories(state, ignored)) fs::permissions(state, fs::perms::owner_all, ignored);
        folders.push_back(state);
    }
    for (const fs::path& folder : folders) {
        std::vector<std::string> failures;
        fs::path place;
        const auto saveNew = [&] {
            place = createNumbered(folder, beside.filename());
            save(place.string());
        };
        if (attempt(failures, "cannot write a checkpoint to " + folder.string(), saveNew))
            return "; its samples are in " + place.string() + " for --resume";
        if (!place.empty()) fs::remove(place, ignored);
        logWarning(failures.front());
    }
    return {};
}

void exportScene(const Options& options) {
    const ReadsBelow confined(options.assetsBelow, options.scene);
    scene::SceneDesc scene = loadScene(options.scene);
    if (!options.camera.empty()) scene.camera = cameraOf(options.camera, scene);
    for (const std::string& notice : scene.notices) logWarning(scene.id + ": " + notice);
    writeText(options.exportFile, scene::toJson(scene));
}

} // namespace

ExitCode runSession(Options options, const EngineFactory& makeEngine, Communicator* ranks) {
    if (ranks != nullptr && options.command != Command::Render)
        throw UsageError("mpirun: only to render; start one program for --list-scenes and --export-scene");
    switch (options.command) {
        case Command::ListScenes:
            std::cout << listScenes(options.json);
            return ExitCode::Done;
        case Command::ExportScene:
            exportScene(options);
            return ExitCode::Done;
        case Command::ListDevices:
            throw std::logic_error("devices are listed by the program that knows them");
        case Command::Render:
            break;
    }
    return HeadlessRender(std::move(options), ranks).run(makeEngine);
}

void followSession(Options options, const EngineFactory& makeEngine, Communicator& ranks) {
    options.reference.clear();
    HeadlessRender(std::move(options), &ranks).follow(makeEngine);
}

} // namespace rt::app
