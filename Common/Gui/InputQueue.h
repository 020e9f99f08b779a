// What the window system has told of keyboard and mouse, in order, until a frame of the interface takes it. ImGui knows
// one state of each key a frame, and reads characters before keys: what a slow frame has kept waiting is handed out in
// portions that one frame can take without losing or reordering any of it.
#pragma once
#include <deque>
#include <vector>

namespace rt::gui {

struct InputEvent {
    enum class Kind { Focus, Enter, Move, Button, Wheel, Key, Text };
    Kind kind = Kind::Move;
    int code = 0;        // of the button or key, as GLFW numbers them; the character
    int scancode = 0;    // of the key
    int modifiers = 0;   // of the button or key, as GLFW has them
    bool isDown = false; // button or key; the window has the focus, the pointer is in it
    double x = 0, y = 0; // of the pointer, in the window's units; of the wheel
    bool operator==(const InputEvent&) const = default;
};

class InputQueue {
  public:
    void push(const InputEvent& event) { events_.push_back(event); }
    bool isEmpty() const { return events_.empty(); }

    // What the next frame takes. `isTyping`: a field of text has the keyboard, so that a whole run of characters goes
    // there at once.
    std::vector<InputEvent> take(bool isTyping);
    // Whether the interface needs frames to answer such a portion, before it can be given the next one: a field gets
    // the keyboard, a window opens.
    static bool mayChangeFocus(const std::vector<InputEvent>& portion);

  private:
    std::deque<InputEvent> events_;
};

} // namespace rt::gui
