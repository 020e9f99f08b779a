// The panels of the window: each shows a part of the state and changes a part of the settings; App sends what has
// changed.
#pragma once
#include <span>

#include "Common/Gui/Gui.h"
#include "Common/Gui/Layout.h"

namespace rt::gui {

// A panel is a file with its draw function, draw<Name>Panel, and a row of this table, from the top of the window down:
// PANEL(Name, id, title, place, whether it opens at first, whether it is shown with these settings).
// clang-format off
#define RT_PANELS(PANEL) \
    PANEL(Scene, "scene", "Scene", Side, true, settings.showPanels) \
    PANEL(Render, "rendering", "Rendering", Side, true, settings.showPanels) \
    PANEL(Camera, "camera", "Camera", Side, false, settings.showPanels) \
    PANEL(View, "view", "View", Side, false, settings.showPanels) \
    PANEL(File, "file", "File", Side, false, settings.showPanels) \
    PANEL(Statistics, "statistics", "Statistics", Side, false, settings.showPanels && settings.showStatistics) \
    PANEL(Settings, "settings", "Settings", Side, false, settings.showPanels) \
    PANEL(Objects, "objects", "Objects", Side, false, settings.showPanels) \
    PANEL(Sampler, "sampler", "Sampler", Side, false, settings.showPanels) \
    PANEL(Noise, "noise", "Pixel noise", Side, false, settings.showPanels) \
    PANEL(Motion, "motion", "Motion", Side, false, settings.showPanels) \
    PANEL(Comparison, "comparison", "Comparison", Bottom, true, settings.showComparison) \
    PANEL(Race, "race", "Race", Bottom, true, settings.showRace && !settings.showComparison)
// clang-format on

struct PanelRow {
    const char* id; // in the settings' list of open panels
    const char* title;
    Panel::Place place;
    bool opensAtFirst; // folded out where ImGui does not dock, until the user says otherwise
    bool (*isShown)(const app::GuiSettings& settings);
    void (*draw)(Gui& gui);
};
std::span<const PanelRow> panelTable();

#define RT_DECLARE(Name, id, title, place, opensAtFirst, isShown) void draw##Name##Panel(Gui& gui);
RT_PANELS(RT_DECLARE)
#undef RT_DECLARE

// ---- what is no panel ----------------------------------------------------------------------------------------------

void drawToolbar(Gui& gui);
void drawHistogram(const Gui& gui); // of the picture's luminance, in the panel of the view
void drawProgress(Gui& gui);        // above all panels
void drawStatusLine(Gui& gui);
void drawErrorOf(Gui& gui, app::ErrorSource source); // the latest unread one, at the field that it is about
void drawErrors(Gui& gui);                           // a list of them, where it is open
void drawScenes(Gui& gui);                           // to choose from, likewise
void drawHelp(Gui& gui);
void drawFirstSteps(Gui& gui, const Rect& area); // until they are taken or sent away, once in the settings' life

// The picture's part of the window without a border, where chips have their places: a picture that fits it is not
// covered by them. A legend lies over a corner of it, as the picture keeps its size whatever is shown.
Rect innerArea(const Gui& gui, const Rect& area, float scale);
float legendHeight(const Gui& gui, const Rect& area, float scale);  // 0: there is none
void drawViewLegend(const Gui& gui, const Rect& area, float scale); // in a corner of the picture's part of the window
// What the picture is: engine, samples, time, error; and which side is which, where two are compared. `image`: where
// the picture lies.
void drawChips(const Gui& gui, const Rect& area, const Rect& image, float scale);
// What keeps the user waiting, what has just happened and what the pointer is at, over the picture's part of the
// window.
void drawOverlay(Gui& gui, const Rect& area, float scale);
bool hasMessage(const Gui& gui); // that is seen now, at the bottom of the picture

} // namespace rt::gui
