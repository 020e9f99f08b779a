// zlib streams.
#pragma once
#include <cstddef>
#include <span>

namespace rt::image {

// Expands `in`, which must fill `out` exactly; otherwise, and for damaged streams, returns false.
bool inflate(std::span<const std::byte> in, std::span<std::byte> out);

} // namespace rt::image
