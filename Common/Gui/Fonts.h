// The fonts that the interface can be drawn with.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace rt::gui {

struct FontFile {
    std::string name;
    std::filesystem::path file; // empty: ImGui's own, of fixed size
};
// Those that this machine has; ImGui's own comes last.
const std::vector<FontFile>& availableFonts();

} // namespace rt::gui
