// What is measured: a scene on an engine under settings. Each thing that a suite may vary is an axis, one row of a
// table that suites, reports and comparisons go by.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "Common/Render/Settings.h"

namespace rt::bench {

// What is made of a picture before it is compared: docs/denoising.md has the filters. Oidn: the user's library.
enum class Denoise { Off, On, Live, Oidn };

struct Config {
    std::string scene = "cornell-box-lights"; // id or file
    std::string camera;                       // as --camera takes it; empty: the scene's own
    std::string engine = "multi";
    std::uint32_t threads = 0; // CPU engines: 0 means all; of a rank, where there are several
    bool imported = false;     // a picture of another program, whose name is `engine`; its method is not known
    std::uint32_t ranks = 1;   // programs that render together, started by mpirun where there are several
    Denoise denoise = Denoise::Off;
    app::RenderSettings settings; // height 0: from the scene's aspect; spp and seed are no part of it

    Config() { settings.height = 0; }
};

struct Axis {
    enum class Says { Where, How }; // what is rendered and on what; by which method

    std::string_view name; // as in suites and reports
    Says says;
    std::string (*get)(const Config&);
    void (*set)(Config&, const std::string& value); // throws UsageError saying what is allowed
};
std::span<const Axis> axes();
const Axis* findAxis(std::string_view name); // null: there is none

// Of an imported picture only what it shows is, and who rendered it.
bool isKnown(const Axis& axis, const Config& config);

// The axes' values, joined: equal for equal configurations.
std::string keyOf(const Config& config);
// Of those that say one thing alone.
std::string keyOf(const Config& config, Axis::Says what);

inline constexpr std::string_view kEngines[] = {"single", "multi", "pipeline", "compute", "query"};
bool isGpuEngine(std::string_view engine);

} // namespace rt::bench
