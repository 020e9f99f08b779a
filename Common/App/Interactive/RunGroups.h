// Runs of the history side by side: what they have in common is said once, what differs is a column, and runs of equal
// work stand together.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "Common/App/Interactive/RunHistory.h"

namespace rt::app {

struct RunRow {
    const RunRecord* record;
    std::size_t group;              // runs of equal work, counted from 0 in the order of the rows
    std::vector<std::string> cells; // one for each column
};

struct RunGroups {
    std::vector<WorkField> common;    // of all runs
    std::vector<const char*> columns; // titles of what differs
    std::vector<RunRow> rows;         // groups in the order of their first run, each in the order of the runs
    std::size_t groups = 0;
};
// What is not meant to be read (scene hash, camera) becomes a number, counted from 1 as values occur; what a record
// lacks becomes "?".
RunGroups groupByWork(const std::vector<const RunRecord*>& runs);

// How two runs of equal work compare, the first as the baseline. Figures that are not known are 0.
struct Comparison {
    double samplesPerSecond = 0; // of the second over that of the first
    // Time of the first over that of the second until both have the same error: mean squared errors fall with the
    // number of samples, so that it is the ratio of error * time. Both errors must be of one kind.
    double timeToEqualError = 0;
    bool isMeasured = false; // of timeToEqualError: against a reference; otherwise by the films' own estimates
};
Comparison compareRuns(const RunRecord& first, const RunRecord& second);

// Whether the reference of a run is too noisy for its error: its own standard error is more than a third of it (in
// squares a ninth), as the benchmark asks of its references.
bool isReferenceTooNoisy(double relmse, double referenceError);

} // namespace rt::app
