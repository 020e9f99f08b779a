// Text inside a PNG file: chunks of type iTXt (PNG specification, third edition, 11.3.3.4), uncompressed UTF-8.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace rt::image {

// The text of the first chunk of that keyword; nothing where there is none, or it is compressed or damaged.
std::optional<std::string> findPngText(std::span<const std::byte> png, const std::string& keyword);

} // namespace rt::image
