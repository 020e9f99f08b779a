// The colours of the interface.
#pragma once
#include "Common/App/Interactive/GuiSettings.h"

struct ImGuiStyle;
struct ImVec4;

namespace rt::gui {

void applyTheme(ImGuiStyle& style, app::ColorMode mode);

// Of texts that tell of a failure, and of something to know.
ImVec4 errorColor(app::ColorMode mode);
ImVec4 noticeColor(app::ColorMode mode);

// What surrounds the picture, sRGB.
struct Rgb {
    float r, g, b;
};
Rgb surroundColor(app::ColorMode mode);

} // namespace rt::gui
