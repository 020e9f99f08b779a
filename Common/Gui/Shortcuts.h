// What keys do.
#pragma once
#include <span>

#include "Common/Gui/Gui.h"
#include "Common/Gui/InputQueue.h"

namespace rt::gui {

bool isKeyPress(const InputEvent& event);

// What isKeyPress(), within a frame of ImGui.
void obeyKey(Gui& gui, const InputEvent& press);

// Moves the camera for this long by the keys that are down or, in `input`, were since the frame before; whether any
// was.
bool fly(Gui& gui, std::span<const InputEvent> input, double seconds);

} // namespace rt::gui
