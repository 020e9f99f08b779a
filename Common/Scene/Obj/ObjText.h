// The text of OBJ and MTL files, in which encodings, spaces and paths come as they like.
#pragma once
#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace rt::scene {

// The bytes of a file, in UTF-8 without a byte order mark where one says that it is UTF-8 or UTF-16. Throws InputError.
std::vector<std::byte> readText(const std::filesystem::path& path);

// Without spaces, tabs and carriage returns around it.
std::string_view trimmed(std::string_view text);

// An existing file that is named in a file of `folder`; backslashes separate as slashes do. Empty: there is none.
std::filesystem::path findNamed(std::string_view name, const std::filesystem::path& folder);
// The same, or else one in `folder` of that name without its path, as files are moved from the places they were made
// at.
std::filesystem::path findMoved(std::string_view name, const std::filesystem::path& folder);

std::size_t countWords(std::string_view line);

// The statements that are no faces, which alone are rendered: `6 lines, 2 points`; empty: there is none of them.
std::string describeLeftOut(std::string_view text);

// `"a"`, `"a" and "b"`, `"a", "b", "c" and 7 others`; not of nothing.
std::string listed(const std::set<std::string>& names);

} // namespace rt::scene
