// How viewports share the picture's part of the window: side by side, or two rows of two.
#pragma once
#include <cstddef>
#include <vector>

#include "Common/Gui/Layout.h"

namespace rt::gui {

// Where they meet, as shares of the part's width and height.
struct Splits {
    float x = 0.5f, y = 0.5f;
};

// Of 1, 2 or 4 viewports, row after row, with gaps in between; in whole units of the window.
std::vector<Rect> splitAreas(const Rect& all, std::size_t count, const Splits& splits, float gap);

// A gap that can be dragged, or both where they cross.
struct Splitter {
    bool isX = false, isY = false; // it moves the split of width, of height
    explicit operator bool() const { return isX || isY; }
    bool operator==(const Splitter&) const = default;
};
Splitter splitterAt(const Rect& all, std::size_t count, const Splits& splits, float gap, float x, float y);

// A splitter at that place leaves some of the part to each viewport.
Splits movedTo(const Splits& splits, const Splitter& splitter, const Rect& all, float x, float y);

} // namespace rt::gui
