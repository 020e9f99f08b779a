#include "Common/Gui/Icons.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace rt::gui {
namespace {

constexpr float kIconShare = 0.56f; // of a button's side
constexpr float kPi = 3.14159265f;

// Draws in a square whose sides go from 0 to 1.
class Pen {
  public:
    Pen(ImDrawList& list, ImVec2 corner, float side, ImU32 color)
        : list_(list), corner_(corner), side_(side), color_(color), width_(std::max(1.0f, side / 11)) {}

    void line(std::initializer_list<ImVec2> points, bool isClosed = false) {
        for (const ImVec2& p : points) list_.PathLineTo(at(p));
        list_.PathStroke(color_, isClosed ? ImDrawFlags_Closed : ImDrawFlags_None, width_);
    }
    void fill(std::initializer_list<ImVec2> points) {
        for (const ImVec2& p : points) list_.PathLineTo(at(p));
        list_.PathFillConvex(color_);
    }
    void box(ImVec2 from, ImVec2 to) { list_.AddRectFilled(at(from), at(to), color_); }
    void frame(ImVec2 from, ImVec2 to) { list_.AddRect(at(from), at(to), color_, 0, 0, width_); }
    void disk(ImVec2 middle, float radius) { list_.AddCircleFilled(at(middle), radius * side_, color_); }
    // Angles in turns, clockwise from the right.
    void arc(ImVec2 middle, float radius, float from, float to) {
        list_.PathArcTo(at(middle), radius * side_, 2 * kPi * from, 2 * kPi * to, 24);
        list_.PathStroke(color_, 0, width_);
    }

  private:
    ImVec2 at(ImVec2 p) const { return {corner_.x + p.x * side_, corner_.y + p.y * side_}; }

    ImDrawList& list_;
    ImVec2 corner_;
    float side_;
    ImU32 color_;
    float width_;
};

void drawFolder(Pen& pen) {
    pen.line({{0.05f, 0.85f}, {0.05f, 0.2f}, {0.38f, 0.2f}, {0.48f, 0.32f}, {0.95f, 0.32f}, {0.95f, 0.85f}}, true);
}

void drawLids(Pen& pen) {
    pen.arc({0.5f, 0.78f}, 0.53f, 0.589f, 0.911f);
    pen.arc({0.5f, 0.22f}, 0.53f, 0.089f, 0.411f);
}

// At the left, none at the right.
void drawGrains(Pen& pen) {
    pen.line({{0.06f, 0.06f}, {0.94f, 0.06f}, {0.94f, 0.94f}, {0.06f, 0.94f}}, true);
    pen.line({{0.5f, 0.06f}, {0.5f, 0.94f}});
    for (const ImVec2 grain :
         {ImVec2{0.2f, 0.22f}, ImVec2{0.36f, 0.38f}, ImVec2{0.2f, 0.54f}, ImVec2{0.36f, 0.7f}, ImVec2{0.2f, 0.82f}})
        pen.disk(grain, 0.06f);
}

void drawFlag(Pen& pen) {
    pen.line({{0.14f, 0.04f}, {0.14f, 0.96f}});
    pen.frame({0.14f, 0.1f}, {0.94f, 0.62f});
    pen.box({0.14f, 0.1f}, {0.41f, 0.36f});
    pen.box({0.67f, 0.1f}, {0.94f, 0.36f});
    pen.box({0.41f, 0.36f}, {0.67f, 0.62f});
}

void drawOpenedFolder(Pen& pen) {
    drawFolder(pen);
    pen.line({{0.5f, 0.74f}, {0.5f, 0.44f}});
    pen.line({{0.38f, 0.55f}, {0.5f, 0.43f}, {0.62f, 0.55f}});
}

void drawTray(Pen& pen) {
    pen.line({{0.5f, 0.04f}, {0.5f, 0.62f}});
    pen.line({{0.28f, 0.4f}, {0.5f, 0.64f}, {0.72f, 0.4f}});
    pen.line({{0.08f, 0.62f}, {0.08f, 0.92f}, {0.92f, 0.92f}, {0.92f, 0.62f}});
}

void drawQuestionMark(Pen& pen) {
    pen.arc({0.5f, 0.31f}, 0.24f, 0.5f, 1.12f);
    pen.line({{0.67f, 0.47f}, {0.5f, 0.58f}, {0.5f, 0.7f}});
    pen.disk({0.5f, 0.88f}, 0.075f);
}

void drawWarning(Pen& pen) {
    pen.line({{0.5f, 0.08f}, {0.97f, 0.9f}, {0.03f, 0.9f}}, true);
    pen.line({{0.5f, 0.36f}, {0.5f, 0.62f}});
    pen.disk({0.5f, 0.75f}, 0.06f);
}

} // namespace

void drawIcon(ImDrawList& list, Icon icon, ImVec2 corner, float side, ImU32 color) {
    Pen pen(list, {std::round(corner.x), std::round(corner.y)}, side, color);
    switch (icon) {
        case Icon::Eye:
            drawLids(pen);
            pen.disk({0.5f, 0.5f}, 0.15f);
            break;
        case Icon::ClosedEye:
            drawLids(pen);
            pen.line({{0.15f, 0.88f}, {0.85f, 0.12f}});
            break;
        case Icon::Start:
            pen.fill({{0.18f, 0.06f}, {0.94f, 0.5f}, {0.18f, 0.94f}});
            break;
        case Icon::Pause:
            pen.box({0.16f, 0.08f}, {0.4f, 0.92f});
            pen.box({0.6f, 0.08f}, {0.84f, 0.92f});
            break;
        case Icon::Stop:
            pen.box({0.12f, 0.12f}, {0.88f, 0.88f});
            break;
        case Icon::Restart:
            pen.arc({0.5f, 0.52f}, 0.38f, -0.12f, 0.72f);
            pen.fill({{0.62f, 0.34f}, {0.98f, 0.36f}, {0.9f, 0.02f}});
            break;
        case Icon::Open:
            drawOpenedFolder(pen);
            break;
        case Icon::Save:
            drawTray(pen);
            break;
        case Icon::Denoise:
            drawGrains(pen);
            break;
        case Icon::Split:
            pen.frame({0.06f, 0.14f}, {0.94f, 0.86f});
            pen.box({0.06f, 0.14f}, {0.5f, 0.86f});
            break;
        case Icon::Chart:
            pen.line({{0.08f, 0.04f}, {0.08f, 0.92f}, {0.96f, 0.92f}});
            pen.line({{0.22f, 0.2f}, {0.42f, 0.52f}, {0.62f, 0.66f}, {0.92f, 0.74f}});
            break;
        case Icon::Flag:
            drawFlag(pen);
            break;
        case Icon::Figures:
            pen.box({0.08f, 0.55f}, {0.26f, 0.94f});
            pen.box({0.41f, 0.08f}, {0.59f, 0.94f});
            pen.box({0.74f, 0.34f}, {0.92f, 0.94f});
            break;
        case Icon::Panels:
            pen.frame({0.05f, 0.12f}, {0.95f, 0.88f});
            pen.box({0.05f, 0.12f}, {0.38f, 0.88f});
            break;
        case Icon::Help:
            drawQuestionMark(pen);
            break;
        case Icon::Warning:
            drawWarning(pen);
            break;
        case Icon::Close:
            pen.line({{0.14f, 0.14f}, {0.86f, 0.86f}});
            pen.line({{0.14f, 0.86f}, {0.86f, 0.14f}});
            break;
        case Icon::Folder:
            drawFolder(pen);
            break;
        case Icon::File:
            pen.line({{0.18f, 0.05f}, {0.6f, 0.05f}, {0.84f, 0.3f}, {0.84f, 0.95f}, {0.18f, 0.95f}}, true);
            pen.line({{0.58f, 0.05f}, {0.58f, 0.32f}, {0.84f, 0.32f}});
            break;
        case Icon::Up:
            pen.line({{0.5f, 0.92f}, {0.5f, 0.12f}});
            pen.line({{0.18f, 0.44f}, {0.5f, 0.1f}, {0.82f, 0.44f}});
            break;
    }
}

bool iconButton(const char* id, Icon icon, const char* tip, Usable usable, bool isOn) {
    return toggleButton(id, icon, "", tip, usable, isOn, ImGui::GetFrameHeight());
}

bool toggleButton(const char* id, Icon icon, const char* text, const char* tip, Usable usable, bool isOn, float width) {
    const float side = ImGui::GetFrameHeight(), size = kIconShare * side;
    ImGui::PushID(id);
    if (isOn) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const bool pressed = button("##icon", tip, usable, width);
    if (isOn) ImGui::PopStyleColor();
    ImGui::PopID();
    const ImVec2 corner = ImGui::GetItemRectMin();
    const float margin = 0.5f * (side - size);
    const ImU32 ink = ImGui::GetColorU32(usable.is ? ImGuiCol_Text : ImGuiCol_TextDisabled);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    drawIcon(list, icon, {corner.x + margin, corner.y + margin}, size, ink);
    if (width > 1.5f * side)
        list.AddText({corner.x + side, corner.y + 0.5f * (side - ImGui::GetTextLineHeight())}, ink, text);
    return pressed;
}

bool primaryButton(const char* id, Icon icon, const char* text, const char* tip, bool isEnabled, float width,
                   const ImVec4& color, const ImVec4& textColor) {
    const float side = ImGui::GetFrameHeight(), size = kIconShare * side;
    const auto shaded = [&](float share) { return ImVec4{share * color.x, share * color.y, share * color.z, 1}; };
    ImGui::PushID(id);
    ImGui::PushStyleColor(ImGuiCol_Button, color);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, shaded(0.88f));
    ImGui::PushStyleColor(ImGuiCol_ButtonActive, shaded(0.76f));
    const bool pressed = button("##primary", tip, isEnabled, width);
    ImGui::PopStyleColor(3);
    ImGui::PopID();
    const ImVec2 corner = ImGui::GetItemRectMin();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 ink = ImGui::ColorConvertFloat4ToU32({textColor.x, textColor.y, textColor.z, isEnabled ? 1 : 0.5f});
    const float margin = 0.5f * (side - size);
    const bool hasText = width > 1.5f * side;
    const float left = hasText ? 1.5f * margin : 0.5f * (width - size);
    drawIcon(list, icon, {corner.x + left, corner.y + margin}, size, ink);
    if (hasText) {
        const ImVec2 extent = ImGui::CalcTextSize(text);
        const float from = left + size + margin; // the text is in the middle of what remains
        list.AddText(
            {corner.x + from + 0.5f * (width - from - 1.5f * margin - extent.x), corner.y + 0.5f * (side - extent.y)},
            ink, text);
    }
    return pressed;
}

} // namespace rt::gui
