#include "Common/Scene/UniqueNames.h"

#include "Common/Core/Printable.h"

namespace rt::scene {

std::string UniqueNames::unique(const std::string& name, const std::string& usual, std::size_t number) {
    constexpr std::size_t kLongest = 100;
    const std::string base = name.empty() ? usual + " " + std::to_string(number) : printable(name, kLongest);
    int& count = taken_[base];
    std::string candidate = base;
    while (++count > 1) {
        candidate = base + " (" + std::to_string(count) + ")";
        if (taken_.try_emplace(candidate, 1).second) break;
    }
    return candidate;
}

} // namespace rt::scene
