// Which engine renders, and on what.
#pragma once
#include <vector>

#include "Common/App/Interactive/InteractiveSession.h"
#include "Common/App/Options/Options.h"
#include "Common/Gui/Gui.h"

namespace rt::gui {

// What was chosen another time, without what this machine does not have; what `options` ask for stays, and fails where
// it cannot be had.
app::EngineChoice servedChoice(app::EngineChoice choice, const std::vector<app::EngineDevice>& devices,
                               const app::Options& options);

void drawEnginePanel(Gui& gui); // the rows of the rendering panel

} // namespace rt::gui
