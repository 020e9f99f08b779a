// Text of others, as names in files and of devices, where people read it.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace rt {

inline constexpr std::size_t kMessageBytes = 1000;

// On one line, without anything that a terminal takes for a command or that hides how the text goes on: control
// characters, marks of direction and line ends of Unicode, and bytes that are not UTF-8 become \n, \t, \u{202e} or
// \xff. Of more than `most` bytes the middle is left out.
std::string printable(std::string_view text, std::size_t maximum = kMessageBytes);

} // namespace rt
