// The colours of the interface.
#pragma once
#include <cstddef>

#include "Common/App/Interactive/GuiSettings.h"

struct ImGuiStyle;
struct ImVec4;

namespace rt::gui {

void applyTheme(ImGuiStyle& style, app::ColorMode mode);

// Of texts that tell of a failure, and of something to know.
ImVec4 errorColor(app::ColorMode mode);
ImVec4 noticeColor(app::ColorMode mode);

// Of what is to be done first, and of the text on it.
ImVec4 accentColor(app::ColorMode mode);
ImVec4 accentTextColor(app::ColorMode mode);

// By which an engine is known everywhere: in the toolbar, over the picture, in tables and charts. Distinct also for
// those who see few colours (Okabe and Ito 2008, "Color Universal Design"), darker where the background is light.
ImVec4 engineColor(bool isGpu, app::ColorMode mode);

// Of the axes X, Y and Z (0, 1, 2) on dark edges over a picture, in all modes; -1: of what is along none of them.
ImVec4 axisColor(int axis);

// Of the entrants of a race, distinct likewise.
ImVec4 entrantColor(std::size_t entrant, app::ColorMode mode);

// What surrounds the picture, sRGB: grey, so that its colours are seen as they are.
struct Rgb {
    float r, g, b;
};
Rgb surroundColor(app::ColorMode mode);

} // namespace rt::gui
