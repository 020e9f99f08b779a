// A camera of a scene that moves, in another pose of it.
#pragma once
#include <algorithm>

#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// The scene's own, or one with a name, is where the other pose has it. All others stay where they are.
inline CameraDesc followedCamera(const CameraDesc& camera, const CompiledScene& pose, const CompiledScene& other) {
    if (camera == pose.camera) return other.camera;
    const auto isIt = [&camera](const auto& named) { return named.second == camera; };
    const auto found = std::find_if(pose.cameras.begin(), pose.cameras.end(), isIt);
    const auto there = found != pose.cameras.end() ? other.cameras.find(found->first) : other.cameras.end();
    return there != other.cameras.end() ? there->second : camera;
}

} // namespace rt::scene
