#include "Common/Scene/Obj/ObjText.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <system_error>

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

fs::path portable(std::string_view name) {
    std::string path(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    return path;
}

// Statements that the parser passes over.
struct LeftOut {
    const char* keyword;
    const char* name;
    std::size_t count = 0;
};
using LeftOuts = std::array<LeftOut, 5>;
LeftOuts countLeftOut(std::string_view text) {
    LeftOuts kinds{{{"l", "lines"},
                    {"p", "points"},
                    {"curv", "curves"},
                    {"surf", "free-form surfaces"},
                    {"f", "faces without corners"}}};
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::string_view keyword = line.substr(0, line.find_first_of(" \t"));
        for (LeftOut& kind : kinds) kind.count += keyword == kind.keyword && (keyword != "f" || keyword == line);
    }
    return kinds;
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
    constexpr std::string_view kSpace = " \t\r";
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    return text.substr(0, text.find_last_not_of(kSpace) + 1);
}

fs::path findNamed(std::string_view name, const fs::path& folder) {
    const fs::path path = folder / portable(name);
    std::error_code ignored;
    return fs::is_regular_file(path, ignored) ? path : fs::path();
}

fs::path findMoved(std::string_view name, const fs::path& folder) {
    const fs::path path = findNamed(name, folder);
    return path.empty() ? findNamed(portable(name).filename().string(), folder) : path;
}

std::size_t countWords(std::string_view line) {
    std::size_t count = 0;
    for (std::string_view rest = trimmed(line.substr(0, line.find_first_of("\r\n"))); !rest.empty(); ++count)
        rest = trimmed(rest.substr(std::min(rest.find_first_of(" \t"), rest.size())));
    return count;
}

std::string describeLeftOut(std::string_view text) {
    std::string described;
    for (const LeftOut& kind : countLeftOut(text))
        if (kind.count > 0) described += (described.empty() ? "" : ", ") + std::to_string(kind.count) + " " + kind.name;
    return described;
}

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
