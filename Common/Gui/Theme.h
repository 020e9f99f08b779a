// The colours of the interface.
#pragma once
#include "Common/App/GuiSettings.h"

struct ImGuiStyle;

namespace rt::gui {

void applyTheme(ImGuiStyle& style, app::ColorMode mode);

// What surrounds the picture, sRGB.
struct Rgb {
    float r, g, b;
};
Rgb surroundColor(app::ColorMode mode);

} // namespace rt::gui
