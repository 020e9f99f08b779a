// Hands events to ImGui, whose versions take them in different ways.
#pragma once
#include <array>
#include <span>

#include <imgui.h>

#include "Common/Gui/InputQueue.h"

struct GLFWwindow;

namespace rt::gui {

class InputFeed {
  public:
    // Between the backend's part of a new frame, which may have asked for the state of this moment, and ImGui's.
    void feed(GLFWwindow* window, std::span<const InputEvent> events);

  private:
    void feedKey(const InputEvent& event);
    void feedPointer(const InputEvent& event);

    ImVec2 pointer_{-1e9f, -1e9f}; // outside of the window
    std::array<bool, 5> buttons_{};
    std::array<bool, 8> modifiers_{}; // left Ctrl, Shift, Alt, Super and right ones, as GLFW orders them
};

} // namespace rt::gui
