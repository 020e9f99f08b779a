// The content of a whole file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace rt {

// Of a regular file alone, in memory for its size. Throws InputError, naming the file and the reason, when it cannot be
// read or holds more than `limit` bytes or than its size says.
std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t limit);

} // namespace rt
