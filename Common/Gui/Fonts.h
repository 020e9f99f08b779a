// The fonts that the interface can be drawn with.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <imgui.h>

namespace rt::gui {

struct FontFile {
    std::string name;
    std::filesystem::path file;           // empty: one of the program's own
    std::span<const unsigned char> bytes; // of a TrueType file in the program; empty, too: ImGui's own, of fixed size
};
// First the program's own, proportional but for its figures, so that numbers stand still while they change; then
// those of this machine; last ImGui's.
const std::vector<FontFile>& availableFonts();

// Its letters at this scale, or ImGui's where they cannot be had.
void addFont(ImFontAtlas& atlas, const FontFile& font, float scale);

} // namespace rt::gui
