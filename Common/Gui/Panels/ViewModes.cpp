#include "Common/Gui/Panels/ViewModes.h"

#include <algorithm>
#include <iterator>

namespace rt::gui {
namespace {

using app::ViewMode;

constexpr ViewModeRow kModes[] = {
    {"Picture", ViewMode::Picture, "Radiance, with exposure and tone mapping", ""},
    {"Albedo", ViewMode::Albedo, "Colour of the first surface", ""},
    {"Normal", ViewMode::Normal, "Direction of the first surface, as red, green, blue", ""},
    {"Depth", ViewMode::Depth, "Distance to the first surface; near is bright", ""},
    {"Noise", ViewMode::Noise, "Standard error of each pixel relative to its value, after 16 samples", ""},
    {"Error", ViewMode::Error, "Difference from the reference relative to it",
     "It needs a reference: see Comparison (F3)"},
    {"Heat map", ViewMode::Heat, "What each pixel costs, in rays or time, on a logarithmic scale (H)",
     "This engine does not know what a pixel costs"},
};

} // namespace

std::span<const ViewModeRow> viewModes() {
    return kModes;
}

const ViewModeRow& rowOf(ViewMode mode) {
    return *std::find_if(std::begin(kModes), std::end(kModes),
                         [mode](const ViewModeRow& row) { return row.mode == mode; });
}

bool isAvailable(const Gui& gui, ViewMode mode) {
    if (gui.state.picture.isPreview) return mode == ViewMode::Picture;
    if (mode == ViewMode::Error) return gui.state.referenceFits;
    if (mode == ViewMode::Heat) return gui.state.canShowCost;
    return true;
}

} // namespace rt::gui
