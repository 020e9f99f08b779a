// Rows of the image's size. What takes much memory is asked for before it is reserved.
#pragma once
#include "Common/Gui/Gui.h"

namespace rt::gui {

void drawImageSize(Gui& gui);
// As many viewports are to be there, after a question where they take much memory, which is drawn in the panel View.
void wishViewports(Gui& gui, std::size_t count);
void drawViewportQuestion(Gui& gui);

} // namespace rt::gui
