// The content of a whole file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace rt {

// While it exists, readFile() on this thread takes only files below a folder, assets and planet maps (Paths.h), and
// one file more: for scenes of others. Links are followed first. An empty folder confines nothing. Throws InputError
// for one that does not exist.
class ReadsBelow {
  public:
    ReadsBelow(const std::filesystem::path& folder, const std::filesystem::path& file);
    ~ReadsBelow();
    ReadsBelow(const ReadsBelow&) = delete;
    ReadsBelow& operator=(const ReadsBelow&) = delete;

    bool allows(const std::filesystem::path& path) const;

  private:
    std::vector<std::filesystem::path> folders_; // none: everything is allowed
    std::filesystem::path file_;
    const ReadsBelow* outer_;
};

// Whether there is a regular file; also where nobody may read it.
bool isFile(const std::filesystem::path& path);

// Whether nothing on this thread keeps readFile() from the file; whether it exists is another question.
bool mayRead(const std::filesystem::path& path);

// Of a regular file alone, in memory for its size. Throws InputError, naming the file and the reason, when it cannot be
// read or holds more than `limit` bytes or than its size says.
std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t limit);

} // namespace rt
