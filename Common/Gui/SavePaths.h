// Names for pictures that are saved without being asked for one.
#pragma once
#include <string>
#include <vector>

#include "Common/App/InteractiveSession.h"

namespace rt::gui {

// A PNG and an EXR in `folder`, or where that is empty in the user's pictures folder or home; no such file exists yet.
std::vector<std::string> savePaths(const std::string& folder, const app::SessionState& state);

} // namespace rt::gui
