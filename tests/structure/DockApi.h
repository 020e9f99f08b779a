// What docking adds to Dear ImGui's interface, as far as the windows use it: declared for versions without. What is
// compiled with it is never linked.
#pragma once
#include <imgui.h>
#include <imgui_internal.h>

#ifndef IMGUI_HAS_DOCK
#define IMGUI_HAS_DOCK

using ImGuiDockNodeFlags = int;
inline constexpr ImGuiDockNodeFlags ImGuiDockNodeFlags_PassthruCentralNode = 1 << 3,
                                    ImGuiDockNodeFlags_DockSpace = 1 << 10;
inline constexpr ImGuiWindowFlags ImGuiWindowFlags_NoDocking = 1 << 21;
inline constexpr ImGuiConfigFlags ImGuiConfigFlags_DockingEnable = 1 << 6;
struct ImGuiDockNode {
    ImVec2 Pos, Size;
};

namespace ImGui {
ImGuiID DockSpace(ImGuiID id, const ImVec2& size, ImGuiDockNodeFlags flags);
ImGuiID DockBuilderAddNode(ImGuiID node, ImGuiDockNodeFlags flags);
ImGuiDockNode* DockBuilderGetNode(ImGuiID node);
ImGuiDockNode* DockBuilderGetCentralNode(ImGuiID node);
void DockBuilderSetNodeSize(ImGuiID node, ImVec2 size);
ImGuiID DockBuilderSplitNode(ImGuiID node, ImGuiDir side, float share, ImGuiID* atSide, ImGuiID* rest);
void DockBuilderDockWindow(const char* window, ImGuiID node);
void DockBuilderFinish(ImGuiID node);
} // namespace ImGui

#endif
