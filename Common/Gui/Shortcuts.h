// What keys do.
#pragma once
#include <span>

#include "Common/Gui/Gui.h"
#include "Common/Gui/Window.h"

namespace rt::gui {

// A key that has gone down, within a frame of ImGui.
void obeyKey(Gui& gui, const Window::KeyPress& press);

// Moves the camera for this long by the keys that are down or, in `presses`, were since the frame before; whether any
// was.
bool fly(Gui& gui, std::span<const Window::KeyPress> presses, double seconds);

} // namespace rt::gui
