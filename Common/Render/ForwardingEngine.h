// An engine that hands every call on to another one.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "Common/Render/Engine.h"
#include "Common/Render/PictureDenoiser.h"

namespace rt::app {

class ForwardingEngine : public Engine {
  public:
    bool setScene(std::shared_ptr<const scene::CompiledScene> scene, const std::atomic<bool>* cancel) override {
        return engine_->setScene(std::move(scene), cancel);
    }
    void reset(const scene::CameraDesc& camera, const RenderSettings& settings) override {
        engine_->reset(camera, settings);
    }
    void resetForLeases(const scene::CameraDesc& camera, const RenderSettings& settings) override {
        engine_->resetForLeases(camera, settings);
    }
    void restore(image::Film film) override { engine_->restore(std::move(film)); }
    void renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed) override {
        engine_->renderOnly(std::move(tiles), spp, packed);
    }
    RenderStatus renderSome(const Budget& budget) override { return engine_->renderSome(budget); }
    const image::Film& film() override { return engine_->film(); }
    TilesToPack takeTiles(const image::TileList& tiles) override { return engine_->takeTiles(tiles); }
    Snapshot snapshot() override { return engine_->snapshot(); }
    AovImages renderAovs(const AovRequest& request, std::uint32_t samples) override {
        return engine_->renderAovs(request, samples);
    }
    bool knowsCost(Cost cost) const override { return engine_->knowsCost(cost); }
    image::Image renderCost(Cost cost, std::uint32_t samples) override { return engine_->renderCost(cost, samples); }
    bool canPreview() const override { return engine_->canPreview(); }
    Preview renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) override {
        return engine_->renderPreview(camera, width, height);
    }
    std::unique_ptr<PictureDenoiser> makeDenoiser() override { return engine_->makeDenoiser(); }
    DenoisedPicture denoiseHalves(const image::DenoiseInput& halves, bool details, std::uint32_t threads) override {
        return engine_->denoiseHalves(halves, details, threads);
    }
    std::optional<DenoisedPicture> denoiseWhole(const image::DenoiseInput& halves, bool details) override {
        return engine_->denoiseWhole(halves, details);
    }
    EngineReport report() const override { return engine_->report(); }
    std::uint64_t motionHash() override { return engine_->motionHash(); }

  protected:
    std::unique_ptr<Engine> engine_; // set before anything is called
};

} // namespace rt::app
