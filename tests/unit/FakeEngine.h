// An engine whose samples cost nothing and are known: it stands in for a real one in tests of what drives engines.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Render/Engine.h"

namespace rt::app {

inline const std::atomic<bool> kGoOn{false}; // the cancellation that never comes

class FakeEngine : public Engine {
  public:
    // Value of sample `sample` of a pixel: its mean is 0.5, and every one is another.
    static float value(std::uint32_t x, std::uint32_t y, std::uint32_t channel, std::uint32_t sample,
                       std::uint32_t seed) {
        std::uint32_t h = x * 73856093u ^ y * 19349663u ^ channel * 83492791u ^ sample * 2654435761u ^ seed * 40503u;
        h = (h ^ h >> 16) * 0x7feb352du;
        h = (h ^ h >> 15) * 0x846ca68bu;
        return static_cast<float>((h ^ h >> 16) >> 8) * 0x1p-24f;
    }

    std::function<void(std::uint32_t)>
        onSample; // is told the number of samples per pixel after each call of renderSome
    std::uint32_t calls = 0;
    bool filmFails = false; // once
    bool aovsFail = false;

    bool setScene(std::shared_ptr<const scene::CompiledScene> scene, const std::atomic<bool>* cancel) override {
        if (cancel->load()) return false;
        report_.features = scene->features;
        return true;
    }
    void reset(const scene::CameraDesc&, const RenderSettings& settings) override {
        settings_ = settings;
        film_ = image::Film({settings.width, settings.height, settings.replicates, settings.secondMoments});
    }
    void restore(image::Film film) override { film_ = std::move(film); }
    void renderOnly(image::TileList, std::uint32_t, std::span<const std::byte>) override {
        throw std::logic_error("it renders whole films only");
    }

    // One more sample of every pixel.
    RenderStatus renderSome(const Budget&) override {
        ++calls;
        const auto sample = static_cast<std::uint32_t>(film_.minSamples());
        if (sample < settings_.spp) addSample(sample);
        if (onSample) onSample(sample + 1);
        const std::uint64_t pixels = std::uint64_t{settings_.width} * settings_.height;
        return {film_.minSamples() >= settings_.spp, film_.totalSamples(), pixels * settings_.spp};
    }
    const image::Film& film() override {
        if (std::exchange(filmFails, false)) throw RenderError("the film cannot be read");
        return film_;
    }
    // What it finds tells of how many samples it is.
    AovImages renderAovs(const AovRequest& request, std::uint32_t samples) override {
        if (aovsFail) throw RenderError("no features");
        AovImages images = makeAovImages(request, settings_.width, settings_.height);
        const auto fill = [](image::Image& image, float value) { image.data.assign(image.data.size(), value); };
        const float count = static_cast<float>(samples) / 64;
        fill(images.albedo, count);
        fill(images.normal, -1);
        fill(images.depth, 8);
        fill(images.wide.albedo, count / 2);
        fill(images.wide.normal, 1);
        fill(images.wide.depth, 16);
        fill(images.emission, 4);
        return images;
    }
    EngineReport report() const override { return report_; }

  private:
    void addSample(std::uint32_t sample) {
        const std::uint32_t replicate = sample % settings_.replicates;
        film_.reserveOpenBlocks();
        for (std::uint32_t tile = 0; tile < film_.tileCount(); ++tile) {
            image::Film::TileBlock block;
            film_.begin(tile, replicate, block);
            const std::uint32_t x0 = tile % film_.tilesX() * image::Film::kTile;
            const std::uint32_t y0 = tile / film_.tilesX() * image::Film::kTile;
            for (std::uint32_t i = 0; i < image::Film::kTilePixels * 3; ++i) {
                const std::uint32_t pixel = i / 3;
                block.sum[i] += value(x0 + pixel % image::Film::kTile, y0 + pixel / image::Film::kTile, i % 3, sample,
                                      settings_.seed);
            }
            ++block.count;
            film_.commit(tile, replicate, block);
        }
    }

    static EngineReport makeReport() {
        EngineReport report;
        report.engine = "multi";
        report.device = "none";
        report.kernel = "fake/none";
        report.threads = 1;
        report.rays = {10, 20, 30, 40, 50};
        return report;
    }

    RenderSettings settings_;
    image::Film film_;
    EngineReport report_ = makeReport();
};

} // namespace rt::app
