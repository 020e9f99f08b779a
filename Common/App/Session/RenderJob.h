// One render of what options ask for, stage by stage, by whoever drives it: a session on the command line, or a script.
#pragma once
#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "Common/App/Session/DenoiseFilm.h"
#include "Common/App/Session/Statistics.h"
#include "Common/Image/Film.h"
#include "Common/Image/Image.h"
#include "Common/Render/Engine.h"
#include "Common/Render/FilmRun.h"
#include "Common/Render/ShutterEngine.h"
#include "Common/Scene/CompiledScene.h"

namespace rt::app {

// Not thread-safe. Order of calls: load or take, begin, slice until it returns a reason, write.
class RenderJob {
  public:
    explicit RenderJob(Options options) : options_(std::move(options)) {}

    // Compiles the scene that the options name. Throws InputError, and what take() throws.
    void load();
    // Renders a scene that was compiled in so many seconds, and settles what the options leave to the scene. Throws
    // UsageError, and InputError for a reference that cannot be used.
    void take(std::shared_ptr<const scene::CompiledScene> scene, double seconds);

    // Begins the film, or goes on from the checkpoint that the options name. False: `cancel` became true. Throws what
    // the engine throws, and InputError for the checkpoint.
    bool begin(std::unique_ptr<Engine> engine, const std::atomic<bool>& cancel);

    // As FilmRun::slice(), within the limits of the options; compares with the reference when the run has ended. After
    // an exception write() saves what there is of the film.
    std::optional<StopReason> slice(double seconds, const std::atomic<bool>& cancel);

    // All files that the options name. Throws RenderError with the first failure; the rest are warnings by then.
    void write(const std::atomic<bool>& cancel);
    void save(const std::string& file, const std::atomic<bool>& cancel) const; // a checkpoint. Throws RenderError

    const Options& options() const { return options_; }
    const std::shared_ptr<const scene::CompiledScene>& scene() const { return scene_; }
    Engine& engine() { return *engine_; }
    const FilmRun& run() const { return *run_; }
    const Statistics& statistics() const { return statistics_; }
    FilmDenoiser& denoiser() { return *denoiser_; }
    std::string statisticsJson(); // of the film as it is

  private:
    void compareWithReference();
    void limit(const std::atomic<bool>& cancel);
    void writeStatistics(const image::Film& film, std::vector<std::string>& failures);
    std::string rescue(const std::atomic<bool>& cancel) const;

    Options options_;
    std::shared_ptr<const scene::CompiledScene> scene_;
    PoseScene poses_; // none: the picture is of one instant, or nothing moves
    std::optional<image::Image> reference_;
    std::unique_ptr<Engine> engine_;
    std::optional<FilmDenoiser> denoiser_;
    std::optional<FilmRun> run_;
    Statistics statistics_;
    std::vector<std::string> failures_; // of what is done with the samples, one line each
    // Kept from the render, so that what it leaves can be written when it has taken all other memory.
    std::unique_ptr<std::byte[]> memoryForWriting_;
};

} // namespace rt::app
