// By which a file is known to be as it was.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

namespace rt::app {

struct FileFingerprint {
    std::string file;
    std::filesystem::file_time_type written{};
    std::uintmax_t bytes = 0;
    bool operator==(const FileFingerprint&) const = default;
};

// Nothing where there is no such file: a built-in scene, or a file between two of its lives.
inline std::optional<FileFingerprint> markOf(const std::string& file) {
    std::error_code missing;
    FileFingerprint mark{file, std::filesystem::last_write_time(file, missing), 0};
    if (!missing) mark.bytes = std::filesystem::file_size(file, missing);
    return missing ? std::nullopt : std::optional(std::move(mark));
}

} // namespace rt::app
