// Image files of a scene, as its compiler wants them.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "Common/Scene/Compiler/SceneCompiler.h"

namespace rt::app {

using TexelLoader =
    std::function<scene::EncodedTexels(const std::filesystem::path& path, std::optional<std::uint32_t> image)>;

// For one compilation: each file is read once.
TexelLoader makeTexelLoader();

// For as many compilations as one likes: each image is decoded once, and kept.
TexelLoader makeKeepingTexelLoader();

} // namespace rt::app
