// Which setting is the most efficient, by all pixels and by those up to 1 alone, and how much of that the defaults
// reach.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "Common/Bench/Results.h"

namespace rt::bench {

// The pixels that an error is of, as columns of rows.
struct PixelSet {
    const char* name;
    FigureOf<Row> mse;
    FigureOf<Row> mseCi;
    FigureOf<Row> efficiency;
};
std::span<const PixelSet> pixelSets(); // all; those that the reference has at 1 or less

// Whether the row has an error of these pixels that can be told from zero.
bool isKnown(const Row& row, const PixelSet& pixels);

// The settings that an experiment has at one place, each at the most samples per pixel (or after the longest time) that
// all have.
struct Match {
    std::vector<const Row*> rows;  // one of each
    const Row* best = nullptr;     // the most efficient of the known ones; null: there is none
    const Row* defaults = nullptr; // default in all that varies; null: there is none
};

// Of one experiment's rows, in the order of each place's first.
std::vector<Match> matchesOf(const std::vector<const Row*>& rows, const PixelSet& pixels);

// The default's efficiency over that of the best.
struct Reach {
    int places = 0; // where both are known, and there is another setting
    Figure mean;    // geometric, over these places
    Figure meanCi;  // half of the 95 % confidence interval, by those of the errors
    Figure minimum, minCi;
    const Row *minBest = nullptr, *minDefaults = nullptr; // the two where it is least
};

// Of one experiment on one engine; `rows` must live on.
struct DefaultsRow {
    std::string experiment, engine;
    const PixelSet* pixels = nullptr;
    int places = 0; // at which settings compete
    Reach reach;
};

// Experiments and engines in the order of their first row, each by all pixels and by those up to 1; those where the
// defaults compete nowhere are left out.
std::vector<DefaultsRow> compareDefaults(const std::vector<Row>& rows);

} // namespace rt::bench
