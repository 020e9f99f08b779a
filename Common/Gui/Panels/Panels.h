// The panels of the window: each shows a part of the state and changes a part of the settings; App sends what has changed.
#pragma once
#include "Common/Gui/Gui.h"
#include "Common/Gui/Layout.h"

namespace rt::gui {

void drawRenderControl(Gui& gui); // above all panels
void drawScenePanel(Gui& gui);
void drawRenderPanel(Gui& gui);
void drawCameraPanel(Gui& gui);
void drawViewPanel(Gui& gui);
void drawStatisticsPanel(Gui& gui);
void drawComparisonPanel(Gui& gui);
void drawHelp(Gui& gui);
void drawStatusLine(Gui& gui);
void drawViewLegend(const Gui& gui, const Rect& area, float scale); // in a corner of the picture's part of the window
// What keeps the user waiting, what has just happened and what the pointer is at, over the picture's part of the window.
void drawOverlay(const Gui& gui, const Rect& area, float scale);

} // namespace rt::gui
