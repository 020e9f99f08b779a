// What moves with the pointer of what is selected: by a tool that a key begins, or by the handles of the gizmo.
#pragma once
#include "Common/Gui/Gui.h"

namespace rt::gui {

// Until a click, Enter or Escape.
void beginTool(Gui& gui, app::ObjectTool::Kind kind);
// Likewise; undone unless it is confirmed.
void endTool(Gui& gui, bool isConfirmed);

// Each frame, before the mouse is for anything else; `isInside`: the pointer is over the picture's part of the window.
// Whether a press was for a handle, which the pointer has from then on.
bool gripGizmo(Gui& gui, const Rect& image, bool isInside);
// Whether the handle has been moved since it was pressed.
bool isDragged(const Gui& gui);

void followTool(Gui& gui, const Rect& image);                  // each frame while there is one
void drawTools(Gui& gui, const Rect& image, const Rect& area); // the gizmo, and what a tool tells

} // namespace rt::gui
