// Which setting is the most efficient, as tables of a report.
#pragma once
#include <vector>

#include "Common/Bench/Document.h"
#include "Common/Bench/Results.h"

namespace rt::bench {

// Of one experiment: settings as columns, side by side at each place. Empty where nothing competes.
Document efficiencyBlocks(const std::vector<const Row*>& rows);

// The defaults against the best setting, experiment by experiment.
Document defaultsBlocks(const std::vector<Row>& rows);

} // namespace rt::bench
