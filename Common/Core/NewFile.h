// Files as each operating system has them beyond std::filesystem: made by nobody else, of the same owner.
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

// A standard stream that was closed when the program started becomes one that leads nowhere: or the next file that is
// opened would take its place, and messages go into it.
void openStandardStreams();

} // namespace rt
