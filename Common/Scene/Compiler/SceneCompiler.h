// From the authoring scene to the compiled scene.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// An image as kernels fetch it: rows from the top, words as the format (shared::kTexel...) says.
// Whether an image that is not linear is sRGB-encoded, its texture knows.
struct TexelData {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t format = shared::kTexelSrgb8;
    std::vector<std::uint32_t> words;
    bool isEncoded = false; // of floats: colours have yet to be decoded
};

// An image that was found, and read but not decoded.
struct EncodedTexels {
    EncodedTexels() = default;
    EncodedTexels(std::size_t texels, std::function<TexelData()> decode) : count(texels), decoded(std::move(decode)) {}
    EncodedTexels(TexelData data) : decoded([data = std::move(data)] { return data; }) {}

    std::size_t count = 0;              // of texels, as far as the header tells
    std::function<TexelData()> decoded; // on any thread; throws InputError
};

struct CompileMemory;

struct CompileOptions {
    bool oneSidedLights = true;   // what emitters do that do not say it themselves
    bool generatedAssets = false; // take stand-ins even where the file exists, so that figures compare across machines
    bool installedMaps = false;   // take planet maps of the system's packages before those that are generated
    // Of the compilation before, of this scene as it was; afterwards of this one. What comes out is the same without.
    CompileMemory* memory = nullptr;
    std::optional<CameraDesc> camera; // in place of the scene's, which the compiled scene's origin stays at
    // Reads an image file, or the image of a number in a file of glTF; throws InputError. A scene with images needs it.
    std::function<EncodedTexels(const std::filesystem::path&, std::optional<std::uint32_t>)> loadTexels;
};

// Flattens groups and nested instances, finds the light table in the geometry, subtracts the camera's authored
// position, and collects the feature mask. Degenerate primitives are dropped and counted in a notice. Throws InputError
// naming the scene and the place.
std::shared_ptr<const CompiledScene> compileScene(const SceneDesc& desc, const CompileOptions& options = {});
// As that, with less memory: meshes are given back on the way, and what is left of the scene is for nothing.
std::shared_ptr<const CompiledScene> compileScene(SceneDesc&& desc, const CompileOptions& options = {});

} // namespace rt::scene
