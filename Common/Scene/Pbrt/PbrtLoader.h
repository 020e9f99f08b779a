// Scenes of pbrt-v4: docs/pbrt.md says what becomes of what.
#pragma once
#include <filesystem>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// A .pbrt file, packed by gzip or not, with the files that it includes, as a scene: mirrored where that is what a
// right-handed camera needs to show the picture that pbrt draws. Images stay where they are. What is left out or stood
// in for gets a notice. Throws InputError in one line, naming file, line, value and what is known.
SceneDesc loadPbrtScene(const std::filesystem::path& path);

} // namespace rt::scene
