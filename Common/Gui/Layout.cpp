#include "Common/Gui/Layout.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <imgui.h>

#include "Common/Gui/ImGuiLayer.h"

namespace rt::gui {
namespace {

constexpr float kSideWidth = 372;                            // of the fixed layout, at scale 1
constexpr float kBottomShare = 0.4f;                         // of the height; where that is too low
constexpr float kBottomHeight = 21, kMaxBottomShare = 0.55f; // in heights of the font, and at most
constexpr float kToolbarPadding = 5;                         // above and below its buttons, at scale 1
constexpr const char* kHeaderTitle = "Render control";       // of the header's window where windows dock
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

bool hasSide(std::span<const Panel> panels) {
    return std::any_of(panels.begin(), panels.end(),
                       [](const Panel& p) { return p.isShown && p.place == Panel::Place::Side; });
}

// The toolbar over the whole width; returns its height, which leaves `room` to what is below.
float drawToolbar(const Edges& edges, float scale, float room) {
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    const ImGuiWindowFlags flags =
        kFixed | kNeverDocks | ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoScrollWithMouse;
    const float padding = std::floor(kToolbarPadding * scale);
    const float height = std::min(ImGui::GetFrameHeight() + 2 * padding, std::max(1.0f, viewport->Size.y - room));
    ImGui::SetNextWindowPos(viewport->Pos);
    ImGui::SetNextWindowSize({viewport->Size.x, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ImGui::GetStyle().WindowPadding.x, padding});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("##toolbar", nullptr, flags);
    ImGui::PopStyleVar(2);
    edges.toolbar();
    ImGui::End();
    return height;
}

// Of a panel at the bottom: high enough for its contents, and the picture keeps most of the window that is not too low.
float bottomHeight(float height) {
    const float low = std::min(kBottomHeight * ImGui::GetFontSize(), kMaxBottomShare * height);
    return std::floor(std::max(kBottomShare * height, low));
}

void drawStatus(const Edges& edges, const Rect& area) {
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    ImGui::SetNextWindowPos({viewport->Pos.x + area.x, viewport->Pos.y + area.y});
    ImGui::SetNextWindowSize({area.width, area.height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {padding.x, 0.5f * padding.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("##status", nullptr, kFixed | kNeverDocks | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNav);
    ImGui::PopStyleVar(2);
    edges.status();
    ImGui::End();
}

// Windows of their own, in the places that the user has given them.
void drawDocked(std::span<const Panel> panels, const Edges& edges) {
    if (hasSide(panels)) {
        if (ImGui::Begin(kHeaderTitle)) edges.header();
        ImGui::End();
    }
    for (const Panel& panel : panels) {
        if (!panel.isShown) continue;
        if (panel.reveal || panel.focus) ImGui::SetNextWindowFocus();
        if (ImGui::Begin(panel.title)) panel.draw();
        ImGui::End();
    }
}

// As little as that takes; of what is higher than the window its top.
void scrollToSee(float top, float bottom) {
    const float corner = ImGui::GetWindowPos().y, height = ImGui::GetWindowHeight();
    if (bottom <= corner + height) return;
    ImGui::SetScrollFromPosY(std::min(top, bottom - height) - corner, 0);
}

void drawSide(std::span<const Panel> panels, const Rect& area, float scale, const Edges& edges) {
    constexpr float kHeaderStays = 20; // heights of the font: in lower windows the header scrolls with the panels
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    ImGui::SetNextWindowPos({viewport->Pos.x + area.x, viewport->Pos.y + area.y});
    ImGui::SetNextWindowSize({area.width, area.height});
    ImGui::Begin("##side", nullptr, kFixed);
    const bool headerStays = area.height > kHeaderStays * ImGui::GetFontSize();
    if (headerStays) edges.header();
    if (std::any_of(panels.begin(), panels.end(), [](const Panel& p) { return p.focus; })) ImGui::SetNextWindowFocus();
    ImGui::BeginChild("##panels", {0, 0}, false);
    if (!headerStays) edges.header();
    for (const Panel& panel : panels) {
        if (!panel.isShown || panel.place != Panel::Place::Side) continue;
        const float top = ImGui::GetCursorScreenPos().y;
        const bool wasOpen = *panel.isOpen;
        ImGui::SetNextItemOpen(wasOpen);
        *panel.isOpen = ImGui::CollapsingHeader(panel.title);
        if (panel.reveal) ImGui::SetScrollHereY(0);
        if (!*panel.isOpen) continue;
        ImGui::PushID(panel.title);
        ImGui::Indent(4 * scale);
        panel.draw();
        ImGui::Unindent(4 * scale);
        ImGui::PopID();
        ImGui::Spacing();
        if (!wasOpen) scrollToSee(top, ImGui::GetCursorScreenPos().y);
    }
    ImGui::EndChild();
    ImGui::End();
}

// Side by side, where ImGui does not dock; returns what they leave of the area.
Rect drawFixed(std::span<const Panel> panels, const Rect& area, float scale, const Edges& edges) {
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    const float side = hasSide(panels) ? std::min(kSideWidth * scale, 0.6f * area.width) : 0.0f;
    if (side > 0) drawSide(panels, {area.x, area.y, side, area.height}, scale, edges);
    Rect rest{area.x + side, area.y, std::max(1.0f, area.width - side), area.height};
    for (const Panel& panel : panels) {
        if (!panel.isShown || panel.place != Panel::Place::Bottom) continue;
        const float height = bottomHeight(area.height);
        rest.height -= height;
        ImGui::SetNextWindowPos({viewport->Pos.x + rest.x, viewport->Pos.y + rest.y + rest.height});
        ImGui::SetNextWindowSize({rest.width, height});
        ImGui::Begin(panel.title, nullptr, kFixed);
        panel.draw();
        ImGui::End();
    }
    return rest;
}

// How the windows are docked at first: those at the side as tabs, but for the first one, which is always seen.
std::optional<Rect> dock(std::span<const Panel> panels, const Rect& area, float scale) {
    constexpr float kHeaderHeight = 9.5f, kFirstHeight = 11.5f; // heights of the font
    std::vector<DockedWindow> windows{{kHeaderTitle, DockedWindow::Place::Header}};
    DockedWindow::Place side = DockedWindow::Place::First;
    for (const Panel& panel : panels) {
        if (panel.place == Panel::Place::Side)
            windows.push_back({panel.title, std::exchange(side, DockedWindow::Place::Side)});
        else
            windows.push_back({panel.title, DockedWindow::Place::Bottom});
    }
    const auto share = [](float length, float of) { return std::min(0.5f, length / std::max(1.0f, of)); };
    const float header = kHeaderHeight * ImGui::GetFontSize(), first = kFirstHeight * ImGui::GetFontSize();
    return showDockSpace(area,
                         {share(kSideWidth * scale, area.width), share(header, area.height),
                          share(first, area.height - header), bottomHeight(area.height) / std::max(1.0f, area.height)},
                         windows);
}

} // namespace

Rect layOut(std::span<const Panel> panels, float scale, const Edges& edges) {
    const ImVec2 all = ImGui::GetMainViewport()->Size;
    const float statusHeight = std::min(ImGui::GetTextLineHeight() + ImGui::GetStyle().WindowPadding.y, all.y);
    const float top = drawToolbar(edges, scale, statusHeight + 1);
    const Rect area{0, top, all.x, std::max(1.0f, all.y - top - statusHeight)};
    std::optional<Rect> rest = dock(panels, area, scale);
    if (rest)
        drawDocked(panels, edges);
    else
        rest = drawFixed(panels, area, scale, edges);
    drawStatus(edges, {0, area.y + area.height, all.x, statusHeight});
    return *rest;
}

} // namespace rt::gui
