// Raw pictures against filtered ones: what the filter gains, its time included.
#pragma once
#include <vector>

#include "Common/Bench/Document.h"
#include "Common/Bench/Results.h"

namespace rt::bench {

// Of all experiments whose rows have both; empty where none has. A chart for each scene and way to render comes first,
// then the time that each takes to the other's error, then both at equal samples.
Document denoiseBlocks(const std::vector<Row>& rows);

} // namespace rt::bench
