// Icons of the toolbar and of lists, drawn as lines and areas: sharp at any scale, and in no font's hands.
#pragma once
#include <imgui.h>

#include "Common/Gui/Widgets.h"

namespace rt::gui {

enum class Icon {
    Start,
    Pause,
    Stop,
    Restart,
    Open,
    Save,
    Split,
    Denoise,
    Chart,
    Flag,
    Figures,
    Panels,
    Help,
    Warning,
    Close,
    Folder,
    File,
    Up,
    Eye,
    ClosedEye
};

// Into a square of that side at `corner`.
void drawIcon(ImDrawList& list, Icon icon, ImVec2 corner, float side, ImU32 color);

// A square button as high as a row, whose name is for ImGui; whether it was pressed. `isOn`: what it switches is on.
bool iconButton(const char* id, Icon icon, const char* tip, Usable usable = true, bool isOn = false);
// An iconButton with a text beside the icon where `width` has room for it.
bool toggleButton(const char* id, Icon icon, const char* text, const char* tip, Usable usable, bool isOn, float width);
// With a text beside the icon, in the accent's colour: for the one thing to do first.
bool primaryButton(const char* id, Icon icon, const char* text, const char* tip, bool isEnabled, float width,
                   const ImVec4& color, const ImVec4& textColor);

} // namespace rt::gui
