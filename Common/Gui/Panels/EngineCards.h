// The headline of the comparison: a card for each engine, how they compare, and the other engine's run.
#pragma once
#include "Common/Gui/Gui.h"

namespace rt::gui {

void drawEngineCards(Gui& gui);

} // namespace rt::gui
