#include "RayTracingGPU/GpuDenoiser.h"

#include <cstddef>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Vulkan/Check.h"

namespace rt::gpu {

DeviceDenoiser& GpuDenoiser::of(std::uint32_t width, std::uint32_t height) {
    if (picture_ && width_ == width && height_ == height) return *picture_;
    width_ = width;
    height_ = height;
    surfaceSamples_ = 0;
    picture_.reset(); // its memory may be needed
    return picture_.emplace(context_, pipelines_, width, height);
}

bool GpuDenoiser::provideSurfaces(FilmOnDevice& film, std::uint32_t samples, const std::atomic<bool>& cancel) {
    if (surfaceSamples_ >= samples) return true;
    surfaceSamples_ = 0;
    if (!film.renderSurfaces(samples, picture_->surfaces(), cancel)) return false;
    picture_->surfacesChanged();
    surfaceSamples_ = samples;
    return true;
}

void GpuDenoiser::begin(const shared::Camera& camera, const app::RenderSettings& settings) {
    surfaceSamples_ = 0;
    history_.begin(camera, settings);
}

void GpuDenoiser::report(app::DenoisedPicture& result) const {
    result.device = context_.info().name;
    for (std::size_t i = 0; i < kDenoisePasses; ++i)
        if (const double seconds = picture_->passSeconds()[i]; seconds > 0)
            result.passes.push_back({kDenoisePassNames[i], seconds});
}

app::DenoisedPicture GpuDenoiser::denoise(const image::DenoiseInput& input, std::uint32_t dependentSide, bool details,
                                          FilmOnDevice* surfaces) {
    static const std::atomic<bool> kByNobody = false;
    const app::Stopwatch watch;
    const std::atomic<bool>* cancel = interruptionFlag();
    DeviceDenoiser& device = of(input.halfA.width, input.halfA.height);
    if (!surfaces) {
        surfaceSamples_ = 0;
        device.setSurfaces(input.albedo, input.normal, input.depth);
    } else if (!provideSurfaces(*surfaces, app::kAovSamples, cancel ? *cancel : kByNobody)) {
        throw Interrupted();
    }
    device.setHalves(input.halfA, input.halfB);
    if (!device.run(input.samplesOfHalf, dependentSide, cancel)) throw Interrupted();
    app::DenoisedPicture result;
    result.images = device.read(details);
    report(result);
    result.seconds = watch.seconds();
    return result;
}

namespace {

class FilmDenoiser final : public app::PictureDenoiser {
  public:
    FilmDenoiser(app::Engine& engine, FilmOnDevice& film, std::uint32_t width, std::uint32_t height)
        : engine_(engine), film_(film), width_(width), height_(height) {}

    bool isQuick() const override { return !hasFailed_ || byHost_->isQuick(); }
    bool needsHalves() const override { return hasFailed_; }

    std::optional<app::DenoisedPicture> denoise(const app::DenoiseRequest& request,
                                                const std::atomic<bool>& cancel) override {
        try {
            if (!hasFailed_) return onDevice(request, cancel);
        } catch (const vulkan::DeviceLostError&) {
            throw;
        } catch (const RenderError&) {
            hasFailed_ = true;
        }
        return host().denoise(request, cancel);
    }

  private:
    app::PictureDenoiser& host() {
        if (!byHost_) byHost_ = app::makeHostDenoiser(engine_);
        return *byHost_;
    }

    // A film of one replicate, as of one sample a pixel, has no halves, but each of its pixels may belong to one.
    std::uint64_t resolve(bool isLive, const vulkan::Buffer& to, bool& isOne) {
        const std::uint64_t samplesOfHalf = film_.resolveHalves(to);
        isOne = samplesOfHalf == 0 && isLive;
        return isOne ? film_.resolveOne(to) : samplesOfHalf;
    }

    std::optional<app::DenoisedPicture> onDevice(const app::DenoiseRequest& request, const std::atomic<bool>& cancel) {
        const app::Stopwatch watch;
        GpuDenoiser& denoiser = film_.denoiser();
        DeviceDenoiser& device = denoiser.of(width_, height_);
        const bool isLive = request.quality == app::DenoiseQuality::Live;
        bool isOne = false;
        const std::uint64_t samples = resolve(isLive, device.halves(), isOne);
        if (samples == 0) return host().denoise(request, cancel); // a part of the film may be on the host
        if (!denoiser.provideSurfaces(film_, request.featureSamples, cancel)) return std::nullopt;
        app::DenoisedPicture result;
        result.quality = request.quality;
        if (isLive) {
            const HistoryStep step = denoiser.history().step(width_, height_, samples, isOne);
            device.runLive(&step);
            result.images.picture = device.readLive();
        } else {
            if (!device.run(samples, film_.dependentSide(), &cancel)) return std::nullopt;
            result.images = device.read(request.details);
            if (denoiser.history().isInUse()) device.remember(denoiser.history().step(width_, height_, samples, false));
        }
        denoiser.report(result);
        result.seconds = watch.seconds();
        return result;
    }

    app::Engine& engine_;
    FilmOnDevice& film_;
    std::uint32_t width_, height_;
    bool hasFailed_ = false;                       // the device, which is not asked again
    std::unique_ptr<app::PictureDenoiser> byHost_; // with the features that it has rendered, once it was needed
};

} // namespace

std::unique_ptr<app::PictureDenoiser> makeFilmDenoiser(app::Engine& engine, FilmOnDevice& film, std::uint32_t width,
                                                       std::uint32_t height) {
    return std::make_unique<FilmDenoiser>(engine, film, width, height);
}

} // namespace rt::gpu
