// The denoisers of Common/Image/Denoise on the film of any engine.
#include <algorithm>
#include <cstdint>
#include <utility>

#include "Common/Core/Interruption.h"
#include "Common/Image/Denoise/LiveDenoiser.h"
#include "Common/Image/FilmRows.h"
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

    bool isQuick() const override { return engine_.report().threads > 0; } // an engine of the processor

    std::optional<DenoisedPicture> denoise(const DenoiseRequest& request, const std::atomic<bool>& cancel) override {
        const Stopwatch watch;
        const image::Film& film = engine_.film();
        if (film.desc().replicates < 2 || film.minReplicateSamples() == 0) return std::nullopt;
        const bool isLive = request.quality == DenoiseQuality::Live;
        if (!renderFeatures(request.featureSamples, film.desc(), cancel)) return std::nullopt;
        try {
            const Interruptible interruptible(cancel);
            return DenoisedPicture{request.quality, filter(film, isLive, request.details), watch.seconds()};
        } catch (const Interrupted&) {
            return std::nullopt;
        }
    }

  private:
    image::Denoised filter(const image::Film& film, bool isLive, bool details) {
        const EngineReport report = engine_.report();
        for (image::Image* half : {&input_.halfA, &input_.halfB}) { // whose memory stays
            if (half->data.empty()) *half = image::Image(film.desc().width, film.desc().height);
            image::readInto(*half, image::halfRows(film, half == &input_.halfA ? 0 : 1), report.threads);
        }
        input_.samplesOfHalf = std::uint64_t{film.minReplicateSamples()} * (film.desc().replicates / 2);
        if (!isLive) return image::denoise(input_, dependentSide(report.features), report.threads, details);
        image::Denoised result;
        result.picture = live_.filter(input_, report.threads);
        return result;
    }

    // Of at least so many samples, some rows at a time; where they are called off the rows that there are remain.
    // False: called off.
    bool renderFeatures(std::uint32_t samples, const image::FilmDesc& size, const std::atomic<bool>& cancel) {
        if (samples <= samples_) return true;
        if (samples != comingSamples_) {
            comingSamples_ = samples;
            comingRows_ = 0;
            coming_ = {};
            coming_.albedo = coming_.normal = image::Image(size.width, size.height, 3);
            coming_.depth = image::Image(size.width, size.height, 1);
        }
        std::uint32_t step = 1;
        while (comingRows_ < size.height) {
            if (cancel.load(std::memory_order_relaxed)) return false;
            step = std::min(step, size.height - comingRows_);
            const Stopwatch watch;
            AovRequest request{{true, true, true}, comingRows_, step};
            request.isAdaptive = true;
            const AovImages rows = engine_.renderAovs(request, samples);
            putRows(rows.albedo, comingRows_, coming_.albedo);
            putRows(rows.normal, comingRows_, coming_.normal);
            putRows(rows.depth, comingRows_, coming_.depth);
            comingRows_ += step;
            const double fitting = step * kRowsSeconds / std::max(watch.seconds(), 1e-6);
            step = static_cast<std::uint32_t>(std::clamp(fitting, 1.0, 16.0 * step));
        }
        samples_ = samples;
        input_.albedo = std::move(coming_.albedo);
        input_.normal = std::move(coming_.normal);
        input_.depth = std::move(coming_.depth);
        return true;
    }

    Engine& engine_;
    image::LiveDenoiser live_;
    image::DenoiseInput input_; // with the features of `samples_` samples of each pixel
    std::uint32_t samples_ = 0;
    AovImages coming_; // those of more samples, of which so many rows are there
    std::uint32_t comingSamples_ = 0, comingRows_ = 0;
};

} // namespace

std::unique_ptr<PictureDenoiser> makeHostDenoiser(Engine& engine) {
    return std::make_unique<HostDenoiser>(engine);
}

} // namespace rt::app
