// A pixel that the user picks in the picture, which stays as it was seen then while the camera moves: its mark is
// dragged to another one.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <glm/vec3.hpp>
#include <imgui.h>

#include "Common/Gui/Layout.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::gui {

struct Gui;

// A pixel, and where it was seen from: the direction to the camera is part of the question.
struct PickedPixel {
    scene::CameraDesc camera;
    std::array<std::uint32_t, 2> pixel{}, size{};
    std::string source;      // of the scene
    std::uint64_t reads = 0; // of the scene: SessionState::sceneReads
};

struct PointPicker {
    std::optional<PickedPixel> point;
    bool isPicking = false; // the next click in the picture tells
    bool isDragged = false;
    bool isShown = false; // the panel, in this frame
};

// Each frame, before anything is drawn; whether the panel was shown in the frame before.
bool followPicker(const Gui& gui, PointPicker& picker);
// The panel's button that begins or ends picking.
void drawPickButton(PointPicker& picker, const char* label, float width);
// Where a place in the world is seen now.
std::optional<ImVec2> placeInWindow(const Gui& gui, const glm::dvec3& place, const Rect& image);
// Whether the pointer, over `pixel` of the picture, if any, is taken by the point, whose mark is there.
bool holdPoint(Gui& gui, PointPicker& picker, const std::optional<ImVec2>& mark, bool isInside,
               const std::optional<std::array<std::uint32_t, 2>>& pixel);
void drawPointMark(const ImVec2& mark, const Rect& area, ImU32 color);

} // namespace rt::gui
