// A render that a script drives.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "Common/App/Options/Options.h"
#include "Common/App/Session/RenderJob.h"
#include "Common/Image/Image.h"
#include "Common/Render/FilmRun.h"
#include "Common/Render/Progress.h"
#include "Python/Scene.h"

namespace rt::python {

// Any thread may call any member; one waits for the other. Of those that wait for a slice, cancel() is none.
class ScriptedFilm {
  public:
    // Begins the film, or goes on from the checkpoint that the options name. Throws what a render on the command line
    // throws.
    ScriptedFilm(const std::shared_ptr<Scene>& scene, app::Options options);

    // Samples for about so many seconds. Returns what has ended the render, once something has. Throws RenderError.
    std::optional<app::StopReason> advance(double seconds);
    // Ends the slice that is under way, if any, within 100 ms, and the render as Ctrl-C does.
    void cancel() { cancel_ = true; }
    std::atomic<bool>& cancelFlag() { return cancel_; }

    void write(); // the files that the options name
    void save(const std::string& checkpoint);
    std::string statistics();
    app::ProgressState progress();
    image::Image image(); // linear radiance; black outside of a region
    image::Image aov(app::Aov aov);

    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    const std::string& checkpointFile() const { return checkpointFile_; } // of the options; empty: none

  private:
    const image::Film& film();
    image::Image denoised(app::Aov aov);
    image::Image feature(app::Aov aov);

    std::mutex mutex_;
    std::atomic<bool> cancel_{false};
    app::RenderJob job_;
    std::optional<app::StopReason> ended_;
    std::uint32_t width_ = 0, height_ = 0;
    std::string checkpointFile_;
};

} // namespace rt::python
