// Built-in scenes that between them have every shape, material, light, medium and kind of motion: what takes long in each
// scene is tried in these with every change, and in the others at night.
#pragma once
#include <algorithm>
#include <array>
#include <string_view>

namespace rt::test {

inline constexpr std::array<std::string_view, 9> kVariedScenes{
    "cornell-box-lights", "lucy-in-one-weekend", "next-week-earth", "next-week-two-spheres", "next-week-final",
    "cornell-box-lucy",   "veach-mis",           "many-lights",     "furnace-mixed",
};
inline bool isVaried(std::string_view id) {
    return std::find(kVariedScenes.begin(), kVariedScenes.end(), id) != kVariedScenes.end();
}

} // namespace rt::test
