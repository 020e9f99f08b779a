// Over the picture: what it is.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/RunTexts.h"
#include "Common/Gui/Panels/StatusTexts.h"
#include "Common/Gui/Panels/ViewModes.h"
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
    std::vector<std::string> texts = chipTexts(gui.state, gui.isGpu, gui.settings.showPanels);
    if (!gui.viewportName.empty()) // which is never left out
        texts.insert(texts.begin() + 1, elided(gui.viewportName, right - left - 2 * kPadding * em));
    for (std::string& text : texts) {
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
    const image::Image *shown = gui.state.picture.image.get(), *held = gui.pinned.shown().get();
    return held != nullptr && shown != nullptr && shown->width == held->width && shown->height == held->height;
}

// What the sides are, with what differs between them, what is shown of them, and the errors that are known.
std::pair<std::string, std::string> sideTexts(const Gui& gui) {
    const std::optional<app::RunRecord> work = gui.workInView();
    std::string a = "A: " + sideTitle(gui.pinned.title(), gui.pinned.work(), work);
    std::string b = "B: " + sideTitle(gui.pictureTitle(), work, gui.pinned.work());
    if (a.substr(1) == b.substr(1)) a += ", pinned";
    const bool isHalf = gui.viewRequest.mode == app::ViewMode::HalfA || gui.viewRequest.mode == app::ViewMode::HalfB;
    if (gui.viewRequest.mode != app::ViewMode::Picture && !isHalf) { // of halves the titles tell
        const std::string view = std::string(", ") + rowOf(gui.viewRequest.mode).name;
        a += gui.pinned.isSameView() ? view : ", picture (no such view of it)";
        b += view;
    }
    if (gui.pinned.relmse()) a += ", relMSE " + errorText(*gui.pinned.relmse());
    const std::optional<double>& relmse = gui.state.picture.isDenoised ? gui.state.denoisedRelmse : gui.state.relmse;
    if (relmse && !gui.state.curve.empty() && !isHalf) b += ", relMSE " + errorText(*relmse);
    return {std::move(a), std::move(b)};
}

// At the top of the picture, below the chips: at both sides of the line, or below each other.
void drawSides(const Gui& gui, const Rect& area, float imageTop, float chipsBottom, float scale) {
    const float em = ImGui::GetFontSize(), gap = 6 * scale, height = kHeight * em;
    const float y = std::max(imageTop, chipsBottom) + gap, line = area.x + gui.split * area.width;
    const auto [left, right] = sideTexts(gui);
    const float width = chipWidth(left, false), end = area.x + area.width;
    if (y + height > area.y + area.height) return;
    const bool isSplit = gui.compareBy == CompareBy::Split;
    const bool fits = line - gap - width > area.x && line + gap + chipWidth(right, false) < end;
    if (isSplit && fits) {
        drawChip({line - gap - width, y}, left, nullptr);
        return drawChip({line + gap, y}, right, nullptr);
    }
    std::vector<std::string> texts{left, right};
    if (gui.compareBy == CompareBy::Difference) texts.insert(texts.begin(), "B - A, fourfold, about grey");
    const float room = area.width - 2 * gap - 2 * kPadding * em;
    float at = y;
    for (const std::string& text : texts) {
        if (at + height > area.y + area.height) return;
        drawChip({area.x + gap, at}, elided(text, room), nullptr);
        at += height + 0.3f * em;
    }
}

} // namespace

Rect innerArea(const Gui& gui, const Rect& area, float scale) {
    const float border = kBorder * scale;
    const float top = placeChips(gui, area, scale).bottom - area.y + 0.6f * border;
    const Rect inner{area.x + border, area.y + top, area.width - 2 * border, area.height - top - border};
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
