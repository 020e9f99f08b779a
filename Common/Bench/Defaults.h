// How much of the best efficiency the default settings reach, where an experiment varies them.
#pragma once
#include <string>
#include <vector>

#include "Common/Bench/Results.h"

namespace rt::bench {

// Of one experiment on one engine, over its scenes, each at the most samples per pixel that all configurations have.
struct DefaultsRow {
    std::string experiment, engine;
    int scenes = 0;
    Figure mean;   // geometric mean of the default's 1 / (mse seconds) over that of the best configuration
    Figure meanCi; // half of the 95 % confidence interval, by those of the errors
    Figure least, leastCi;
    std::string leastScene; // where it is least
    Config leastBest;       // the best configuration there
};

// Experiments and engines in the order of their first row; those without a default configuration, or with no other, are
// left out, and so are scenes where a configuration has no error that can be told from zero.
std::vector<DefaultsRow> compareDefaults(const std::vector<Row>& rows);

} // namespace rt::bench
