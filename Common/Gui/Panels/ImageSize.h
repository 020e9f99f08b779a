// Rows of the image's size. What takes much memory is asked for before it is reserved.
#pragma once
#include "Common/Gui/Gui.h"

namespace rt::gui {

void drawImageSize(Gui& gui);

} // namespace rt::gui
