// Where edges of lights are in an image.
#pragma once
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// The pixels of an image that the edge of a light may cross: within them the camera's rays may meet its radiance or
// miss it, as they may in all of a ball of glass that shows a light, or in a spot of a blurred mirror that does.
struct Silhouettes {
    // Of each pixel, row by row, the rectangle that holds all of it that lights with edges there can cover: in 1/255 of
    // a pixel and from the lowest byte on, where it begins from the left and from above, and where it ends. 0: no edge.
    // Empty: no pixel has one.
    std::vector<std::uint32_t> parts;
    std::uint64_t count = 0; // of the pixels with edges

    // Adds what this pixel, of parts that are there for the whole image, has of a rectangle, in pixels from its upper
    // left corner.
    void add(std::uint64_t pixel, const glm::dvec2& begin, const glm::dvec2& end);
    void addWhole(std::uint64_t pixel) { add(pixel, {0, 0}, {1, 1}); }

    // Whether each pixel has an edge, a bit a pixel, of each word from the lowest.
    std::vector<std::uint32_t> bits() const;
};

// What hides a light is not looked at, nor are edges in mirrors and behind glass other than spheres
// (LightsInSpheres.h) and spots (LightsInMirrors.h), nor those of textures; triangles of a mesh have no edges where
// they meet others that face the same way. Of more than kMaxLightsWithEdges lights none has any, so that a window can
// ask with every move of the camera. The camera is that of an image of this size.
Silhouettes findSilhouettes(const CompiledScene& scene, const shared::Camera& camera, std::uint32_t width,
                            std::uint32_t height);
// Whether any camera could find some.
bool mayHaveSilhouettes(const CompiledScene& scene);
inline constexpr std::size_t kMaxLightsWithEdges = 10'000;

} // namespace rt::scene
