// Where the parts of the interface are.
#pragma once
#include <functional>
#include <span>

namespace rt::gui {

// A part of the interface. Docked where ImGui docks, else at a fixed place.
struct Panel {
    enum class Place { Side, Bottom };
    const char* title;
    Place place;
    bool isShown;
    bool* isOpen; // of those at the side where ImGui does not dock: folded out
    std::function<void()> draw;
    bool reveal = false; // brings it to where it is seen
    bool focus = false;  // the keyboard goes to it, or to all of the side
};

struct Rect {
    float x = 0, y = 0, width = 0, height = 0;
    bool contains(float px, float py) const { return px >= x && py >= y && px < x + width && py < y + height; }
};

// What is no panel, and drawn where it belongs.
struct Edges {
    std::function<void()> toolbar; // a line at the window's top
    std::function<void()> header;  // above the panels of the side
    std::function<void()> status;  // a line at the window's bottom
};

// Shows the panels of a frame, of which all that there may be are given; returns the rest of the window, in its units.
// `scale` is that of the interface.
Rect layOut(std::span<const Panel> panels, float scale, const Edges& edges);

} // namespace rt::gui
