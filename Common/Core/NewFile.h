// Files as each operating system has them beyond std::filesystem: made by nobody else, of the same owner, pipes.
#pragma once
#include <filesystem>
#include <string>
#include <system_error>

namespace rt {

enum class Access { Everybody, OwnerOnly }; // Everybody: as far as the user's mask allows

// Makes an empty file, or fails with std::errc::file_exists where there is anything of that name, be it a link.
std::error_code createExclusively(const std::filesystem::path& path, Access access);

// An empty file that was not there, and that no other process can be given: `name` in `folder`, or with a number before
// its extension. Throws RenderError.
std::filesystem::path createNumbered(const std::filesystem::path& folder, const std::filesystem::path& name);

// Gives a file the mode of another, and its owner and group where the user may; a group that is not kept gets no more
// than others have. Does nothing where the platform has no such thing.
void copyOwnerAndMode(const std::filesystem::path& from, const std::filesystem::path& to);

// Keeps a pipe open for writing, so that whoever opens it meanwhile need not wait for a reader.
class HeldPipe {
  public:
    HeldPipe() = default;
    ~HeldPipe();
    HeldPipe(const HeldPipe&) = delete;
    HeldPipe& operator=(const HeldPipe&) = delete;

    // Does not wait: fails with std::errc::no_such_device_or_address when nobody reads.
    std::error_code open(const std::filesystem::path& path);

  private:
    int descriptor_ = -1;
};

} // namespace rt
