#include "Common/Probe/ProbePicture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace rt::probe {

using shared::vec3;

namespace {

const vec3 kInk(0.85f, 0.25f, 0.05f);   // of dots
const vec3 kEdge(0.03f, 0.18f, 0.16f);  // of strata
const vec3 kPaper(0.02f, 0.02f, 0.03f); // outside of the hemisphere

void put(image::Image& picture, std::uint32_t x, std::uint32_t y, const vec3& color) {
    float* pixel = picture.pixel(x, y);
    for (int c = 0; c < 3; ++c) pixel[c] = color[c];
}

// Pixels of a map that begins at the column `left`.
struct Part {
    const DirectionMap& map;
    std::uint32_t left;
};

void putAt(image::Image& picture, const Part& part, const vec3& direction, const vec3& color) {
    const auto place = part.map.placeOf(direction);
    if (!place) return;
    const auto cell = static_cast<std::uint32_t>(part.map.cellAt(*place)), width = part.map.width();
    put(picture, part.left + cell % width, cell / width, color);
}

void drawEdges(image::Image& picture, const Part& part, const ProbeResult& result) {
    constexpr int kSteps = 8; // between two points
    for (const auto& line : result.edges)
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
            for (int step = 0; step < kSteps; ++step) {
                const float share = static_cast<float>(step) / kSteps;
                putAt(picture, part, shared::normalize(line[i] * (1 - share) + line[i + 1] * share), kEdge);
            }
}

} // namespace

image::Image paint(const DirectionMap& map, float scale, std::uint32_t width, std::uint32_t height) {
    image::Image picture(width, height);
    const float peak = map.maximum() / scale;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const glm::dvec2 place((x + 0.5) / width, (y + 0.5) / height);
            const glm::dvec2 fromMiddle = 2.0 * place - 1.0;
            const bool isOutside = map.projection == Projection::Hemisphere && glm::dot(fromMiddle, fromMiddle) >= 1;
            const float value = map.values.empty() ? 0.0f : map.values[map.cellAt(place)];
            const float grey = peak > 0 ? std::sqrt(std::min(value / peak, 1.0f)) : 0.0f;
            put(picture, x, y, isOutside ? kPaper : vec3(grey));
        }
    return picture;
}

image::Image pictureOf(const ProbeResult& result) {
    std::uint32_t width = 0;
    for (const DirectionMap& map : result.maps) width += map.width();
    image::Image picture(width, result.settings.rows);
    std::uint32_t left = 0;
    for (const DirectionMap& map : result.maps) {
        const image::Image painted = paint(map, 1, map.width(), map.height);
        for (std::uint32_t y = 0; y < map.height; ++y)
            std::copy_n(painted.pixel(0, y), std::size_t{3} * map.width(), picture.pixel(left, y));
        const Part part{map, left};
        drawEdges(picture, part, result);
        for (const Drawn& drawn : result.shown)
            if (drawn.direction) putAt(picture, part, *drawn.direction, kInk);
        left += map.width();
    }
    return picture;
}

image::Image imageOf(const DirectionMap& map) {
    image::Image image(map.width(), map.height, 1);
    image.data = map.values;
    return image;
}

} // namespace rt::probe
