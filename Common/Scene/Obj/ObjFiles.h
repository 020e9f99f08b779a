// Files that OBJ and MTL files name, on the machine that they have come to.
#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace rt::scene {

class FileFinder {
  public:
    // An existing file that is named in a file of `folder`. Backslashes separate as slashes do; quotes around the name
    // and a comment behind it are none of it, unless there is a file that has them; and where there is none of that
    // name one in other case is meant. Empty: there is none.
    std::filesystem::path find(std::string_view name, const std::filesystem::path& folder);
    // The same, or else one in `folder` of that name without its path, as files are moved from the places they were
    // made at.
    std::filesystem::path findMoved(std::string_view name, const std::filesystem::path& folder);

    const std::set<std::string>& foundInOtherCase() const { return inOtherCase_; } // as they were named

  private:
    using Listing = std::map<std::string, std::string>; // names in lower case, and as they are

    const Listing& listing(const std::filesystem::path& folder);
    std::filesystem::path findInOtherCase(const std::filesystem::path& name, const std::filesystem::path& folder);

    std::map<std::filesystem::path, Listing> listings_;
    std::set<std::string> inOtherCase_;
};

} // namespace rt::scene
