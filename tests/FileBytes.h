// What is in a file.
#pragma once
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace rt::test {

// All of it; nothing where it cannot be read.
inline std::string bytesOfFile(const std::filesystem::path& file) {
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
}

} // namespace rt::test
