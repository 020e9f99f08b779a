// What a report is made of: sentences, tables and charts, and the page that shows them.
#pragma once
#include <string>
#include <vector>

#include "Common/Bench/Chart.h"
#include "Common/Bench/Document.h"
#include "Common/Bench/Results.h"
#include "Common/Bench/Suite.h"

namespace rt::bench {

// A heading, a sentence for each picture that several configurations rendered, and the table of those that came first;
// empty where nothing competes.
Document summaryBlocks(const Suite& suite, const Results& results);

// The curves of an experiment. With errors: relmse over samples and over seconds, for each scene. Without: samples per
// second over the axis of numbers that varies (a scene's count, the width, the threads), if there is one.
std::vector<Chart> makeCharts(const std::vector<const Row*>& rows);

// Of one experiment: settings as columns, side by side at each place. Empty where nothing competes.
Document efficiencyBlocks(const std::vector<const Row*>& rows);

// The defaults against the best setting, experiment by experiment.
Document defaultsBlocks(const std::vector<Row>& rows);

// Raw pictures against filtered ones, of all experiments whose rows have both; empty where none has. A chart for each
// scene and way to render comes first, then the time that each takes to the other's error, then both at equal samples.
Document denoiseBlocks(const std::vector<Row>& rows);

// One HTML file that needs nothing else: it follows the reader's light or dark, prints, and sorts its tables where
// scripts may run. Points of charts lead to the rows of tables that have the same origin.
std::string toHtml(const Document& document, const std::string& title);

} // namespace rt::bench
