// Built-in scenes as parameters of tests.
#pragma once
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>

#include "Common/Scene/Builtin/BuiltinScenes.h"

namespace rt::test {

// These have every feature of all (BuiltinScenesTest): what takes long in each scene is tried in them with every change,
// and in the others at night.
inline constexpr std::array<std::string_view, 9> kVariedScenes{
    "cornell-box-lights", "lucy-in-one-weekend", "next-week-earth", "next-week-two-spheres", "next-week-final",
    "cornell-box-lucy",   "veach-mis",           "many-lights",     "furnace-mixed",
};
inline bool isVaried(std::string_view id) {
    return std::find(kVariedScenes.begin(), kVariedScenes.end(), id) != kVariedScenes.end();
}

// Of a scene that comes in every size: the one of a small one.
inline std::string smallSceneId(const scene::BuiltinScene& builtin) {
    constexpr std::uint32_t kCount = 200;
    return std::string(builtin.id) + (builtin.defaultCount > kCount ? ":" + std::to_string(kCount) : "");
}

// As a part of a test's name.
inline std::string caseName(std::string text) {
    const auto isOther = [](unsigned char c) { return std::isalnum(c) == 0; };
    std::replace_if(text.begin(), text.end(), isOther, '_');
    return text;
}

} // namespace rt::test
