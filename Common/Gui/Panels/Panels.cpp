#include "Common/Gui/Panels/Panels.h"

namespace rt::gui {
namespace {

#define RT_ROW(Name, id, title, place, opensAtFirst, isShown)          \
    {id,                                                               \
     title,                                                            \
     Panel::Place::place,                                              \
     opensAtFirst,                                                     \
     [](const app::GuiSettings& settings) -> bool { return isShown; }, \
     draw##Name##Panel},
constexpr PanelRow kPanels[] = {RT_PANELS(RT_ROW)};
#undef RT_ROW

} // namespace

std::span<const PanelRow> panelTable() {
    return kPanels;
}

} // namespace rt::gui
