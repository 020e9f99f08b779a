// The engines that a benchmark may use. The program that knows them says how each is made.
#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "Common/App/Session/Engine.h"
#include "Common/Bench/Config.h"
#include "Common/Bench/Energy.h"

namespace rt::bench {

struct EngineKind {
    std::string name;                                                        // one of kEngines
    std::function<std::unique_ptr<app::Engine>(std::uint32_t threads)> make; // empty: there is none here
    std::string missing;                                                     // and this is why
    EnergyCounter energy = {};                                               // of its device alone; may be empty
    std::uint32_t maxRanks = 1;                                              // that have something to render on
};

// Engines are made when first used and keep the scene that they have. GPU engines also keep the pipeline that their
// settings ask for, which may take long to compile: each configuration has one of its own.
class Engines {
  public:
    explicit Engines(std::vector<EngineKind> kinds) : kinds_(std::move(kinds)) {}

    // Why there is no such engine here; empty: there is one.
    std::string missing(const std::string& name) const;

    // Ranks above this number have nothing to render on.
    std::uint32_t maxRanks(const std::string& name) const;

    // Of this engine's device; empty: there is none.
    EnergyCounter energy(const std::string& name) const;

    // The engine that this configuration asks for, with the scene; null when cancelled.
    app::Engine* prepare(const Config& config, const std::shared_ptr<const scene::CompiledScene>& scene,
                         const std::atomic<bool>& cancel);

    // Lets go of all scenes, and of the memory that engines hold.
    void clear() { prepared_.clear(); }

  private:
    struct Prepared {
        std::unique_ptr<app::Engine> engine;
        std::shared_ptr<const scene::CompiledScene> scene;
    };
    std::vector<EngineKind> kinds_;
    std::map<std::string, Prepared> prepared_;
};

} // namespace rt::bench
