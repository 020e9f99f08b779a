// A program of this project that another one runs: where it is, what it is told, what it says.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "Common/Render/Settings.h"

namespace rt::app {

// "ray-tracing-cpu" in `folder`, or beside the running program. Throws RenderError where it is not.
std::filesystem::path programFile(const std::string& name, const std::filesystem::path& folder = {});

// Size, samples, depth, seed, replicates and methods, as flags each followed by its value.
std::vector<std::string> settingFlags(const RenderSettings& settings);

// The flags that ask for these settings, but for a forced feature mask; its files besides.
std::vector<std::string> flagsFor(const RenderSettings& settings, const std::filesystem::path& picture,
                                  const std::filesystem::path& statistics);

// Throws RenderError where a program has not ended well, with what it said last in its messages.
void checkEnd(const std::string& program, int exitCode, const std::filesystem::path& messages);

std::string textOf(const std::filesystem::path& file); // empty where there is none
std::string lastLine(const std::string& text);         // that is not empty

} // namespace rt::app
