// Text inside a PNG file: chunks of type iTXt (PNG specification, third edition, 11.3.3.4), uncompressed UTF-8.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace rt::image {

// `png` with the text behind its header. The keyword is 1 to 79 Latin letters.
std::string withPngText(const std::string& png, const std::string& keyword, const std::string& text);

// The text of the first chunk of that keyword; nothing where there is none, or it is compressed or damaged.
std::optional<std::string> findPngText(std::span<const std::byte> png, const std::string& keyword);

} // namespace rt::image
