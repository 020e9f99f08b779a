// From runs to rows: medians, errors, comparisons.
#pragma once
#include <string>
#include <vector>

#include "Common/Bench/Measurement.h"
#include "Common/Bench/Results.h"
#include "Common/Bench/Suite.h"
#include "Common/Image/ErrorAnalysis.h"

namespace rt::bench {

// A configuration and its runs, one for each repeat. Runs may end early; a row needs a snapshot of at least one.
struct Measured {
    Config config;
    double secondsLoad = 0; // of the scene
    std::vector<Run> runs;
    bool failed = false; // and is not tried again
};

// A row for each step of the ladder that a run reached, without errors.
std::vector<Row> makeRows(const Experiment& experiment, const Measured& measured);

// The errors of the rows that makeRows() made of `measured`; none where a pixel has no sample in one of the repeats.
void addErrors(std::vector<Row>& rows, const Measured& measured, const image::Reference& reference);

// Speed-up and gain of all rows of an experiment over its baseline, at the same samples per pixel or the baseline's
// last.
void addBaselines(const Experiment& experiment, std::vector<Row>& rows);

// The rows of one scene's configurations as curves, compared at equal time and at equal error.
std::vector<Series> makeSeries(const Experiment& experiment, const std::vector<Row>& rows);

// A row for each pair of configurations that differ in their features only.
std::vector<SkipRow> compareFeatures(const Experiment& experiment, const std::vector<Measured>& measured);

} // namespace rt::bench
