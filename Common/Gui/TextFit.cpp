#include "Common/Gui/TextFit.h"

#include <algorithm>

namespace rt::gui {

std::string elided(const std::string& text, float width, const TextWidth& widthOf) {
    if (widthOf(text) <= width) return text;
    for (std::size_t end = text.size(); end > 0; --end) {
        const bool isInCharacter = (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80; // of UTF-8
        if (std::string part = text.substr(0, end) + "..."; !isInCharacter && widthOf(part) <= width) return part;
    }
    return "";
}

std::vector<std::string> elidedLines(const std::string& text, float width, std::size_t maximum,
                                     const TextWidth& widthOf) {
    std::vector<std::string> lines;
    std::size_t from = 0;
    while (from < text.size() && lines.size() + 1 < maximum) {
        std::size_t end = text.size(); // of the line: the last space up to which it fits
        while (end > from && end != text.npos && widthOf(text.substr(from, end - from)) > width)
            end = text.rfind(' ', end - 1);
        if (end == text.npos || end <= from) break; // one word is too wide
        lines.push_back(text.substr(from, end - from));
        from = std::min(text.size(), end + 1);
    }
    if (from < text.size()) lines.push_back(elided(text.substr(from), width, widthOf));
    return lines;
}

} // namespace rt::gui
