// The headline of the comparison: a card for each engine, how they compare, and beside them the other engine's run.
#pragma once
#include <functional>

#include "Common/Gui/Gui.h"

namespace rt::gui {

// `drawMore` goes below the other engine's run, whose width is that of the row's rest: it elides or wraps.
void drawEngineCards(Gui& gui, const std::function<void()>& drawMore);

} // namespace rt::gui
