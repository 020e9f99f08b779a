// What a report found, in sentences for who has read none before.
#pragma once
#include "Common/Bench/Document.h"
#include "Common/Bench/Results.h"
#include "Common/Bench/Suite.h"

namespace rt::bench {

// A heading, a sentence for each picture that several configurations rendered, and the table of those that came first;
// empty where nothing competes.
Document summaryBlocks(const Suite& suite, const Results& results);

} // namespace rt::bench
