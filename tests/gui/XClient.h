// What xdotool cannot do, or not as quickly: another program that files are dragged from, a window manager's part in
// minimising, violence, and a look at the title.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace rt::test {

// Drops files on a window by the protocol XDND, version 5; whether the window took them.
bool dropFiles(const std::string& display, unsigned long window, const std::vector<std::string>& files, int x, int y);

// As the only window manager of the display.
void setMinimised(const std::string& display, unsigned long window, bool minimised);

// As another program on its part of the screen, from the upper left corner; what is painted there lasts until the
// window draws. exposeWindow() asks it to, as the server does after another window has hidden it.
void paintOver(const std::string& display, unsigned long window, unsigned side, std::uint32_t color);
void exposeWindow(const std::string& display, unsigned long window);

void destroyWindow(const std::string& display, unsigned long window);

// Empty where there is no such window. Asked again and again, a process each time would cost more than what is awaited.
std::string windowTitle(const std::string& display, unsigned long window);

// Of the screen, as its user has set it: programs that start later see it.
void setDotsPerInch(const std::string& display, int dots);

} // namespace rt::test
