// The few questions that each operating system answers in its own way.
#pragma once
#include <cstdint>
#include <filesystem>

namespace rt::app {

std::uint64_t peakResidentBytes(); // of this process; 0 where unknown
bool standardErrorIsTerminal();
// $XDG_CONFIG_HOME/ray-tracing or the platform's place for it; empty when the environment names none.
std::filesystem::path userConfigDirectory();

} // namespace rt::app
