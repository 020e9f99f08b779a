// The panels of the window: each shows a part of the state and changes a part of the settings; App sends what has
// changed.
#pragma once
#include <span>

#include "Common/Gui/Gui.h"
#include "Common/Gui/Layout.h"

namespace rt::gui {

// A panel is a file with its draw function and a row of this table, from the top of the window down.
struct PanelRow {
    const char* id; // in the settings' list of open panels
    const char* title;
    Panel::Place place;
    bool opensAtFirst; // folded out where ImGui does not dock, until the user says otherwise
    bool (*isShown)(const app::GuiSettings& settings);
    void (*draw)(Gui& gui);
};
std::span<const PanelRow> panelTable();

void drawRenderControl(Gui& gui); // above all panels
void drawScenePanel(Gui& gui);
void drawRenderPanel(Gui& gui);
void drawCameraPanel(Gui& gui);
void drawViewPanel(Gui& gui);
void drawStatisticsPanel(Gui& gui);
void drawComparisonPanel(Gui& gui);

// ---- what is no panel ----------------------------------------------------------------------------------------------

void drawHelp(Gui& gui);
void drawStatusLine(Gui& gui);
void drawViewLegend(const Gui& gui, const Rect& area, float scale); // in a corner of the picture's part of the window
// What keeps the user waiting, what has just happened and what the pointer is at, over the picture's part of the
// window.
void drawOverlay(const Gui& gui, const Rect& area, float scale);

} // namespace rt::gui
