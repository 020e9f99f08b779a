#include "Common/Gui/InputQueue.h"

#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace rt::gui {
namespace {

using Kind = InputEvent::Kind;

bool isShift(int key) {
    return key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT;
}

// A key that brings a character, or Shift: to a field of text they are nothing but that character.
bool isOfTyping(const InputEvent& event) {
    constexpr int kCommands = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    const bool isPrinted =
        (event.code >= GLFW_KEY_SPACE && event.code <= GLFW_KEY_WORLD_2) ||
        (event.code >= GLFW_KEY_KP_0 && event.code <= GLFW_KEY_KP_EQUAL && event.code != GLFW_KEY_KP_ENTER) ||
        isShift(event.code);
    return event.kind == Kind::Key && isPrinted && (event.modifiers & kCommands) == 0;
}

bool isOfPointer(const InputEvent& event) {
    return event.kind == Kind::Enter || event.kind == Kind::Move;
}

// Whether a frame that takes `portion` may take `event`, too.
bool joins(const std::vector<InputEvent>& portion, const InputEvent& event, bool isTyping) {
    const InputEvent& last = portion.back();
    switch (event.kind) {
        case Kind::Focus:
            return false;
        case Kind::Enter:
        case Kind::Move:
        case Kind::Button: // where the pointer has got to
            return isOfPointer(last);
        case Kind::Wheel:
            return isOfPointer(last) || last.kind == Kind::Wheel;
        case Kind::Text:
            return last.kind == Kind::Text || isOfTyping(last);
        case Kind::Key:
            return isTyping && isOfTyping(event) && (last.kind == Kind::Text || isOfTyping(last));
    }
    return false;
}

} // namespace

std::vector<InputEvent> InputQueue::take(bool isTyping) {
    std::vector<InputEvent> portion;
    while (!events_.empty() && (portion.empty() || joins(portion, events_.front(), isTyping))) {
        const InputEvent event = events_.front();
        events_.pop_front();
        if (event.kind == Kind::Move && !portion.empty() && portion.back().kind == Kind::Move)
            portion.back() = event; // only where the pointer is counts
        else
            portion.push_back(event);
    }
    return portion;
}

bool InputQueue::mayChangeFocus(const std::vector<InputEvent>& portion) {
    return std::any_of(portion.begin(), portion.end(), [](const InputEvent& event) {
        const bool isCommand = event.kind == Kind::Key && event.isDown && !isOfTyping(event);
        return isCommand || event.kind == Kind::Button || event.kind == Kind::Focus;
    });
}

} // namespace rt::gui
