// The scenes that come with the programs.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

struct BuiltinScene {
    std::string_view id;
    std::string_view title;
    std::string_view description; // one line
    std::uint32_t defaultCount;   // id:N chooses another; 0: the scene has no count
    SceneDesc (*make)(std::uint32_t count);
};

inline constexpr std::uint32_t kMaxSceneCount = 10'000'000;

// All of them, in the order of menus and lists.
std::span<const BuiltinScene> builtinScenes();

bool isBuiltinScene(const std::string& id); // by its name; of "id:N" whatever N is
// By id, or "id:N" with 1 <= N <= kMaxSceneCount for a scene that has a count. Throws InputError that says what is
// allowed.
SceneDesc findBuiltinScene(const std::string& id);

} // namespace rt::scene
