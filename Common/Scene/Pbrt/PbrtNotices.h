// What of pbrt files is left out or stood in for: each kind of thing is told once, where it is met first.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "Common/Scene/Pbrt/PbrtParameters.h"
#include "Common/Scene/Pbrt/PbrtPlace.h"

namespace rt::scene {

class PbrtNotices {
  public:
    void add(const std::string& what, const PbrtPlace& place);
    // Of parameters that nobody has asked for.
    void addUnused(const PbrtParameters& parameters);
    void appendTo(std::vector<std::string>& notices) const;

  private:
    struct Entry {
        std::string text; // with the place
        std::size_t count = 0;
    };
    std::map<std::string, std::size_t> indices_; // into entries_, by what is told
    std::vector<Entry> entries_;
};

} // namespace rt::scene
