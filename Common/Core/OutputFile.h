// What is written to a file, a device or a pipe, as the operating system takes it.
#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <streambuf>
#include <string>
#include <system_error>
#include <vector>

namespace rt {

// A stream buffer that keeps the reason of the first failure; from then on nothing is written any more. A pipe whose
// reader stalls is waited for until an interruption is requested (Interruption.h): then for a second at most.
class OutputFile final : public std::streambuf {
  public:
    OutputFile() = default;
    ~OutputFile() override;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    // What is there, emptied. A pipe that nobody reads fails with std::errc::no_such_device_or_address.
    std::error_code open(const std::filesystem::path& path);
    // While the file is open others see that somebody is at work on it (removeAbandoned).
    void lock();
    // Writes what is buffered; where `toDisk`, it has outlived a loss of power once this returns without an error.
    std::error_code finish(bool toDisk);
    void close();

  protected:
    int_type overflow(int_type character) override;
    std::streamsize xsputn(const char* text, std::streamsize count) override;
    int sync() override;

  private:
    bool send(const char* bytes, std::size_t count);
    bool awaitReader();

    static constexpr std::size_t kBufferBytes = 1 << 16;
    std::array<char, kBufferBytes> buffer_;
    int descriptor_ = -1;
    std::error_code error_;
};

// Makes a rename within a folder outlive a loss of power, where the file system can.
std::error_code syncFolder(const std::filesystem::path& folder);

// The names in a folder; none where it cannot be read. Throws std::bad_alloc, where std::filesystem ends the program.
std::vector<std::string> namesIn(const std::filesystem::path& folder);

// Removes a file of the user's own that has not changed for a minute, and that nobody has locked.
void removeAbandoned(const std::filesystem::path& file);

} // namespace rt
