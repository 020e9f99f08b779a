// A file that is either written wholly or not touched at all.
#pragma once
#include <filesystem>
#include <ostream>
#include <string>

#include "Common/Core/NewFile.h"
#include "Common/Core/OutputFile.h"

namespace rt {

// Writes to a temporary file of its own in the target's folder, which commit() renames over the target; without
// commit() the destructor removes it. What replaces a file has its mode, and its owner and group where the user may
// give them. What a program that was killed has left of this in the folder is removed. An existing target that is not a
// regular file (a device, a pipe that somebody reads) is written directly; a symbolic link is followed. Every failure
// is a RenderError with the file's name and the reason.
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    // Binary. Its state need not be checked: commit() does.
    std::ostream& stream() { return stream_; }
    // ToDisk: what was there before gives way only to what outlives a loss of power.
    enum class Durability { Usual, ToDisk };
    void commit(Durability durability = Durability::Usual);

  private:
    void createTemporary(Access access);
    [[noreturn]] void fail(const std::error_code& error) const;

    std::filesystem::path path_;      // as given, for messages
    std::filesystem::path target_;    // what is replaced: path_ with links followed
    std::filesystem::path temporary_; // empty when the target is written directly
    OutputFile file_;
    std::ostream stream_{&file_};
};

} // namespace rt
