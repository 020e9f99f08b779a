// What the window does about ImGui's own faults.
#include <array>
#include <memory>

#include <gtest/gtest.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_internal.h>

#include "Common/Gui/ImGuiLayer.h"

namespace rt::gui {
namespace {

// Opened at the end of a frame, where nothing draws it any more: Escape before the next frame begins.
TEST(ImGuiLayer, EscapeClosesAPopupThatHasNotBeenDrawn) {
    const auto destroy = [](ImGuiContext* context) { ImGui::DestroyContext(context); };
    const std::unique_ptr<ImGuiContext, decltype(destroy)> context(ImGui::CreateContext(), destroy);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    io.DisplaySize = {200, 200};
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    const auto setEscape = [&io](bool isDown) {
#if IMGUI_VERSION_NUM < 18700
        io.KeyMap[ImGuiKey_Space] = GLFW_KEY_SPACE; // which it asks for
        io.KeyMap[ImGuiKey_Escape] = GLFW_KEY_ESCAPE;
        io.KeysDown[GLFW_KEY_ESCAPE] = isDown;
#else
        io.AddKeyEvent(ImGuiKey_Escape, isDown);
#endif
    };
    const auto frame = [](bool opensPopup) {
        ImGui::NewFrame();
        ImGui::Begin("window");
        if (opensPopup) ImGui::OpenPopup("popup");
        ImGui::End();
        ImGui::Render();
    };
    setEscape(false);
    frame(false);
    frame(true);
    ASSERT_EQ(context->OpenPopupStack.Size, 1);
    ASSERT_EQ(context->OpenPopupStack.back().Window, nullptr);
    const auto press = [](int key) { return std::array{InputEvent{InputEvent::Kind::Key, key, 0, 0, true}}; };
    const auto other = press(GLFW_KEY_A), escape = press(GLFW_KEY_ESCAPE);
    closeUndrawnPopups(other);
    EXPECT_EQ(context->OpenPopupStack.Size, 1);
    closeUndrawnPopups(escape);
    EXPECT_EQ(context->OpenPopupStack.Size, 0);
    setEscape(true);
    frame(false); // without it, the end of the program
}

} // namespace
} // namespace rt::gui
