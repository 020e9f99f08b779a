// What is kept of a race: its table, and the suite by which ray-tracing-bench repeats it.
#pragma once
#include <string>

#include "Common/App/Interactive/Race.h"

namespace rt::app {

// CSV: a line for each point of each curve. `times_leader`, at the last point of each: how far it is behind the leader,
// by factorOf().
std::string raceTable(const RaceState& race, bool isGpu);

// Why no suite can repeat it; null: one can.
const char* whyNoSuite(const RaceState& race);
// A suite of ray-tracing-bench. Entrants whose engine is not known yet have the default one of their program.
// `sceneFile`: what has the edited scene; empty: the scene is as its source has it.
std::string raceSuite(const RaceState& race, bool isGpu, const std::string& sceneFile = {});

} // namespace rt::app
