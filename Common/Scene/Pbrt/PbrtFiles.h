// Files that pbrt files name.
#pragma once
#include <filesystem>
#include <set>
#include <string>

#include "Common/Scene/Pbrt/PbrtPlace.h"

namespace rt::scene {

class PbrtFiles {
  public:
    explicit PbrtFiles(const std::filesystem::path& scene); // names are relative to the folder of this file

    // A file that is named at a place: relative to the folder of the scene, or else to that of the file that names it,
    // or else in other case. What does not exist, or must not be read, is where it is named.
    std::filesystem::path locate(const std::string& name, const PbrtPlace& place);
    // As locate(), and it throws InputError where there is no such file.
    std::filesystem::path existing(const std::string& name, const PbrtPlace& place);

    const std::set<std::string>& foundInOtherCase() const { return inOtherCase_; } // as they were named

  private:
    std::filesystem::path folder_;
    std::set<std::string> inOtherCase_;
};

} // namespace rt::scene
