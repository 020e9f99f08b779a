// A file that is read piece by piece.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace rt {

// A regular file. Throws InputError as readFile() does (ReadFile.h).
std::ifstream openFile(const std::filesystem::path& path, std::uint64_t limit);

} // namespace rt
