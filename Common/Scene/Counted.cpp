#include "Common/Scene/Counted.h"

namespace rt::scene {

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
    return std::to_string(count) + ' ' + std::string(count == 1 ? one : many);
}

} // namespace rt::scene
