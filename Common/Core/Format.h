// Text with numbers in it.
#pragma once
#include <cstddef>
#include <cstdio>
#include <string>

namespace rt {

// What std::snprintf makes of the pattern and the values, however long it is.
template <class... Values>
std::string formatted(const char* pattern, Values... values) {
    std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, pattern, values...)), '\0');
    std::snprintf(text.data(), text.size() + 1, pattern, values...);
    return text;
}

} // namespace rt
