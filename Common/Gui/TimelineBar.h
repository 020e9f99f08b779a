// A line below the picture of a scene that moves: play, step, and the time.
#pragma once
#include "Common/Gui/Gui.h"
#include "Common/Gui/Layout.h"

namespace rt::gui {

// Each frame, before anything is drawn: what the timeline wishes is asked of the session.
void followTimeline(Gui& gui);
// At the bottom of the picture's part of the window, whose rest it returns: all of it where nothing moves.
Rect drawTimelineBar(Gui& gui, const Rect& area);
// Rows of the timeline that the bar and the panel have in common. The format of the time has its length.
void drawPlayButtons(Gui& gui);
bool timeSlider(const char* id, const app::Timeline& timeline, double& seconds);

} // namespace rt::gui
