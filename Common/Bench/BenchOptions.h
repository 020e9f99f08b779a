// The command line of ray-tracing-bench.
#pragma once
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "Common/Bench/Suite.h"
#include "Common/Manual/Page.h"

namespace rt::bench {

// The suite of frames of a camera that moves, which is no list of experiments: Live.h.
inline constexpr const char* kLiveSuite = "live";

struct BenchOptions {
    std::string suite = "quick";      // name or file
    std::vector<std::string> scenes;  // instead of the suite's
    std::vector<std::string> engines; // of the suite's, only these
    std::string report;               // folder; empty: tables on standard output only
    std::string device;               // Vulkan device: index or part of a name
    bool freshReferences = false;
    bool quiet = false;
    std::vector<std::string> compare; // two reports; empty: measure
    std::vector<Import> imports;      // beside what is measured
    bool listSuites = false;
    bool stability = false; // the stability suite instead of a suite
    bool parts = false;     // what parts of the work cost instead of a suite
};

// Nothing after --help, --help-all and --version, which are answered on `out`. Throws UsageError.
std::optional<BenchOptions> parseBenchOptions(const std::vector<std::string>& arguments, std::ostream& out);

manual::Page benchPage();

} // namespace rt::bench
