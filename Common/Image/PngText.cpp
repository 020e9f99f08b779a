#include "Common/Image/PngText.h"

#include <cstdint>
#include <string_view>

namespace rt::image {
namespace {

//   8 bytes of signature | chunks: length of the data, type, data, CRC of type and data; numbers are big-endian
constexpr std::size_t kSignatureBytes = 8;
constexpr std::string_view kType = "iTXt";

std::uint32_t fromBigEndian(std::string_view bytes) {
    std::uint32_t value = 0;
    for (const char byte : bytes) value = value << 8 | static_cast<unsigned char>(byte);
    return value;
}

} // namespace

std::optional<std::string> findPngText(std::span<const std::byte> png, const std::string& keyword) {
    std::string_view rest(reinterpret_cast<const char*>(png.data()), png.size());
    if (rest.substr(0, kSignatureBytes) != "\x89PNG\r\n\x1a\n") return std::nullopt;
    rest.remove_prefix(kSignatureBytes);
    while (rest.size() >= 12) {
        const std::size_t size = fromBigEndian(rest.substr(0, 4));
        if (size > rest.size() - 12) return std::nullopt;
        const std::string_view type = rest.substr(4, 4), data = rest.substr(8, size);
        const std::string start = keyword + std::string(2, '\0'); // and that it is not compressed
        if (type == kType && data.substr(0, start.size()) == start && data.size() > start.size()) {
            // Behind the method: the language and the translated keyword, each up to a zero.
            const std::size_t language = data.find('\0', start.size() + 1);
            const std::size_t translated = language == data.npos ? data.npos : data.find('\0', language + 1);
            if (translated == data.npos) return std::nullopt;
            return std::string(data.substr(translated + 1));
        }
        rest.remove_prefix(12 + size);
    }
    return std::nullopt;
}

} // namespace rt::image
