// What our files of glTF say in extras, which the format leaves to programs.
#pragma once

namespace rt::scene {

// Of a material that emits from its front alone: kGltfFront. Others emit from both sides.
inline constexpr const char* kGltfEmittingSides = "emitting_sides";
inline constexpr const char* kGltfFront = "front";

} // namespace rt::scene
