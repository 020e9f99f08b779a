#include "Common/Render/Engine.h"

#include "Common/Render/PictureDenoiser.h"
#include "Common/Render/RenderParams.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {

AovImages makeAovImages(const AovRequest& request, std::uint32_t width, std::uint32_t height) {
    const std::uint32_t rows = request.rows > 0 ? request.rows : height;
    const auto make = [&](bool isWanted, image::Image& image, std::uint32_t channels) {
        if (isWanted) image = image::Image(width, rows, channels);
    };
    const auto makeAll = [&make](const SurfaceRequest& wanted, SurfaceImages& images) {
        make(wanted.albedo, images.albedo, 3);
        make(wanted.normal, images.normal, 3);
        make(wanted.depth, images.depth, 1);
    };
    AovImages images;
    makeAll(request, images);
    makeAll(request.wide, images.wide);
    make(request.emission, images.emission, 3);
    return images;
}

Snapshot Engine::snapshot() {
    const image::Film& whole = film();
    Snapshot result{whole.resolve(), {}};
    result.tileSamples.reserve(whole.tileCount());
    for (std::uint32_t tile = 0; tile < whole.tileCount(); ++tile) result.tileSamples.push_back(whole.samples(tile));
    return result;
}

TilesToPack Engine::takeTiles(const image::TileList& tiles) {
    const auto packed = std::make_shared<std::vector<std::byte>>(image::packTiles(film(), tiles));
    return [packed] { return std::move(*packed); };
}

std::unique_ptr<PictureDenoiser> Engine::makeDenoiser() {
    return makeHostDenoiser(*this);
}

DenoisedPicture Engine::denoiseHalves(const image::DenoiseInput& halves, bool details, std::uint32_t threads) {
    const Stopwatch watch;
    DenoisedPicture result;
    result.images = image::denoise(halves, dependentSide(report().features), threads, details);
    result.seconds = watch.seconds();
    return result;
}

std::optional<DenoisedPicture> Engine::denoiseWhole(const image::DenoiseInput& halves, bool details) {
    (void)halves, (void)details;
    return std::nullopt;
}

} // namespace rt::app
