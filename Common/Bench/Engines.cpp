#include "Common/Bench/Engines.h"

#include <algorithm>

#include "Common/Core/Error.h"

namespace rt::bench {
namespace {

const EngineKind* find(const std::vector<EngineKind>& kinds, const std::string& name) {
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](const EngineKind& kind) { return kind.name == name; });
    return found == kinds.end() ? nullptr : &*found;
}

} // namespace

std::string Engines::missing(const std::string& name) const {
    const EngineKind* kind = find(kinds_, name);
    if (kind == nullptr) return "not part of this build";
    return kind->make ? "" : kind->missing;
}

std::uint32_t Engines::maxRanks(const std::string& name) const {
    const EngineKind* kind = find(kinds_, name);
    return kind == nullptr ? 0 : kind->maxRanks;
}

EnergyCounter Engines::energy(const std::string& name) const {
    const EngineKind* kind = find(kinds_, name);
    return kind == nullptr ? EnergyCounter() : kind->energy;
}

app::Engine* Engines::prepare(const Config& config, const std::shared_ptr<const scene::CompiledScene>& scene,
                              const std::atomic<bool>& cancel) {
    if (const std::string why = missing(config.engine); !why.empty())
        throw RenderError("engine " + config.engine + ": " + why);
    const bool gpu = isGpuEngine(config.engine);
    Prepared& prepared = prepared_[gpu ? keyOf(config) : config.engine + "|" + std::to_string(config.threads)];
    if (!prepared.engine) prepared.engine = find(kinds_, config.engine)->make(config.threads);
    if (prepared.scene != scene) {
        if (!prepared.engine->setScene(scene, &cancel)) return nullptr;
        prepared.scene = scene;
    }
    return prepared.engine.get();
}

} // namespace rt::bench
