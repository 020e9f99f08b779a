// By which a file is known to be as it was.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

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

// Of files that have been read since `begin`. One that has been written meanwhile may have been read as it was before,
// and gets a mark that it does not have.
inline std::vector<FileFingerprint> marksOfRead(const std::vector<std::string>& files,
                                                std::filesystem::file_time_type begin) {
    std::vector<FileFingerprint> marks;
    for (const std::string& file : files) {
        std::optional<FileFingerprint> mark = markOf(file);
        if (mark && mark->written >= begin) mark->bytes = ~std::uintmax_t{0};
        marks.push_back(mark.value_or(FileFingerprint{file}));
    }
    return marks;
}

// Leaves files that were known before the marks that they had.
inline void keepMarks(const std::vector<FileFingerprint>& before, std::vector<FileFingerprint>& marks) {
    for (FileFingerprint& mark : marks)
        for (const FileFingerprint& known : before)
            if (known.file == mark.file) mark = known;
}

} // namespace rt::app
