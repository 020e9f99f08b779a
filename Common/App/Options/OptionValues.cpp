#include "Common/App/Options/OptionValues.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <locale>
#include <sstream>

#include "Common/Core/Error.h"

namespace rt::app {

std::string excerpt(const std::string& text) {
    constexpr std::size_t kMax = 60;
    return text.size() <= kMax ? text : text.substr(0, kMax - 3) + "...";
}

void refuseValue(const std::string& flag, const std::string& text, const std::string& allowed) {
    throw UsageError(flag + " " + (text.empty() ? "''" : excerpt(text)) + ": must be " + allowed);
}

std::string alternatives(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 < names.size() ? ", " : " or ";
        text += names[i];
    }
    return text;
}

std::uint32_t parseWhole(const std::string& flag, const std::string& text, std::uint32_t min, std::uint32_t max) {
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || rest != end || value < min || value > max)
        refuseValue(flag, text, "a whole number from " + std::to_string(min) + " to " + std::to_string(max));
    return value;
}

double parseReal(const std::string& flag, const std::string& text, double min, double max, const std::string& allowed) {
    std::istringstream stream(text); // libc++ has no std::from_chars of real numbers
    stream.imbue(std::locale::classic());
    double value = 0;
    stream >> std::noskipws >> value;
    const bool isNumber = !stream.fail() && stream.peek() == std::istringstream::traits_type::eof();
    if (!isNumber || !std::isfinite(value) || value < min || value > max) refuseValue(flag, text, allowed);
    return value;
}

std::vector<std::string> parseList(const std::string& flag, const std::string& text) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        if (end == begin) refuseValue(flag, text, "a list like a,b,c");
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

} // namespace rt::app
