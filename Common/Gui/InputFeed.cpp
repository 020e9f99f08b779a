#include "Common/Gui/InputFeed.h"

#include <algorithm>
#include <cfloat>
#include <cstddef>
#include <iterator>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#if __has_include(<backends/imgui_impl_glfw.h>)
#include <backends/imgui_impl_glfw.h>
#else
#include <imgui_impl_glfw.h>
#endif

namespace rt::gui {
namespace {

using Kind = InputEvent::Kind;

// A letter's or digit's key by what is written on it, for commands such as Ctrl+A; of all others by its place.
int labelledKey(const InputEvent& event) {
    if (event.code < GLFW_KEY_APOSTROPHE || event.code > GLFW_KEY_WORLD_2) return event.code;
    const char* name = glfwGetKeyName(event.code, event.scancode);
    if (name == nullptr || name[0] == '\0' || name[1] != '\0') return event.code;
    if (name[0] >= 'a' && name[0] <= 'z') return GLFW_KEY_A + (name[0] - 'a');
    if (name[0] >= '0' && name[0] <= '9') return GLFW_KEY_0 + (name[0] - '0');
    return event.code;
}

#if IMGUI_VERSION_NUM >= 18700

struct KeyPair {
    int glfw;
    ImGuiKey imgui;
};
constexpr KeyPair kKeys[] = {
    {GLFW_KEY_TAB, ImGuiKey_Tab},
    {GLFW_KEY_LEFT, ImGuiKey_LeftArrow},
    {GLFW_KEY_RIGHT, ImGuiKey_RightArrow},
    {GLFW_KEY_UP, ImGuiKey_UpArrow},
    {GLFW_KEY_DOWN, ImGuiKey_DownArrow},
    {GLFW_KEY_PAGE_UP, ImGuiKey_PageUp},
    {GLFW_KEY_PAGE_DOWN, ImGuiKey_PageDown},
    {GLFW_KEY_HOME, ImGuiKey_Home},
    {GLFW_KEY_END, ImGuiKey_End},
    {GLFW_KEY_INSERT, ImGuiKey_Insert},
    {GLFW_KEY_DELETE, ImGuiKey_Delete},
    {GLFW_KEY_BACKSPACE, ImGuiKey_Backspace},
    {GLFW_KEY_SPACE, ImGuiKey_Space},
    {GLFW_KEY_ENTER, ImGuiKey_Enter},
    {GLFW_KEY_ESCAPE, ImGuiKey_Escape},
    {GLFW_KEY_MENU, ImGuiKey_Menu},
    {GLFW_KEY_MINUS, ImGuiKey_Minus},
    {GLFW_KEY_EQUAL, ImGuiKey_Equal},
    {GLFW_KEY_SLASH, ImGuiKey_Slash},
    {GLFW_KEY_KP_ENTER, ImGuiKey_KeypadEnter},
    {GLFW_KEY_KP_ADD, ImGuiKey_KeypadAdd},
    {GLFW_KEY_KP_SUBTRACT, ImGuiKey_KeypadSubtract},
    {GLFW_KEY_LEFT_SHIFT, ImGuiKey_LeftShift},
    {GLFW_KEY_LEFT_CONTROL, ImGuiKey_LeftCtrl},
    {GLFW_KEY_LEFT_ALT, ImGuiKey_LeftAlt},
    {GLFW_KEY_LEFT_SUPER, ImGuiKey_LeftSuper},
    {GLFW_KEY_RIGHT_SHIFT, ImGuiKey_RightShift},
    {GLFW_KEY_RIGHT_CONTROL, ImGuiKey_RightCtrl},
    {GLFW_KEY_RIGHT_ALT, ImGuiKey_RightAlt},
    {GLFW_KEY_RIGHT_SUPER, ImGuiKey_RightSuper},
};

// What ImGui has a use for.
ImGuiKey imguiKey(int key) {
    const auto from = [key](int first, ImGuiKey theirs) {
        return static_cast<ImGuiKey>(static_cast<int>(theirs) + (key - first));
    };
    if (key >= GLFW_KEY_A && key <= GLFW_KEY_Z) return from(GLFW_KEY_A, ImGuiKey_A);
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) return from(GLFW_KEY_0, ImGuiKey_0);
    if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) return from(GLFW_KEY_F1, ImGuiKey_F1);
    const auto* pair =
        std::find_if(std::begin(kKeys), std::end(kKeys), [key](const KeyPair& row) { return row.glfw == key; });
    return pair != std::end(kKeys) ? pair->imgui : ImGuiKey_None;
}

#endif

} // namespace

void InputFeed::feedKey(const InputEvent& event) {
    const int key = labelledKey(event);
    if (key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER)
        modifiers_[static_cast<std::size_t>(key - GLFW_KEY_LEFT_SHIFT)] = event.isDown;
    const bool shift = modifiers_[0] || modifiers_[4], control = modifiers_[1] || modifiers_[5];
    const bool alt = modifiers_[2] || modifiers_[6], super = modifiers_[3] || modifiers_[7];
    ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM < 18700
    if (key >= 0 && key < IM_ARRAYSIZE(io.KeysDown)) io.KeysDown[key] = event.isDown;
    // Enter chooses in a list as Space does, which later versions see to themselves.
    const bool isEnter = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER;
    const bool isInList = !io.WantTextInput && ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    if (isEnter && (isInList || !event.isDown)) io.KeysDown[GLFW_KEY_SPACE] = event.isDown;
    io.KeyShift = shift;
    io.KeyCtrl = control;
    io.KeyAlt = alt;
    io.KeySuper = super;
#else
#if IMGUI_VERSION_NUM < 18900
    constexpr ImGuiKey kShift = ImGuiKey_ModShift, kControl = ImGuiKey_ModCtrl, kAlt = ImGuiKey_ModAlt,
                       kSuper = ImGuiKey_ModSuper;
#else
    constexpr ImGuiKey kShift = ImGuiMod_Shift, kControl = ImGuiMod_Ctrl, kAlt = ImGuiMod_Alt, kSuper = ImGuiMod_Super;
#endif
    io.AddKeyEvent(kShift, shift);
    io.AddKeyEvent(kControl, control);
    io.AddKeyEvent(kAlt, alt);
    io.AddKeyEvent(kSuper, super);
    io.AddKeyEvent(imguiKey(key), event.isDown);
#endif
}

void InputFeed::feedPointer(const InputEvent& event) {
    const bool isHeld = std::find(buttons_.begin(), buttons_.end(), true) != buttons_.end();
    if (event.kind == Kind::Move) pointer_ = {static_cast<float>(event.x), static_cast<float>(event.y)};
    if (event.kind == Kind::Enter && !event.isDown && !isHeld) pointer_ = {-FLT_MAX, -FLT_MAX};
    const bool isButton =
        event.kind == Kind::Button && event.code >= 0 && static_cast<std::size_t>(event.code) < buttons_.size();
    if (isButton) buttons_[static_cast<std::size_t>(event.code)] = event.isDown;
    ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM < 18700
    if (event.kind == Kind::Wheel) {
        io.MouseWheelH += static_cast<float>(event.x);
        io.MouseWheel += static_cast<float>(event.y);
    }
#else
    if (event.kind == Kind::Move || event.kind == Kind::Enter) io.AddMousePosEvent(pointer_.x, pointer_.y);
    if (isButton) io.AddMouseButtonEvent(event.code, event.isDown);
    if (event.kind == Kind::Wheel) io.AddMouseWheelEvent(static_cast<float>(event.x), static_cast<float>(event.y));
#endif
}

void InputFeed::feed(GLFWwindow* window, std::span<const InputEvent> events) {
    ImGuiIO& io = ImGui::GetIO();
    for (const InputEvent& event : events) {
        switch (event.kind) {
            case Kind::Focus:
                io.AddFocusEvent(event.isDown);
                break;
            case Kind::Text:
                io.AddInputCharacter(static_cast<unsigned>(event.code));
                break;
            case Kind::Key:
                feedKey(event);
                break;
            case Kind::Enter: // by which the backend knows whether there is a pointer to ask for
                ImGui_ImplGlfw_CursorEnterCallback(window, event.isDown ? GLFW_TRUE : GLFW_FALSE);
                feedPointer(event);
                break;
            default:
                feedPointer(event);
        }
    }
#if IMGUI_VERSION_NUM < 18700
    // The backend has asked the window system, which may know of more than this frame is to see.
    io.MousePos = pointer_;
    std::copy(buttons_.begin(), buttons_.end(), std::begin(io.MouseDown));
#endif
}

} // namespace rt::gui
