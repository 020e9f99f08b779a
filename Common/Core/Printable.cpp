#include "Common/Core/Printable.h"

#include <cstdint>
#include <optional>

#include "Common/Core/Format.h"

namespace rt {

namespace {

bool isContinuation(char byte) {
    return (static_cast<unsigned char>(byte) & 0xc0) == 0x80;
}

struct Character {
    std::uint32_t code;
    std::size_t bytes;
};

// The character that a text begins with, if that is valid UTF-8 (RFC 3629, section 4).
std::optional<Character> firstCharacter(std::string_view text) {
    constexpr std::uint32_t kMin[] = {0, 0, 0x80, 0x800, 0x10000}; // by length: what is less has a shorter form
    const auto lead = static_cast<unsigned char>(text.front());
    if (lead < 0x80) return Character{lead, 1};
    const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return std::nullopt;
    std::uint32_t code = lead & (0x7fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if (!isContinuation(text[i])) return std::nullopt;
        code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3fu);
    }
    const bool isSurrogate = code >= 0xd800 && code <= 0xdfff;
    if (code < kMin[bytes] || code > 0x10ffff || isSurrogate) return std::nullopt;
    return Character{code, bytes};
}

bool isWithin(std::uint32_t code, std::uint32_t first, std::uint32_t last) {
    return code >= first && code <= last;
}

// Controls (C0, DEL, C1); marks, separators and overrides of direction; invisible operators; the byte order mark.
bool isHidden(std::uint32_t code) {
    return code < 0x20 || isWithin(code, 0x7f, 0x9f) || isWithin(code, 0x200b, 0x200f) ||
           isWithin(code, 0x2028, 0x202e) || isWithin(code, 0x2060, 0x206f) || code == 0x61c || code == 0xfeff;
}

std::string escaped(const char* format, std::uint32_t value) {
    return formatted(format, static_cast<unsigned>(value));
}

std::string escapedCharacter(std::uint32_t code) {
    if (code == '\n') return "\\n";
    if (code == '\t') return "\\t";
    return escaped(code < 0x80 ? "\\x%02x" : "\\u{%x}", code);
}

void append(std::string& result, std::string_view text) {
    while (!text.empty()) {
        const std::optional<Character> character = firstCharacter(text);
        const std::size_t bytes = character ? character->bytes : 1;
        if (!character)
            result += escaped("\\x%02x", static_cast<unsigned char>(text.front()));
        else if (isHidden(character->code))
            result += escapedCharacter(character->code);
        else
            result += text.substr(0, bytes);
        text.remove_prefix(bytes);
    }
}

} // namespace

std::string printable(std::string_view text, std::size_t maximum) {
    std::string result;
    if (text.size() <= maximum) {
        append(result, text);
        return result;
    }
    // Between characters. Where a text begins says most; its end tells what is allowed.
    std::size_t headEnd = maximum / 3 * 2;
    while (headEnd > 0 && isContinuation(text[headEnd])) --headEnd;
    std::size_t tailStart = text.size() - maximum / 3;
    while (tailStart < text.size() && isContinuation(text[tailStart])) ++tailStart;
    append(result, text.substr(0, headEnd));
    result += " [" + std::to_string(tailStart - headEnd) + " bytes more] ";
    append(result, text.substr(tailStart));
    return result;
}

} // namespace rt
