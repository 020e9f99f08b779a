// Scenes under sky images that tests make up.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "Common/Scene/Compiler/SceneCompiler.h"

namespace rt::scene {

// Grey, of this radiance at column x and row y.
struct SkyPicture {
    std::uint32_t width, height;
    std::function<float(std::uint32_t x, std::uint32_t y)> radiance;
};

inline std::shared_ptr<const CompiledScene> compileUnder(const SkyPicture& picture, SceneDesc scene) {
    CompileOptions options;
    options.loadTexels = [&picture](const std::filesystem::path&, std::optional<std::uint32_t>) {
        TexelData data{picture.width, picture.height, shared::kTexelLinearF32, {}};
        for (std::uint32_t y = 0; y < picture.height; ++y)
            for (std::uint32_t x = 0; x < picture.width; ++x)
                data.words.insert(data.words.end(), 3, shared::floatBitsToUint(picture.radiance(x, y)));
        return data;
    };
    scene.background = ImageBackground{RT_TEST_DATA_DIR "/images/gradient.hdr", glm::dvec3(1)}; // a file that exists
    return compileScene(scene, options);
}

} // namespace rt::scene
