// Where edges of lights are in an image.
#pragma once
#include <cstdint>
#include <vector>

#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// The pixels of an image that the edge of a light may cross: within them the camera's rays may meet its radiance or
// miss it, as they may in all of a ball of glass that shows a light.
struct LightEdges {
    std::vector<std::uint32_t> bits; // a bit a pixel, row by row, of each word from the lowest; empty: there are none
    std::uint64_t count = 0;         // of the bits that are set

    // Sets pixels `first` to `last`, of one row, in bits that are there for the whole image.
    void add(std::uint64_t first, std::uint64_t last);
};

// What hides a light is not looked at, nor are edges in mirrors and behind glass other than spheres
// (LightsInSpheres.h), nor those of textures; triangles of a mesh have no edges where they meet others that face the
// same way. Of more than kMostLightsWithEdges lights none has any, so that a window can ask with every move of the
// camera. The camera is that of an image of this size.
LightEdges findLightEdges(const CompiledScene& scene, const shared::Camera& camera, std::uint32_t width,
                          std::uint32_t height);
// Whether any camera could find some.
bool mayHaveLightEdges(const CompiledScene& scene);
inline constexpr std::size_t kMostLightsWithEdges = 10'000;

} // namespace rt::scene
