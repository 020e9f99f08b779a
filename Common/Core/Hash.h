// FNV-1a, 64 bits: guards files against damage; no protection against intent.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace rt {

inline constexpr std::uint64_t kHashStart = 0xcbf29ce484222325u;

// Hashes of consecutive pieces chain: hashBytes(b, hashBytes(a)) is the hash of a followed by b.
inline std::uint64_t hashBytes(std::span<const std::byte> bytes, std::uint64_t hash = kHashStart) {
    for (const std::byte byte : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
    return hash;
}

// 16 hexadecimal digits.
inline std::string hexText(std::uint64_t hash) {
    std::string text(16, '0');
    for (std::size_t i = text.size(); i-- > 0; hash >>= 4) text[i] = "0123456789abcdef"[hash & 15];
    return text;
}

} // namespace rt
