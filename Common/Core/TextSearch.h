// Texts in which upper and lower case of ASCII are the same.
#pragma once
#include <string>
#include <string_view>

namespace rt {

std::string lowerCase(std::string text);

// Whether a text contains another one.
bool contains(std::string_view text, std::string_view part);

} // namespace rt
