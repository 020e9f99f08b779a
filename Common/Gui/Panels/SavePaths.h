// What is saved to which files.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Interactive/GuiSettings.h"
#include "Common/App/Interactive/InteractiveState.h"
#include "Common/App/Options/Options.h"

namespace rt::gui {

// `folder`, or where that is empty the user's pictures folder or home.
std::filesystem::path saveFolder(const std::string& folder);

// For pictures without a name: a PNG and an EXR in saveFolder(folder); no such file exists yet.
std::vector<std::string> savePaths(const std::string& folder, const app::SessionState& state, app::SavedPicture what);

// For a picture of the panel Sampler: a PNG likewise, beside which is no JSON.
std::string probePath(const std::string& folder, const app::SessionState& state,
                      const std::array<std::uint32_t, 2>& pixel);

// What the program was asked for when it was started.
app::SaveRequest filesOf(const app::Options& options, float exposure, app::Tonemap tonemap);
// The same at first, if it is to be written when the first render ends.
std::optional<app::SaveRequest> endFiles(const app::Options& options, const app::GuiSettings& settings);

} // namespace rt::gui
