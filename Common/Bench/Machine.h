// Where and by what a report was made.
#pragma once
#include <vector>

#include "Common/Bench/Results.h"

namespace rt::bench {

// Date, program, compiler, system, processor.
std::vector<Fact> machineFacts();

} // namespace rt::bench
