// Finds texts of the interface on the screen, so that tests need no places of the layout.
#pragma once
#include <string>
#include <vector>

#include "tests/gui/Framebuffer.h"

namespace rt::test {

// In pixels of the screen; right and bottom are beyond it.
struct Place {
    int left = 0, top = 0, right = 1 << 20, bottom = 1 << 20;

    int x() const { return (left + right) / 2; }
    int y() const { return (top + bottom) / 2; }
};

// Where a text stands in full, from the top, then from the left: in the interface's own font at scale 1, in any colour
// on any ground that is even. A longer text that begins with this one counts, too.
std::vector<Place> findText(const Screenshot& shot, const std::string& text, const Place& within = {});

} // namespace rt::test
