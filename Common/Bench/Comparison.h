// Two reports side by side: what became slower or noisier beyond what chance explains.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "Common/Bench/Document.h"
#include "Common/Bench/Results.h"

namespace rt::bench {

struct Change {
    const Row* before = nullptr;
    const Row* after = nullptr;
    Figure seconds, mse, efficiency;     // after / before
    Figure gain;                         // after / before, of efficiencies over the baseline's in the same run
    bool slower = false, faster = false; // beyond noise
    bool noisier = false, lessNoisy = false;
    bool regressed() const { return slower || noisier; }
};

struct Comparison {
    std::vector<Change> changes;               // rows that both have
    std::size_t onlyBefore = 0, onlyAfter = 0; // rows that one has
    std::size_t regressions() const;
};

// Times count as changed beyond the larger of 5 % and twice the spread (half of least to most, over the median) of
// both; errors beyond their 95 % intervals, at least 2 %. Rows are matched by experiment, axes and samples per pixel
// (or time budget).
Comparison compareResults(const Results& before, const Results& after);

// A results.json, or the folder of a report. Throws InputError.
Results loadResults(const std::filesystem::path& path);

Document describe(const Comparison& comparison, const Results& before, const Results& after);

} // namespace rt::bench
