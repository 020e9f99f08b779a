// The arrays of Common/Shared/Base/SceneArrays.h as members of C++ records.
#pragma once
#include "Common/Shared/Base/SceneArrays.h"
#include "Common/Shared/Base/Types.h"

namespace rt::shared { // whose rows name the records

// One member an array: Array<Sphere> spheres, and so on. std::vector owns them; pointers make a view.
template <template <typename...> typename Array>
struct SceneArraysOf {
#define RT_MEMBER(Type, name, load, title) Array<Type> name{};
    RT_SCENE_ARRAYS(RT_MEMBER, RT_MEMBER)
#undef RT_MEMBER
};

// visit(title, scenes.spheres...), then of each further array: of one scene, or the arrays of several side by side.
template <typename Visit, typename... Scenes>
void forEachArray(const Visit& visit, Scenes&... scenes) {
#define RT_VISIT(Type, name, load, title) visit(title, scenes.name...);
    RT_SCENE_ARRAYS(RT_VISIT, RT_VISIT)
#undef RT_VISIT
}

// Without those that follow from the others.
template <typename Visit, typename... Scenes>
void forEachSourceArray(const Visit& visit, Scenes&... scenes) {
#define RT_VISIT(Type, name, load, title) visit(title, scenes.name...);
    RT_SCENE_SOURCE_ARRAYS(RT_VISIT, RT_VISIT)
#undef RT_VISIT
}

} // namespace rt::shared
