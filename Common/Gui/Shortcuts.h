// What keys do.
#pragma once
#include "Common/Gui/Gui.h"
#include "Common/Gui/Window.h"

namespace rt::gui {

// A key that has gone down, within a frame of ImGui.
void obeyKey(Gui& gui, const Window::KeyPress& press);

// Moves the camera by the keys that are down, for this long; whether any is.
bool fly(Gui& gui, double seconds);

} // namespace rt::gui
