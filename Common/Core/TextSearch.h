// The search in texts that people type.
#pragma once
#include <string_view>

namespace rt {

// Whether a text contains another one, upper and lower case of ASCII being the same.
bool contains(std::string_view text, std::string_view part);

} // namespace rt
