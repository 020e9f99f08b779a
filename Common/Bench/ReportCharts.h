// Which curves a report shows of an experiment's rows.
#pragma once
#include <vector>

#include "Common/Bench/Chart.h"
#include "Common/Bench/Results.h"

namespace rt::bench {

// With errors: relmse over samples and over seconds, for each scene. Without: samples per second over the axis of
// numbers that varies (a scene's count, the width, the threads), if there is one.
std::vector<Chart> makeCharts(const std::vector<const Row*>& rows);

} // namespace rt::bench
