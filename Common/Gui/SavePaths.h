// Names for pictures that are saved without being asked for one.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "Common/App/InteractiveSession.h"

namespace rt::gui {

// `folder`, or where that is empty the user's pictures folder or home.
std::filesystem::path saveFolder(const std::string& folder);

// A PNG and an EXR in saveFolder(folder); no such file exists yet.
std::vector<std::string> savePaths(const std::string& folder, const app::SessionState& state);

} // namespace rt::gui
