// Names in files of others as names in a scene.
#pragma once
#include <cstddef>
#include <map>
#include <string>

namespace rt::scene {

// A name that can be shown and is not taken: `name` as printable() has it, or `usual` and the number where it is empty.
// What is taken grows a number.
class UniqueNames {
  public:
    std::string unique(const std::string& name, const std::string& usual, std::size_t number);

  private:
    std::map<std::string, int> taken_;
};

} // namespace rt::scene
