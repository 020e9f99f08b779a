#include "Common/Gui/Theme.h"

#include <iterator>

#include <imgui.h>

namespace rt::gui {
namespace {

// Of which every colour of a mode is made.
struct Palette {
    ImVec4 text, dim, window, field, line, accent, accentText, error, notice;
};

const Palette kDark{{0.90f, 0.91f, 0.92f, 1},
                    {0.58f, 0.60f, 0.64f, 1},
                    {0.105f, 0.11f, 0.125f, 1},
                    {0.185f, 0.195f, 0.22f, 1},
                    {0.28f, 0.29f, 0.33f, 1},
                    {0.27f, 0.53f, 0.88f, 1},
                    {1, 1, 1, 1},
                    {0.95f, 0.38f, 0.33f, 1},
                    {0.90f, 0.62f, 0.10f, 1}};
const Palette kLight{{0.10f, 0.11f, 0.13f, 1},
                     {0.42f, 0.44f, 0.48f, 1},
                     {0.955f, 0.96f, 0.965f, 1},
                     {0.87f, 0.88f, 0.895f, 1},
                     {0.74f, 0.76f, 0.79f, 1},
                     {0.16f, 0.44f, 0.83f, 1},
                     {1, 1, 1, 1},
                     {0.70f, 0.10f, 0.08f, 1},
                     {0.52f, 0.33f, 0, 1}};
const Palette kHighContrast{{1, 1, 1, 1},          {0.86f, 0.86f, 0.86f, 1}, {0, 0, 0, 1}, {0.10f, 0.10f, 0.10f, 1},
                            {1, 1, 1, 1},          {1.0f, 0.85f, 0.0f, 1},   {0, 0, 0, 1}, {1.0f, 0.5f, 0.45f, 1},
                            {1.0f, 0.85f, 0.0f, 1}};

const Palette& palette(app::ColorMode mode) {
    switch (mode) {
        case app::ColorMode::Light:
            return kLight;
        case app::ColorMode::HighContrast:
            return kHighContrast;
        case app::ColorMode::Dark:
            break;
    }
    return kDark;
}

ImVec4 blend(const ImVec4& a, const ImVec4& b, float t) {
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z), 1};
}
ImVec4 faded(const ImVec4& c, float alpha) {
    return {c.x, c.y, c.z, alpha};
}

} // namespace

void applyTheme(ImGuiStyle& style, app::ColorMode mode) {
    const Palette& p = palette(mode);
    const bool contrast = mode == app::ColorMode::HighContrast;
    mode == app::ColorMode::Light ? ImGui::StyleColorsLight(&style) : ImGui::StyleColorsDark(&style);

    style.WindowPadding = {10, 10};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {6, 4};
    style.ScrollbarSize = 12;
    style.GrabMinSize = 10;
    style.WindowRounding = 0;
    style.ChildRounding = 4;
    style.FrameRounding = 4;
    style.PopupRounding = 4;
    style.GrabRounding = 4;
    style.ScrollbarRounding = 6;
    style.WindowBorderSize = 1;
    style.FrameBorderSize = contrast ? 1.0f : 0.0f;

    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = p.text;
    c[ImGuiCol_TextDisabled] = p.dim;
    c[ImGuiCol_WindowBg] = p.window;
    c[ImGuiCol_ChildBg] = {0, 0, 0, 0};
    c[ImGuiCol_PopupBg] = blend(p.window, p.field, 0.5f);
    c[ImGuiCol_Border] = contrast ? p.line : faded(p.line, 0.6f);
    c[ImGuiCol_FrameBg] = p.field;
    c[ImGuiCol_FrameBgHovered] = blend(p.field, p.accent, 0.25f);
    c[ImGuiCol_FrameBgActive] = blend(p.field, p.accent, 0.4f);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = blend(p.window, p.field, 0.6f);
    c[ImGuiCol_MenuBarBg] = p.window;
    c[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
    c[ImGuiCol_ScrollbarGrab] = p.line;
    c[ImGuiCol_ScrollbarGrabHovered] = blend(p.line, p.accent, 0.4f);
    c[ImGuiCol_ScrollbarGrabActive] = p.accent;
    c[ImGuiCol_CheckMark] = p.accent;
    c[ImGuiCol_Button] = blend(p.field, p.line, 0.35f);
    c[ImGuiCol_ButtonHovered] = contrast ? blend(p.window, p.accent, 0.5f) : blend(p.field, p.accent, 0.55f);
    c[ImGuiCol_ButtonActive] = contrast ? blend(p.window, p.accent, 0.65f) : blend(p.field, p.accent, 0.8f);
    c[ImGuiCol_Header] = blend(p.window, p.field, 0.9f);
    c[ImGuiCol_HeaderHovered] = blend(p.field, p.accent, 0.35f);
    c[ImGuiCol_HeaderActive] = blend(p.field, p.accent, 0.5f);
    c[ImGuiCol_Separator] = faded(p.line, 0.7f);
    // Text is drawn over these.
    c[ImGuiCol_PlotHistogram] = contrast                        ? ImVec4{0.0f, 0.33f, 0.72f, 1}
                                : mode == app::ColorMode::Light ? blend(p.accent, p.window, 0.5f)
                                                                : blend(p.accent, p.window, 0.3f);
    c[ImGuiCol_SliderGrab] = c[ImGuiCol_PlotHistogram];
    c[ImGuiCol_SliderGrabActive] = blend(p.window, p.accent, 0.15f);
    // Of docked windows; those without the keyboard are "unfocused".
    c[ImGuiCol_Tab] = c[ImGuiCol_TabUnfocused] = blend(p.window, p.field, 0.8f);
    c[ImGuiCol_TabHovered] = blend(p.field, p.accent, 0.5f);
    c[ImGuiCol_TabActive] = c[ImGuiCol_PlotHistogram];
    c[ImGuiCol_TabUnfocusedActive] = blend(p.field, p.accent, 0.3f);
    c[ImGuiCol_PlotLines] = p.accent;
    c[ImGuiCol_TableHeaderBg] = blend(p.window, p.field, 0.8f);
    c[ImGuiCol_TableBorderStrong] = c[ImGuiCol_TableBorderLight] = faded(p.line, 0.6f);
    c[ImGuiCol_TableRowBgAlt] = faded(p.field, 0.4f);
    c[ImGuiCol_TextSelectedBg] = faded(p.accent, 0.45f);
    c[ImGuiCol_NavHighlight] = p.accent;
    c[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.5f};
}

ImVec4 errorColor(app::ColorMode mode) {
    return palette(mode).error;
}
ImVec4 noticeColor(app::ColorMode mode) {
    return palette(mode).notice;
}

ImVec4 accentColor(app::ColorMode mode) {
    return palette(mode).accent;
}
ImVec4 accentTextColor(app::ColorMode mode) {
    return palette(mode).accentText;
}

ImVec4 engineColor(bool isGpu, app::ColorMode mode) {
    if (mode == app::ColorMode::Light) return isGpu ? ImVec4{0, 0.45f, 0.70f, 1} : ImVec4{0.72f, 0.42f, 0, 1};
    return isGpu ? ImVec4{0.34f, 0.71f, 0.91f, 1} : ImVec4{0.90f, 0.62f, 0, 1};
}

ImVec4 axisColor(int axis) {
    switch (axis) {
        case 0:
            return {1.0f, 0.42f, 0.42f, 1};
        case 1:
            return {0.56f, 0.88f, 0.30f, 1};
        case 2:
            return {0.45f, 0.70f, 1.0f, 1};
        default:
            return {0.95f, 0.95f, 0.95f, 1};
    }
}

ImVec4 entrantColor(std::size_t entrant, app::ColorMode mode) {
    static const ImVec4 kOnDark[] = {
        {0.90f, 0.62f, 0, 1}, {0.34f, 0.71f, 0.91f, 1}, {0, 0.72f, 0.53f, 1}, {0.90f, 0.56f, 0.74f, 1}};
    static const ImVec4 kOnLight[] = {
        {0.72f, 0.42f, 0, 1}, {0, 0.45f, 0.70f, 1}, {0, 0.47f, 0.34f, 1}, {0.66f, 0.27f, 0.49f, 1}};
    return (mode == app::ColorMode::Light ? kOnLight : kOnDark)[entrant % std::size(kOnDark)];
}

Rgb surroundColor(app::ColorMode mode) {
    switch (mode) {
        case app::ColorMode::Light:
            return {0.78f, 0.78f, 0.78f};
        case app::ColorMode::HighContrast:
            return {0, 0, 0};
        case app::ColorMode::Dark:
            break;
    }
    return {0.17f, 0.17f, 0.17f};
}

} // namespace rt::gui
