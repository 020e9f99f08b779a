// Texts that have less room than they need, and the search in them.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace rt::gui {

using TextWidth = std::function<float(const std::string&)>;

// The beginning of a text, ended by dots where it is wider than that; empty where not even dots fit.
std::string elided(const std::string& text, float width, const TextWidth& widthOf);
// A text broken between words into at most so many lines; the last one is ended by dots where there is more.
std::vector<std::string> elidedLines(const std::string& text, float width, std::size_t maximum,
                                     const TextWidth& widthOf);
// Whether a text contains another one, upper and lower case of ASCII being the same.
bool contains(std::string_view text, std::string_view part);

} // namespace rt::gui
