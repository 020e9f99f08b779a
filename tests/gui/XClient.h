// What xdotool cannot do: another program that files are dragged from, a window manager's part in minimising, and
// violence.
#pragma once
#include <string>
#include <vector>

namespace rt::test {

// Drops files on a window by the protocol XDND, version 5; whether the window took them.
bool dropFiles(const std::string& display, unsigned long window, const std::vector<std::string>& files);

// As the only window manager of the display.
void setMinimised(const std::string& display, unsigned long window, bool minimised);

void destroyWindow(const std::string& display, unsigned long window);

// Of the screen, as its user has set it: programs that start later see it.
void setDotsPerInch(const std::string& display, int dots);

} // namespace rt::test
