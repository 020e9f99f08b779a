// The table of runs: groups of equal work, with a column for each part of the work that differs.
#pragma once
#include "Common/Gui/Gui.h"

namespace rt::gui {

void drawRunTable(Gui& gui, ImVec2 size); // with what all runs have in common above it

} // namespace rt::gui
