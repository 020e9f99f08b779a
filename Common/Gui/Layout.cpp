#include "Common/Gui/Layout.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>
#ifdef IMGUI_HAS_DOCK
#include <imgui_internal.h>
#endif

namespace rt::gui {
namespace {

constexpr float kSideWidth = 372;                             // of the fixed layout, at scale 1
constexpr float kBottomShare = 0.4f;                          // of the height; where that is too low
constexpr float kBottomHeight = 21, kMostBottomShare = 0.55f; // in heights of the font, and at most
constexpr float kToolbarPadding = 5;                          // above and below its buttons, at scale 1

bool hasSide(std::span<const Panel> panels) {
    return std::any_of(panels.begin(), panels.end(),
                       [](const Panel& p) { return p.isShown && p.place == Panel::Place::Side; });
}

// The toolbar over the whole width; returns its height, which leaves `room` to what is below.
float drawToolbar(const Edges& edges, float scale, float room) {
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                        ImGuiWindowFlags_NoScrollWithMouse;
    const float padding = std::floor(kToolbarPadding * scale);
    const float height = std::min(ImGui::GetFrameHeight() + 2 * padding, std::max(1.0f, viewport->Size.y - room));
    ImGui::SetNextWindowPos(viewport->Pos);
    ImGui::SetNextWindowSize({viewport->Size.x, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ImGui::GetStyle().WindowPadding.x, padding});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("##toolbar", nullptr, kFlags);
    ImGui::PopStyleVar(2);
    edges.toolbar();
    ImGui::End();
    return height;
}

} // namespace

#ifdef IMGUI_HAS_DOCK

Rect layOut(std::span<const Panel> panels, float scale, const Edges& edges) {
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    const ImGuiID space = ImGui::GetID("space");
    const float statusHeight = ImGui::GetFrameHeight() + 4;
    constexpr float kHeaderHeight = 9.5f; // heights of the font
    if (ImGui::DockBuilderGetNode(space) == nullptr) {
        constexpr int kFlags = static_cast<int>(ImGuiDockNodeFlags_DockSpace) | ImGuiDockNodeFlags_PassthruCentralNode;
        ImGui::DockBuilderAddNode(space, kFlags);
        ImGui::DockBuilderSetNodeSize(space, viewport->Size);
        ImGuiID center = space;
        const float share = std::min(0.45f, kSideWidth * scale / std::max(1.0f, viewport->Size.x));
        ImGuiID side = ImGui::DockBuilderSplitNode(center, ImGuiDir_Left, share, nullptr, &center);
        const ImGuiID bottom = ImGui::DockBuilderSplitNode(center, ImGuiDir_Down, kBottomShare, nullptr, &center);
        const float header = std::min(0.5f, kHeaderHeight * ImGui::GetFontSize() / std::max(1.0f, viewport->Size.y));
        const ImGuiID top = ImGui::DockBuilderSplitNode(side, ImGuiDir_Up, header, nullptr, &side);
        ImGui::DockBuilderDockWindow("Render control", top);
        for (const Panel& panel : panels) {
            ImGui::DockBuilderDockWindow(panel.title, panel.place == Panel::Place::Side ? side : bottom);
        }
        ImGui::DockBuilderFinish(space);
    }
    const float top = drawToolbar(edges, scale, statusHeight + 1);
    ImGui::SetNextWindowPos({viewport->Pos.x, viewport->Pos.y + top});
    ImGui::SetNextWindowSize({viewport->Size.x, std::max(1.0f, viewport->Size.y - top - statusHeight)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::Begin("##space", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoDocking |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNavFocus | ImGuiWindowFlags_NoMove);
    ImGui::PopStyleVar();
    ImGui::DockSpace(space, {0, 0}, ImGuiDockNodeFlags_PassthruCentralNode);
    ImGui::End();
    if (hasSide(panels)) {
        if (ImGui::Begin("Render control")) edges.header();
        ImGui::End();
    }
    for (const Panel& panel : panels) {
        if (!panel.isShown) continue;
        if (panel.reveal || panel.focus) ImGui::SetNextWindowFocus();
        if (ImGui::Begin(panel.title)) panel.draw();
        ImGui::End();
    }
    ImGui::SetNextWindowPos({viewport->Pos.x, viewport->Pos.y + viewport->Size.y - statusHeight});
    ImGui::SetNextWindowSize({viewport->Size.x, statusHeight});
    ImGui::Begin("##status", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoDocking | ImGuiWindowFlags_NoSavedSettings);
    edges.status();
    ImGui::End();
    const ImGuiDockNode* center = ImGui::DockBuilderGetCentralNode(space);
    if (center == nullptr) return {0, top, viewport->Size.x, viewport->Size.y - top - statusHeight};
    return {center->Pos.x - viewport->Pos.x, center->Pos.y - viewport->Pos.y, center->Size.x, center->Size.y};
}

#else

Rect layOut(std::span<const Panel> panels, float scale, const Edges& edges) {
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
    constexpr float kHeaderStays = 20; // heights of the font: in lower windows the header scrolls with the panels
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    const float statusHeight = std::min(ImGui::GetTextLineHeight() + padding.y, viewport->Size.y);
    const float top = drawToolbar(edges, scale, statusHeight + 1);
    const float height = std::max(1.0f, viewport->Size.y - top - statusHeight);
    const float side = hasSide(panels) ? std::min(kSideWidth * scale, 0.6f * viewport->Size.x) : 0.0f;
    Rect rest{side, top, std::max(1.0f, viewport->Size.x - side), height};

    if (side > 0) {
        ImGui::SetNextWindowPos({viewport->Pos.x, viewport->Pos.y + top});
        ImGui::SetNextWindowSize({side, height});
        ImGui::Begin("##side", nullptr, kFixed);
        const bool headerStays = height > kHeaderStays * ImGui::GetFontSize();
        if (headerStays) edges.header();
        if (std::any_of(panels.begin(), panels.end(), [](const Panel& p) { return p.focus; }))
            ImGui::SetNextWindowFocus();
        ImGui::BeginChild("##panels", {0, 0}, false);
        if (!headerStays) edges.header();
        for (const Panel& panel : panels) {
            if (!panel.isShown || panel.place != Panel::Place::Side) continue;
            ImGui::SetNextItemOpen(*panel.isOpen);
            *panel.isOpen = ImGui::CollapsingHeader(panel.title);
            if (panel.reveal) ImGui::SetScrollHereY(0);
            if (*panel.isOpen) {
                ImGui::PushID(panel.title);
                ImGui::Indent(4 * scale);
                panel.draw();
                ImGui::Unindent(4 * scale);
                ImGui::PopID();
                ImGui::Spacing();
            }
        }
        ImGui::EndChild();
        ImGui::End();
    }
    for (const Panel& panel : panels) {
        if (!panel.isShown || panel.place != Panel::Place::Bottom) continue;
        const float low = std::min(kBottomHeight * ImGui::GetFontSize(), kMostBottomShare * height);
        const float share = std::floor(std::max(kBottomShare * height, low));
        rest.height -= share;
        ImGui::SetNextWindowPos({viewport->Pos.x + side, viewport->Pos.y + top + rest.height});
        ImGui::SetNextWindowSize({rest.width, share});
        ImGui::Begin(panel.title, nullptr, kFixed);
        panel.draw();
        ImGui::End();
    }
    ImGui::SetNextWindowPos({viewport->Pos.x, viewport->Pos.y + top + height});
    ImGui::SetNextWindowSize({viewport->Size.x, statusHeight});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {padding.x, 0.5f * padding.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("##status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNav);
    ImGui::PopStyleVar(2);
    edges.status();
    ImGui::End();
    return rest;
}

#endif

} // namespace rt::gui
