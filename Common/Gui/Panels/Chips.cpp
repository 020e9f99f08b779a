// Over the picture: what it is.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/StatusTexts.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr float kHeight = 1.5f;    // of a chip, in heights of the font
constexpr float kPadding = 0.5f;   // likewise, at its left and right
constexpr float kBorder = 10;      // around the picture, at scale 1
constexpr float kMinShare = 0.55f; // of the window's part that remains for the picture, or it gets all of it

float chipWidth(const std::string& text, bool hasDot) {
    const float em = ImGui::GetFontSize();
    return ImGui::CalcTextSize(text.c_str()).x + (2 * kPadding + (hasDot ? 1 : 0)) * em;
}

void drawChip(ImVec2 corner, const std::string& text, const ImVec4* dot) {
    const float em = ImGui::GetFontSize(), height = kHeight * em, width = chipWidth(text, dot != nullptr);
    ImDrawList& list = *ImGui::GetBackgroundDrawList(); // below all windows
    list.AddRectFilled(corner, {corner.x + width, corner.y + height}, ImGui::GetColorU32(ImGuiCol_WindowBg, 0.92f),
                       0.5f * height);
    list.AddRect(corner, {corner.x + width, corner.y + height}, ImGui::GetColorU32(ImGuiCol_Border), 0.5f * height);
    float left = corner.x + kPadding * em;
    if (dot != nullptr) {
        list.AddCircleFilled({left + 0.3f * em, corner.y + 0.5f * height}, 0.3f * em,
                             ImGui::ColorConvertFloat4ToU32(*dot));
        left += em;
    }
    list.AddText({left, corner.y + 0.5f * (height - ImGui::GetTextLineHeight())}, ImGui::GetColorU32(ImGuiCol_Text),
                 text.c_str());
}

struct Chip {
    std::string text;
    ImVec2 corner;
};
struct ChipLayout {
    std::vector<Chip> chips;
    float bottom = 0;
};

// From left to right, in as many lines as they need; what is wider than a line is left out.
ChipLayout placeChips(const Gui& gui, const Rect& area, float scale) {
    const float em = ImGui::GetFontSize(), border = kBorder * scale, gap = 0.4f * em;
    const float left = area.x + border, right = area.x + area.width - border;
    ChipLayout layout;
    ImVec2 at{left, area.y + border};
    for (std::string& text : chipTexts(gui.state, gui.isGpu, gui.settings.showPanels)) {
        const float width = chipWidth(text, layout.chips.empty());
        if (left + width > right) continue;
        if (at.x + width > right) at = {left, at.y + kHeight * em + gap};
        layout.chips.push_back({std::move(text), at});
        at.x += width + gap;
    }
    layout.bottom = at.y + kHeight * em;
    return layout;
}

// Whether both can be compared: the line between them is drawn.
bool isSplit(const Gui& gui) {
    const image::Image* shown = gui.state.picture.image.get();
    return gui.held && shown != nullptr && shown->width == gui.held->width && shown->height == gui.held->height;
}

// At the top of the picture, below the chips.
void drawSides(const Gui& gui, const Rect& area, float imageTop, float chipsBottom, float scale) {
    const float em = ImGui::GetFontSize(), gap = 6 * scale;
    const float y = std::max(imageTop, chipsBottom) + gap, line = area.x + gui.split * area.width;
    const std::string left = "A: " + gui.heldTitle, right = "B: " + gui.pictureTitle();
    const float width = chipWidth(left, false);
    if (y + kHeight * em > area.y + area.height) return;
    if (line - gap - width > area.x) drawChip({line - gap - width, y}, left, nullptr);
    if (line + gap + chipWidth(right, false) < area.x + area.width) drawChip({line + gap, y}, right, nullptr);
}

} // namespace

Rect innerArea(const Gui& gui, const Rect& area, float scale) {
    const float border = kBorder * scale, legend = legendHeight(gui, area, scale);
    const float top = placeChips(gui, area, scale).bottom - area.y + 0.6f * border;
    const float bottom = border + (legend > 0 ? legend + border : 0);
    const Rect inner{area.x + border, area.y + top, area.width - 2 * border, area.height - top - bottom};
    const bool isEnough = inner.width > kMinShare * area.width && inner.height > kMinShare * area.height;
    return isEnough ? inner : area;
}

void drawChips(const Gui& gui, const Rect& area, const Rect& image, float scale) {
    if (!gui.state.picture.image || area.height < 4 * kHeight * ImGui::GetFontSize()) return;
    const ImVec4 dot = engineColor(gui.isGpu, gui.settings.colorMode);
    const ChipLayout layout = placeChips(gui, area, scale);
    for (std::size_t i = 0; i < layout.chips.size(); ++i)
        drawChip(layout.chips[i].corner, layout.chips[i].text, i == 0 ? &dot : nullptr);
    if (isSplit(gui)) drawSides(gui, area, image.y, layout.bottom, scale);
}

} // namespace rt::gui
