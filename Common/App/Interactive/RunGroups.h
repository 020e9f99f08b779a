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

// Two runs side by side, the first as the baseline; both or none.
struct RunPair {
    const RunRecord* first = nullptr;
    const RunRecord* second = nullptr;
};
// The CPU's first; of one program's the older one.
RunPair pairOf(const RunRecord& a, const RunRecord& b);

// A run and those that repeat it: of the same work by the same engine, device and number of threads.
struct Repeats {
    std::size_t count = 0; // of those whose figure is known
    double median = 0, minimum = 0, maximum = 0;
    double spread() const { return median > 0 ? (maximum - minimum) / median : 0; }
};

// How two runs compare. Figures that are not known are 0.
struct Comparison {
    double samplesPerSecond = 0; // of the second over that of the first
    // Time of the first over that of the second until both have the same error: mean squared errors fall with the
    // number of samples, so that it is the ratio of error * time. Both errors must be of one kind, and of one picture.
    double timeToEqualError = 0;
    bool isMeasured = false; // of timeToEqualError: against a reference; otherwise by the films' own estimates
};
Comparison compareRuns(const RunRecord& first, const RunRecord& second);

// What of it can be told apart from how repeated runs differ: by samples per second where the work is the same, else
// by efficiency, the inverse of error * time.
struct RepeatedComparison {
    static constexpr std::size_t kMinRuns = 3; // of each, for anything to be told
    bool isByError = false;
    Repeats first, second;
    double ratio = 0; // of the medians, the second over the first; 0: not known
    bool isKnown() const { return first.count >= kMinRuns && second.count >= kMinRuns; }
    bool isToldApart() const {
        return first.maximum < second.minimum || second.maximum < first.minimum;
    } // requires isKnown()
};
RepeatedComparison compareRepeats(const RunPair& pair, const std::vector<RunRow>& rows);

// Whether the reference of a run is too noisy for its error: its own standard error is more than a third of it (in
// squares a ninth), as the benchmark asks of its references.
bool isReferenceTooNoisy(double relmse, double referenceError);

} // namespace rt::app
