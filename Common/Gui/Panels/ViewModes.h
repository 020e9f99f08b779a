// What can be shown instead of the picture: rows of the toolbar.
#pragma once
#include <span>

#include "Common/Gui/Gui.h"

namespace rt::gui {

struct ViewModeRow {
    const char* name;
    app::ViewMode mode;
    const char* tip;
    const char* missing; // why it cannot be shown, where it cannot
    bool isOfDenoiser = false;
};
std::span<const ViewModeRow> viewModes();
const ViewModeRow& rowOf(app::ViewMode mode);
bool isAvailable(const Gui& gui, app::ViewMode mode);

} // namespace rt::gui
