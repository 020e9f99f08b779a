#include "Common/App/Session/Engine.h"

namespace rt::app {

Snapshot Engine::snapshot() {
    const image::Film& whole = film();
    Snapshot result{whole.resolve(), {}};
    result.tileSamples.reserve(whole.tileCount());
    for (std::uint32_t tile = 0; tile < whole.tileCount(); ++tile) result.tileSamples.push_back(whole.samples(tile));
    return result;
}

} // namespace rt::app
