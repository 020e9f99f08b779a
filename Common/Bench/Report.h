// The report on a run of the benchmark, for people.
#pragma once
#include <filesystem>

#include "Common/Bench/Document.h"
#include "Common/Bench/Results.h"
#include "Common/Bench/Suite.h"

namespace rt::bench {

Document makeReport(const Results& results, const Suite& suite);

// results.json, results.csv, report.md with its plots, report.html. Makes the folder. Throws RenderError.
void writeReport(const std::filesystem::path& folder, const Results& results, const Suite& suite);

// The folder can be written to; throws RenderError before hours are spent.
void checkReportFolder(const std::filesystem::path& folder);

} // namespace rt::bench
