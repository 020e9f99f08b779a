#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace rt::scene {

// `1 mesh`, `2 meshes`.
std::string counted(std::uint64_t count, std::string_view one, std::string_view many);

} // namespace rt::scene
