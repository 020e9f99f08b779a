#include "Common/App/Session/RenderJob.h"

#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <system_error>
#include <utility>

#include "Common/App/Session/Attempt.h"
#include "Common/App/Session/FeatureNames.h"
#include "Common/App/Session/ImagePart.h"
#include "Common/App/Session/OpenImageDenoise.h"
#include "Common/App/Session/Outputs.h"
#include "Common/App/Session/Reference.h"
#include "Common/App/Session/Resume.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Log.h"
#include "Common/Core/NewFile.h"
#include "Common/Core/Paths.h"
#include "Common/Image/Flip.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/Stopwatch.h"

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

void noticeCutOff(std::uint32_t maxDepth, double share) {
    if (share <= kCutOffNoticed) return;
    const long permille = std::lround(1000 * share);
    logWarning("max depth " + std::to_string(maxDepth) + " has cut off " + std::to_string(permille / 10) + "." +
               std::to_string(permille % 10) + " % of what paths carry, and the picture may be darker by as much; " +
               "--max-depth lets them go on");
}

} // namespace

void RenderJob::load() {
    const Stopwatch watch;
    SceneRequest request{options_.scene, options_.oneSidedLights, options_.camera, options_.assetsBelow,
                         options_.moment};
    // Which the picture tells of, and the shutter is about.
    if (options_.shutter.isOpen() || options_.moment.time != 0) request.moment = options_.moment = wholeMoment(request);
    if (options_.shutter.isOpen()) {
        poses_ = posesOf(request);
        if (poses_ && options_.settings.features)
            poses_ = [poses = poses_, settings = options_.settings](double seconds) { // of which any may need more
                auto scene = poses(seconds);
                checkFeatures(settings, *scene);
                return scene;
            };
    }
    auto scene = poses_ ? poses_(options_.moment.time + options_.shutter.middle()) : compile(request);
    for (const std::string& notice : scene->notices) logWarning(scene->id + ": " + notice);
    if (options_.shutter.isOpen() && !poses_)
        logWarning(scene->id + ": nothing moves in it: --shutter counts for nothing");
    take(std::move(scene), 0);
    statistics_.seconds.load = watch.seconds();
}

void RenderJob::take(std::shared_ptr<const scene::CompiledScene> scene, double seconds) {
    scene_ = std::move(scene);
    settleImageSize(options_, scene_->id, scene_->defaults.aspect);
    checkFeatures(options_.settings, *scene_);
    if (options_.denoisesByOidn) OpenImageDenoise(); // fails where it is not installed, before hours are spent
    if (!options_.reference.empty())
        reference_ = readReference(options_.reference, options_.settings.width, options_.settings.height);
    statistics_.seconds.load = seconds;
}

bool RenderJob::begin(std::unique_ptr<Engine> engine, const std::atomic<bool>& cancel) {
    engine_ = std::move(engine);
    if (poses_) {
        const double time = options_.moment.time;
        const scene::Shutter& shutter = options_.shutter;
        engine_ = makeShutterEngine(std::move(engine_), time + shutter.open, time + shutter.close, poses_);
    }
    memoryForWriting_ = std::make_unique_for_overwrite<std::byte[]>(kMemoryForWriting);
    if (!engine_->setScene(scene_, &cancel)) return false;
    image::Film kept;
    if (!options_.resume.empty()) {
        kept = loadCheckpoint(options_.resume, options_.settings, *scene_, engine_->report(), engine_->motionHash());
        if (options_.wants(Aov::Variance) && options_.settings.replicates < 2 && !kept.desc().secondMoments)
            throw InputError(options_.resume +
                             ": second_moments is false in the checkpoint but --aov variance needs them");
    }
    run_.emplace(*engine_, scene_->camera, options_.settings, std::move(kept));
    if (!isWholeImage(options_)) run_->renderOnly(tilesToRender(options_, engine_->film()));
    statistics_.samplesRestored = engine_->film().totalSamples();
    denoiser_.emplace(options_, *engine_);
    limit(cancel);
    return true;
}

void RenderJob::limit(const std::atomic<bool>& cancel) {
    const auto saveOrWarn = [this, &cancel] {
        std::vector<std::string> failures;
        attempt(failures, "cannot write " + options_.checkpoint, [&] { save(options_.checkpoint, cancel); });
        if (!failures.empty()) logWarning(failures.front()); // the render itself is well
    };
    // Of the denoised picture, if there is one.
    std::function<std::optional<image::RelMseEstimate>(const image::Film&)> estimate;
    if (options_.denoises())
        estimate = [this](const image::Film& film) { return std::optional(denoiser_->denoise(film).relmse); };
    run_->limit({options_.timeLimit, options_.targetError, estimate, options_.saveEvery, saveOrWarn});
}

void RenderJob::compareWithReference() {
    const image::Image picture = engine_->film().resolve();
    statistics_.error = image::compare(picture, *reference_);
    statistics_.flip = image::flip(picture, *reference_);
}

std::optional<StopReason> RenderJob::slice(double seconds, const std::atomic<bool>& cancel) {
    std::optional<StopReason> reason;
    try {
        reason = run_->slice(seconds, cancel);
    } catch (const std::exception&) { // of the engine, or want of memory
        statistics_.stoppedBy = StopReason::Failure;
        throw;
    }
    if (!reason) return reason;
    statistics_.stoppedBy = *reason;
    if (reference_)
        attempt(failures_, options_.reference + ": cannot be compared with", [this] { compareWithReference(); });
    return reason;
}

// The checkpoint first, as all else can be made again from it. Whatever can be written is; then the first failure
// counts.
void RenderJob::write(const std::atomic<bool>& cancel) {
    memoryForWriting_.reset();
    const Interruptible interruptible(cancel); // where a reader stalls
    const Stopwatch watch;
    std::string lost;
    const image::Film& film = run_->keptFilm(lost);
    if (statistics_.stoppedBy == StopReason::Failure) {
        if (film.totalSamples() == 0) return; // black pictures must not replace what there may be
        logWarning("the render failed; what there is of it is written");
    }
    std::vector<std::string> failures = std::exchange(failures_, {});
    if (!lost.empty()) failures.push_back(lost);
    const auto saveCheckpoint = [&] { save(options_.checkpoint, cancel); };
    const bool isEnd = statistics_.stoppedBy != StopReason::Interrupted && statistics_.stoppedBy != StopReason::Failure;
    const bool keeps = !options_.checkpoint.empty() && (options_.keepsFinishedCheckpoint || !isEnd);
    const bool isSaved = keeps && attempt(failures, "cannot write " + options_.checkpoint, saveCheckpoint);
    const OutputResult outputs = writeOutputs(options_, scene_->camera, film, *engine_);
    failures.insert(failures.end(), outputs.failures.begin(), outputs.failures.end());
    statistics_.seconds.write = watch.seconds();
    statistics_.outputs = outputs.written;
    statistics_.denoised = outputs.denoised;
    writeStatistics(film, failures);
    if (failures.empty()) return;
    for (std::size_t i = 1; i < failures.size(); ++i) logWarning(failures[i]);
    throw RenderError(failures.front() + (outputs.failures.empty() || isSaved ? "" : rescue(cancel)));
}

void RenderJob::writeStatistics(const image::Film& film, std::vector<std::string>& failures) {
    statistics_.seconds.render = run_->seconds();
    if (!options_.stats.empty())
        attempt(failures, "cannot write " + options_.stats,
                [&] { writeText(options_.stats, statistics_.toJson(options_, *scene_, engine_->report(), film)); });
    if (const std::uint64_t bad = engine_->report().nonfiniteSamples; bad > 0)
        logWarning(std::to_string(bad) + " samples were not finite and count as black");
    noticeCutOff(options_.settings.maxDepth, engine_->report().cutOffShare());
}

std::string RenderJob::statisticsJson() {
    std::string lost;
    const image::Film& film = run_->keptFilm(lost);
    statistics_.seconds.render = run_->seconds();
    return statistics_.toJson(options_, *scene_, engine_->report(), film);
}

void RenderJob::save(const std::string& file, const std::atomic<bool>& cancel) const {
    const Interruptible interruptible(cancel);
    // Who looks on while a film grows asks how long it took; else equal films make equal files.
    const std::optional<double> seconds = options_.saveEvery ? std::optional(run_->seconds()) : std::nullopt;
    saveCheckpoint(file, options_.settings, *scene_, engine_->report(), engine_->motionHash(), seconds,
                   engine_->film());
}

// Samples that no output took must not be lost: they go to a new checkpoint in the first folder that takes it.
std::string RenderJob::rescue(const std::atomic<bool>& cancel) const {
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
            save(place.string(), cancel);
        };
        if (attempt(failures, "cannot write a checkpoint to " + folder.string(), saveNew))
            return "; its samples are in " + place.string() + " for --resume";
        if (!place.empty()) fs::remove(place, ignored);
        logWarning(failures.front());
    }
    return {};
}

} // namespace rt::app
