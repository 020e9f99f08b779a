#include "Common/Gui/Panels/Panels.h"

namespace rt::gui {
namespace {

bool atTheSide(const app::GuiSettings& settings) {
    return settings.showPanels;
}

constexpr PanelRow kPanels[] = {
    {"scene", "Scene", Panel::Place::Side, true, atTheSide, drawScenePanel},
    {"rendering", "Rendering", Panel::Place::Side, true, atTheSide, drawRenderPanel},
    {"camera", "Camera", Panel::Place::Side, false, atTheSide, drawCameraPanel},
    {"view", "View", Panel::Place::Side, false, atTheSide, drawViewPanel},
    {"file", "File", Panel::Place::Side, false, atTheSide, drawFilePanel},
    {"statistics", "Statistics", Panel::Place::Side, false,
     [](const app::GuiSettings& settings) { return settings.showPanels && settings.showStatistics; },
     drawStatisticsPanel},
    {"settings", "Settings", Panel::Place::Side, false, atTheSide, drawSettingsPanel},
    {"comparison", "Comparison", Panel::Place::Bottom, true,
     [](const app::GuiSettings& settings) { return settings.showComparison; }, drawComparisonPanel},
};

} // namespace

std::span<const PanelRow> panelTable() {
    return kPanels;
}

} // namespace rt::gui
