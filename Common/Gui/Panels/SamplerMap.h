// The picture of the panel Sampler: a map over directions, with what was drawn.
#pragma once
#include "Common/Gui/Gui.h"

namespace rt::gui {

// In the present window of ImGui, over its whole width but for what a panel can spare in height, with a legend.
void drawSamplerMap(Gui& gui, const probe::ProbeState& state);

} // namespace rt::gui
