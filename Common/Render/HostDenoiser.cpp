// The denoiser of Common/Image/Denoise on the film of any engine.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "Common/Core/Interruption.h"
#include "Common/Image/Denoise/FilmHalves.h"
#include "Common/Render/Engine.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Render/RenderParams.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {
namespace {

constexpr double kRowsSeconds = 0.03; // that the features of some rows may take at a time, as nothing interrupts them

void putRows(const image::Image& rows, std::uint32_t first, image::Image& all) {
    std::copy(rows.data.begin(), rows.data.end(), all.pixel(0, first));
}

class HostDenoiser final : public PictureDenoiser {
  public:
    explicit HostDenoiser(Engine& engine) : engine_(engine) {}

    std::optional<DenoisedPicture> denoise(const DenoiseRequest& request, const std::atomic<bool>& cancel) override {
        const Stopwatch watch;
        const image::Film& film = engine_.film();
        if (film.desc().replicates < 2 || film.minReplicateSamples() == 0) return std::nullopt;
        if (!renderFeatures(kAovSamples, film.desc(), cancel)) return std::nullopt;
        image::DenoiseInput input = image::filmHalves(film);
        input.albedo = features_.albedo;
        input.normal = features_.normal;
        input.depth = features_.depth;
        const EngineReport report = engine_.report();
        DenoisedPicture result;
        try {
            const Interruptible interruptible(cancel);
            result.images = image::denoise(input, dependentSide(report.features), report.threads);
        } catch (const Interrupted&) {
            return std::nullopt;
        }
        if (!request.details)
            result.images.halfA = result.images.halfB = result.images.error = result.images.bandwidth = {};
        result.seconds = watch.seconds();
        return result;
    }

  private:
    // Some rows at a time. False: cancelled.
    bool renderFeatures(std::uint32_t samples, const image::FilmDesc& size, const std::atomic<bool>& cancel) {
        if (samples != samples_) {
            samples_ = samples;
            rows_ = 0;
            features_ = {image::Image(size.width, size.height, 3), image::Image(size.width, size.height, 3),
                         image::Image(size.width, size.height, 1)};
        }
        std::uint32_t step = 1;
        while (rows_ < size.height) {
            if (cancel.load(std::memory_order_relaxed)) return false;
            step = std::min(step, size.height - rows_);
            const Stopwatch watch;
            const AovImages rows = engine_.renderAovs({true, true, true, rows_, step}, samples);
            putRows(rows.albedo, rows_, features_.albedo);
            putRows(rows.normal, rows_, features_.normal);
            putRows(rows.depth, rows_, features_.depth);
            rows_ += step;
            const double fitting = step * kRowsSeconds / std::max(watch.seconds(), 1e-6);
            step = static_cast<std::uint32_t>(std::clamp(fitting, 1.0, 8.0 * step));
        }
        return true;
    }

    Engine& engine_;
    AovImages features_;
    std::uint32_t samples_ = 0, rows_ = 0; // of the features: samples of each pixel, and rows that are there
};

} // namespace

std::unique_ptr<PictureDenoiser> makeHostDenoiser(Engine& engine) {
    return std::make_unique<HostDenoiser>(engine);
}

} // namespace rt::app
