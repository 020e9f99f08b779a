// Which measurements a run of the benchmark makes. Format: Assets/bench.schema.json, docs/benchmark.md.
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "Common/Bench/Config.h"

namespace rt::bench {

// Every combination of the values of its axes, each over all samples per pixel (or seconds).
struct Experiment {
    std::string name;
    std::string title;
    std::vector<std::pair<const Axis*, std::vector<std::string>>> values; // axes not named have their default
    using Variant = std::vector<std::pair<const Axis*, std::string>>;     // values of some axes that belong together
    std::vector<Variant> variants;               // instead of every combination of their axes; empty: none
    std::vector<std::uint32_t> spp;              // ascending; either these
    std::vector<double> seconds;                 // ascending; or these, of sampling
    std::uint32_t repeats = 1;                   // runs of each, with seeds 0, 1, ...
    bool error = true;                           // compare with a reference
    bool images = true;                          // show them in the report
    std::map<std::string, std::uint32_t> maxSpp; // by engine: leave out what is above
    double maxSeconds = 600;                     // of sampling in one run; what would take longer is left out
    std::map<const Axis*, std::string> baseline; // row to compare with: the same but for these; empty: none
};

// What others published, beside our rows of the same scene, size and samples per pixel.
struct Published {
    std::string name;
    std::string scene;
    std::uint32_t width = 0, height = 0;
    std::map<std::uint32_t, double> seconds; // by samples per pixel
};

// A picture of another program; not part of a suite's file.
struct Import {
    std::string name; // of the program, or of how it rendered
    std::string file; // linear radiance
    double seconds = 0;
};

struct Suite {
    std::string name;
    std::string title;
    double referenceSeconds = 60; // most that may be spent on one reference
    std::vector<Experiment> experiments;
    std::vector<Published> published;
    std::vector<Import> imports; // of the one picture that it measures
};

// Throws InputError naming the file, the JSON path, the value and what is allowed.
Suite parseSuite(const std::string& text, const std::string& file);

struct NamedSuite {
    const char* name;
    const char* text; // JSON
};
std::span<const NamedSuite> namedSuites();

// One of namedSuites() or a .json file. Throws InputError.
Suite loadSuite(const std::string& nameOrFile);

// Whether its configurations differ in that axis.
bool varies(const Experiment& experiment, const Axis& axis);

// Runs every experiment on these scenes instead of its own, or on these engines only.
void replaceScenes(Suite& suite, const std::vector<std::string>& scenes);
void restrictEngines(Suite& suite, const std::vector<std::string>& engines);

// All combinations without those that mean the same (threads of an engine that has one, how lights are chosen where
// none is sampled) or need more threads than there are.
std::vector<Config> combinations(const Experiment& experiment, std::uint32_t hardwareThreads);

} // namespace rt::bench
