// Texts that have less room than they need.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace rt::gui {

using TextWidth = std::function<float(const std::string&)>;

// The beginning of a text, ended by dots where it is wider than that; empty where not even dots fit.
std::string elided(const std::string& text, float width, const TextWidth& widthOf);
// A text broken between words into at most so many lines; the last one is ended by dots where there is more.
std::vector<std::string> elidedLines(const std::string& text, float width, std::size_t maximum,
                                     const TextWidth& widthOf);

} // namespace rt::gui
