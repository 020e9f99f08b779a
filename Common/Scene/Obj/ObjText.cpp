#include "Common/Scene/Obj/ObjText.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <locale>
#include <sstream>

#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxObjBytes = std::uint64_t{16} << 30;
constexpr std::uint32_t kReplacement = 0xfffd; // for what is no character

void appendUtf8(std::uint32_t code, std::vector<std::byte>& out) {
    const auto put = [&out](std::uint32_t byte) { out.push_back(static_cast<std::byte>(byte)); };
    const auto putRest = [&](int shift) { put(0x80u | (code >> shift & 0x3fu)); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xc0u | code >> 6);
        putRest(0);
    } else if (code < 0x10000) {
        put(0xe0u | code >> 12);
        putRest(6);
        putRest(0);
    } else {
        put(0xf0u | code >> 18);
        putRest(12);
        putRest(6);
        putRest(0);
    }
}

std::vector<std::byte> fromUtf16(const std::vector<std::byte>& bytes, bool isBigEndian) {
    const auto unit = [&](std::size_t i) {
        const auto first = std::to_integer<std::uint32_t>(bytes[i]),
                   second = std::to_integer<std::uint32_t>(bytes[i + 1]);
        return isBigEndian ? first << 8 | second : second << 8 | first;
    };
    const auto isWithin = [](std::uint32_t code, std::uint32_t first) { return code >= first && code < first + 0x400; };
    std::vector<std::byte> out;
    out.reserve(bytes.size() / 2);
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) { // behind the mark
        std::uint32_t code = unit(i);
        if (isWithin(code, 0xd800) && i + 3 < bytes.size() && isWithin(unit(i + 2), 0xdc00)) {
            code = 0x10000 + ((code - 0xd800) << 10) + (unit(i + 2) - 0xdc00);
            i += 2;
        } else if (isWithin(code, 0xd800) || isWithin(code, 0xdc00)) {
            code = kReplacement;
        }
        appendUtf8(code, out);
    }
    return out;
}

bool isSpace(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}
bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

// A decimal number of usual size by one rounding of its digits and one of their scale; unset: it is not so simple.
std::optional<double> simpleNumber(std::string_view text) {
    constexpr std::uint64_t kFull = 1'000'000'000'000'000'000u; // digits from here on do not count
    constexpr std::array<double, 23> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                                1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    std::size_t i = 0;
    const auto sign = [&] {
        const bool isNegative = i < text.size() && text[i] == '-';
        i += isNegative || (i < text.size() && text[i] == '+');
        return isNegative;
    };
    const bool isNegative = sign();
    std::uint64_t digits = 0;
    std::int64_t exponent = 0;
    bool hasDigits = false;
    const auto take = [&](int scaleOfTaken, int scaleOfOmitted) {
        for (; i < text.size() && isDigit(text[i]); ++i) {
            hasDigits = true;
            const bool isTaken = digits < kFull;
            if (isTaken) digits = 10 * digits + static_cast<std::uint64_t>(text[i] - '0');
            exponent += isTaken ? scaleOfTaken : scaleOfOmitted;
        }
    };
    take(0, 1);
    if (i < text.size() && text[i] == '.') {
        ++i;
        take(-1, 0);
    }
    if (hasDigits && i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
        ++i;
        const bool isDown = sign();
        if (text.size() - i == 0 || text.size() - i > 3) return std::nullopt;
        std::int64_t power = 0;
        for (; i < text.size() && isDigit(text[i]); ++i) power = 10 * power + (text[i] - '0');
        exponent += isDown ? -power : power;
    }
    if (!hasDigits || i < text.size() || exponent < -22 || exponent > 22) return std::nullopt;
    const double scale = kPowers[static_cast<std::size_t>(exponent < 0 ? -exponent : exponent)];
    const double value = exponent < 0 ? static_cast<double>(digits) / scale : static_cast<double>(digits) * scale;
    return isNegative ? -value : value;
}

} // namespace

std::vector<std::byte> readText(const fs::path& path) {
    std::vector<std::byte> bytes = readFile(path, kMaxObjBytes);
    const auto beginsWith = [&bytes](std::initializer_list<std::uint8_t> mark) {
        return bytes.size() >= mark.size() &&
               std::equal(mark.begin(), mark.end(), bytes.begin(),
                          [](std::uint8_t a, std::byte b) { return a == std::to_integer<std::uint8_t>(b); });
    };
    if (beginsWith({0xef, 0xbb, 0xbf})) bytes.erase(bytes.begin(), bytes.begin() + 3);
    if (beginsWith({0xfe, 0xff})) return fromUtf16(bytes, true);
    if (beginsWith({0xff, 0xfe})) return fromUtf16(bytes, false);
    return bytes;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
    while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
    return text;
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

// ---- lines ---------------------------------------------------------------------------------------------------------

// One line of the text, without its end.
std::string_view TextLines::takeLine() {
    std::size_t end = 0;
    while (end < rest_.size() && rest_[end] != '\n' && rest_[end] != '\r') ++end;
    const std::string_view line = trimmed(rest_.substr(0, end));
    const bool isPair = rest_.substr(end, 2) == "\r\n";
    rest_.remove_prefix(std::min(end + (isPair ? 2 : 1), rest_.size()));
    ++taken_;
    return line;
}

bool TextLines::next() {
    const auto goesOn = [](std::string_view said) { return !said.empty() && said.back() == '\\'; };
    while (!rest_.empty()) {
        line_ = source_ = takeLine();
        number_ = taken_;
        if (line_.empty() || line_.front() == '#') continue;
        if (line_.back() != '\\' && line_.find('#') == line_.npos) return true;
        std::string_view said = withoutComment(line_);
        if (!goesOn(said)) return true;
        joined_.clear();
        while (goesOn(said)) {
            joined_.append(said.substr(0, said.size() - 1)) += ' ';
            said = withoutComment(takeLine());
        }
        joined_ += said;
        line_ = trimmed(joined_);
        if (!line_.empty()) return true;
    }
    return false;
}

// ---- words ---------------------------------------------------------------------------------------------------------

std::string_view takeWord(std::string_view& text) {
    std::size_t begin = 0;
    while (begin < text.size() && isSpace(text[begin])) ++begin;
    std::size_t end = begin;
    while (end < text.size() && !isSpace(text[end]) && text[end] != '#') ++end;
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

std::optional<double> numberOf(std::string_view text) {
    if (const std::optional<double> value = simpleNumber(text)) return value;
    if (text.empty() || text.find_first_not_of("+-.0123456789eE") != text.npos) return std::nullopt;
    std::istringstream stream{std::string(text)}; // libc++ has no std::from_chars of real numbers
    stream.imbue(std::locale::classic());
    double value = 0;
    stream >> value;
    if (stream.fail()) return std::abs(value) > 1 ? std::optional(value) : std::nullopt;
    return stream.peek() == std::istringstream::traits_type::eof() ? std::optional(value) : std::nullopt;
}

std::string_view withoutComment(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '#' && (i == 0 || isSpace(text[i - 1]))) return trimmed(text.substr(0, i));
    return text;
}

std::string_view withoutQuotes(std::string_view text) {
    const bool isQuoted =
        text.size() >= 2 && text.front() == text.back() && (text.front() == '"' || text.front() == '\'');
    return isQuoted ? text.substr(1, text.size() - 2) : text;
}

std::string_view nameIn(std::string_view text) {
    text = trimmed(text);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool isApart = (i == 0 || isSpace(text[i - 1])) && (i + 1 == text.size() || isSpace(text[i + 1]));
        if (text[i] == '#' && isApart) text = trimmed(text.substr(0, i));
    }
    return trimmed(withoutQuotes(text));
}

// ---- notices -------------------------------------------------------------------------------------------------------

std::string listed(const std::set<std::string>& names) {
    constexpr std::size_t kMax = 3, kLongest = 100;
    const std::size_t shown = std::min(names.size(), kMax);
    const std::size_t others = names.size() - shown;
    std::string text;
    auto name = names.begin();
    for (std::size_t i = 0; i < shown; ++i, ++name) {
        if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
        text += '"' + printable(*name, kLongest) + '"';
    }
    if (others > 0) text += " and " + std::to_string(others) + (others == 1 ? " other" : " others");
    return text;
}

} // namespace rt::scene
