#include "Common/Scene/Gltf/GltfUri.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <system_error>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Core/TextSearch.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

// "%20" is a space. Everything else stands for itself: "+", and "%" before anything but two digits.
std::string withoutEscapes(std::string_view uri) {
    std::string text;
    text.reserve(uri.size());
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool isEscape =
            uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 && hexDigit(uri[i + 2]) >= 0;
        text += isEscape ? static_cast<char>(16 * hexDigit(uri[i + 1]) + hexDigit(uri[i + 2])) : uri[i];
        if (isEscape) i += 2;
    }
    return text;
}

// Spaces and line ends count for nothing, and neither does what follows the first "=".
std::vector<std::byte> fromBase64(std::string_view text, const JsonNode& uri) {
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t word = 0;
    int bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        if (std::isspace(static_cast<unsigned char>(c))) continue;
        const int digit = base64Digit(c);
        if (digit < 0) uri.fail("the data are no base64: there is a \"" + printable(std::string(1, c)) + '"');
        word = word << 6 | static_cast<std::uint32_t>(digit);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<std::byte>(word >> bits & 0xffu));
    }
    return bytes;
}

// "https:" and the like: a colon in the first part of the path would be taken for the end of one.
bool hasScheme(std::string_view uri) {
    return uri.substr(0, uri.find('/')).find(':') != std::string_view::npos;
}

} // namespace

bool isDataUri(std::string_view uri) {
    return lowerCase(std::string(uri.substr(0, 5))) == "data:";
}

std::vector<std::byte> bytesOfDataUri(const JsonNode& uri) {
    const std::string text = uri.string();
    const std::size_t comma = text.find(',');
    if (comma == text.npos) uri.fail("there is no comma between the media type and the data");
    const std::string type = lowerCase(text.substr(0, comma));
    const std::string_view data = std::string_view(text).substr(comma + 1);
    constexpr std::string_view kBase64 = ";base64";
    const bool isBase64 =
        type.size() >= kBase64.size() && type.compare(type.size() - kBase64.size(), kBase64.size(), kBase64) == 0;
    const bool hasEscapes = data.find('%') != data.npos;
    const std::string plain = hasEscapes || !isBase64 ? withoutEscapes(data) : std::string();
    if (isBase64) return fromBase64(hasEscapes ? std::string_view(plain) : data, uri);
    std::vector<std::byte> bytes(plain.size());
    std::transform(plain.begin(), plain.end(), bytes.begin(), [](char c) { return static_cast<std::byte>(c); });
    return bytes;
}

namespace {

fs::path fileOf(const fs::path& path, const std::string& uri) {
    const std::string text = withoutEscapes(uri);
    const fs::path name(text);
    // Roots are drives and shares, too.
    if (text.empty() || hasScheme(uri) || text.find('\0') != text.npos || name.has_root_path())
        throw InputError(path.string() + ": \"" + printable(uri, 200) + "\": must be the relative path of a file");
    return (fs::absolute(path).parent_path() / name).lexically_normal();
}

} // namespace

fs::path besideGltf(const fs::path& path, const std::string& uri) {
    fs::path whole = fileOf(path, uri);
    const std::size_t end = uri.find_first_of("?#", 1);
    std::error_code none;
    // Programs write names without escapes, too.
    if (end == uri.npos || !mayRead(whole) || fs::exists(whole, none)) return whole;
    return fileOf(path, uri.substr(0, end));
}

} // namespace rt::scene
