// Files that are named in other case than they have, as systems allow that take no notice of case.
#pragma once
#include <filesystem>

namespace rt {

// The regular file whose path differs from this absolute one in the case of ASCII letters alone; of several the first
// by name. Empty: there is none. A file of the very name is for the caller to look for.
std::filesystem::path findInOtherCase(const std::filesystem::path& path);

} // namespace rt
