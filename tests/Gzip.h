// Files of gzip, without zlib.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace rt::test {

// As RFC 1952 has it, in members of one block that is not compressed.
inline std::string gzipOf(std::string_view text) {
    constexpr std::size_t kLongestBlock = 65535;
    std::string packed;
    const auto add = [&packed](std::uint32_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) packed += static_cast<char>(value >> 8 * i & 0xff);
    };
    do {
        const std::string_view part = text.substr(0, kLongestBlock);
        text.remove_prefix(part.size());
        std::uint32_t crc = 0xffffffffu;
        for (const char c : part) {
            crc ^= static_cast<std::uint8_t>(c);
            for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
        }
        const auto size = static_cast<std::uint32_t>(part.size());
        packed.append("\x1f\x8b\x08\0\0\0\0\0\0\xff\x01", 11);
        add(size, 2);
        add(~size, 2);
        packed += part;
        add(~crc, 4);
        add(size, 4);
    } while (!text.empty());
    return packed;
}

} // namespace rt::test
