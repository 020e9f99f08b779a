// Numerical stability of an engine: scenes whose answer is known, pushed to where single precision hurts. The same rows
// are asserted by tests and printed by `ray-tracing-bench --stability`.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "Common/Bench/Document.h"
#include "Common/Render/Engine.h"

namespace rt::bench {

struct StabilityRow {
    std::string name;
    std::string engine;    // as the engine reports itself
    double value = 0;      // what `criterion` is about
    std::string criterion; // "|mean - exact| <= 4 standard errors + 1e-5", "differing pixels = 0", ...
    bool pass = false;
};

struct StabilityOptions {
    bool thorough = false;                             // 10^6 samples per pixel where sums are accumulated, else 10^5
    std::function<void(const StabilityRow&)> measured; // called with each row as it is known; may be empty
};

// Leaves the engine with another scene and film.
std::vector<StabilityRow> measureStability(app::Engine& engine, const StabilityOptions& options = {});

// As a table, with the number of failures.
Document describeStability(const std::vector<StabilityRow>& rows);

} // namespace rt::bench
