#include "Common/Render/Engine.h"

namespace rt::app {

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

} // namespace rt::app
