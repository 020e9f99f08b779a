// What is said of a run in several places of the comparison.
#pragma once
#include <string>

#include <imgui.h>

#include "Common/App/Interactive/RunGroups.h"
#include "Common/App/Interactive/RunHistory.h"
#include "Common/App/Options/Options.h"
#include "Common/Gui/Panels/Chart.h"

namespace rt::gui {

inline bool isGpuRun(const app::RunRecord& run) {
    return run.app == app::kGpuProgram;
}
std::string factorText(double factor); // "3.2x"
std::string ratioText(double ratio);   // "3.2x faster", "1.31x slower"
// How two runs compare, and how far repeated ones differ.
std::string headlineOf(const app::RunPair& pair, const app::RepeatedComparison& repeats);
std::string engineText(const app::RunRecord& run);         // "CPU multi, 8 threads"
std::string whenText(const app::RunRecord& run);           // "2026-11-25 04:40:04", UTC
std::string errorText(double value);                       // "1.23e-04"; "-": not known
std::string errorKind(const app::RunRecord& run);          // "measured", "estimated"; empty: there is none
std::string whatErrorKindMeans(const app::RunRecord& run); // a sentence
std::string runDetails(const app::RunRecord& run);         // what no column shows
Mark markOf(const std::string& lightSampling);             // of an estimator

} // namespace rt::gui
