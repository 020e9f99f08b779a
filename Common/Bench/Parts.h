// Where the time of an engine goes: a scene with one part of the work left out at a time.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "Common/App/Session/Engine.h"
#include "Common/Bench/Document.h"
#include "Common/Bench/Engines.h"

namespace rt::bench {

// A part, and the settings that do without it.
struct Part {
    const char* name;
    std::vector<std::pair<const char*, const char*>> values; // of axes (Config.h)
    bool isMaterials = false;                                // every surface is diffuse, of one grey
};
// The first leaves nothing out.
std::span<const Part> parts();

struct PartsRequest {
    std::string scene = "cornell-box-lights"; // id or file
    std::string engine = "compute";
    std::uint32_t width = 600;
    double seconds = 0.3; // of sampling, where nothing is left out; all others take as many samples
};

struct PartRow {
    std::string part;
    double seconds = 0; // in kernels; of engines of the processor wall time
    std::uint64_t samples = 0;
    app::RayCounts rays;
    std::string kernel;
    shared::Features features;
    std::vector<app::ShaderFigure> shaders;
};

// A row a part, fewer when `stop` becomes true. Throws as the engine and its scene do.
std::vector<PartRow> measureParts(Engines& engines, const PartsRequest& request, const std::atomic<bool>& stop,
                                  const std::function<void(const PartRow&)>& report = {});

// What each costs, and what the driver tells of its shaders.
Document describeParts(const PartsRequest& request, std::span<const PartRow> rows);

} // namespace rt::bench
